// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/lockstep/lockstep_board.hpp"

#include <algorithm>

#include "picolo/core/crc.hpp"

namespace picolo::inline v0::lockstep {
namespace {

constexpr std::size_t kFrameSize = 15;
constexpr std::size_t kByteSize = 3;
constexpr std::size_t kCrcSize = 4;

std::int64_t load_i64(ByteView bytes, std::size_t at) {
  const std::uint64_t high = load_u32_le(bytes, at + 4);
  return static_cast<std::int64_t>((high << 32) | load_u32_le(bytes, at));
}

}  // namespace

PacketWriter::PacketWriter(Timestamp now) : now_(now) {}

std::uint32_t PacketWriter::age(Timestamp stamp, std::uint32_t most) const {
  const std::int64_t age_us = Duration{now_ - stamp}.count();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(age_us, 0, most));
}

void PacketWriter::add(const CanFrame& frame) {
  if (size_ + kFrameSize + kCrcSize > kMaxPacket || frames_ == 255) { return; }
  store_u32_le(bytes_, size_, age(frame.stamp, 0xFFFFFFFFU));
  store_u16_le(bytes_, size_ + 4, static_cast<std::uint16_t>(frame.id & 0x7FFU));
  bytes_[size_ + 6] = frame.length;
  for (std::size_t i = 0; i < 8; ++i) {
    bytes_[size_ + 7 + i] = i < frame.length ? frame.data[i] : std::uint8_t{0};
  }
  size_ += kFrameSize;
  ++frames_;
}

void PacketWriter::add_byte(std::uint8_t byte, Timestamp stamp) {
  store_u16_le(bytes_, size_, static_cast<std::uint16_t>(age(stamp, 0xFFFFU)));
  bytes_[size_ + 2] = byte;
  size_ += kByteSize;
}

void PacketWriter::add_lidar(std::uint8_t byte, Timestamp stamp) {
  if (size_ + kByteSize + kCrcSize > kMaxPacket) { return; }
  add_byte(byte, stamp);
  ++lidar_;
}

void PacketWriter::add_imu(std::uint8_t byte, Timestamp stamp) {
  if (size_ + kByteSize + kCrcSize > kMaxPacket) { return; }
  add_byte(byte, stamp);
  ++imu_;
}

ByteView PacketWriter::finish() {
  const auto now = static_cast<std::uint64_t>(now_.time_since_epoch().count());
  store_u16_le(bytes_, 0, static_cast<std::uint16_t>(size_ + kCrcSize));
  store_u32_le(bytes_, 2, static_cast<std::uint32_t>(now & 0xFFFFFFFFU));
  store_u32_le(bytes_, 6, static_cast<std::uint32_t>(now >> 32));
  bytes_[10] = frames_;
  store_u16_le(bytes_, 11, lidar_);
  store_u16_le(bytes_, 13, imu_);
  store_u32_le(bytes_, size_, crc32({bytes_, size_}));
  return {bytes_, size_ + kCrcSize};
}

Status LockstepBoard::take(ByteView packet) {
  if (packet.size() < kHeader + kCrcSize) { return Status::invalid_argument; }
  const std::size_t body = packet.size() - kCrcSize;
  if (crc32(packet.first(body)) != load_u32_le(packet, body)) { return Status::checksum; }
  const std::size_t frames = packet[10];
  const std::size_t lidar = load_u16_le(packet, 11);
  const std::size_t imu = load_u16_le(packet, 13);
  if (kHeader + frames * kFrameSize + (lidar + imu) * kByteSize != body) {
    return Status::invalid_argument;
  }
  const Timestamp now{Duration{load_i64(packet, 2)}};
  clock_.set(now);
  can_.begin_frame();
  lidar_.begin_frame();
  imu_.begin_frame();
  std::size_t at = kHeader;
  for (std::size_t i = 0; i < frames; ++i, at += kFrameSize) {
    CanFrame frame{.stamp = now - Duration{load_u32_le(packet, at)},
                   .source = StampSource::hardware,
                   .id = load_u16_le(packet, at + 4),
                   .length = packet[at + 6]};
    std::copy_n(packet.begin() + static_cast<std::ptrdiff_t>(at) + 7, 8, frame.data.begin());
    can_.arrives(frame);
  }
  for (std::size_t i = 0; i < lidar + imu; ++i, at += kByteSize) {
    LockstepSerialPort& port = i < lidar ? lidar_ : imu_;
    port.arrives(packet[at + 2], now - Duration{load_u16_le(packet, at)});
  }
  return Status::ok;
}

}  // namespace picolo::inline v0::lockstep
