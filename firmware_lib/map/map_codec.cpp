// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/map_codec.hpp"

#include <algorithm>
#include <bit>

#include "picolo/core/convert.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint32_t kMagic = 0x31504D50;  // "PMP1"
constexpr std::size_t kCrcAt = kMapHeaderSize - 4;
constexpr std::size_t kMinRun = 4;
constexpr std::size_t kMaxRun = 127 * 256 + 255 + kMinRun;
// A step of a save has room for some tokens: none of them stands for much of the map.
constexpr std::size_t kRunsOfAMap = 64;
constexpr std::size_t kMaxLiterals = 128;
constexpr int kMaxSide = 32'768;

std::size_t cells_of(const GridWindow& window) {
  return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
}

/// From the corner of the saved window to that of the target, in cells.
int shift_of(int from_origin, int from_size, int to_size) {
  return from_size == to_size ? from_origin : from_origin + (from_size - to_size) / 2;
}

int factor_of(const RollingMapCore& fine, const RollingMapCore& coarse) {
  return round_to_i32(coarse.window().cell_m / fine.window().cell_m, 1, fine.window().width);
}

int floor_divide(int value, int divisor) {
  return value >= 0 ? value / divisor : -((divisor - 1 - value) / divisor);
}

}  // namespace

void encode_map_header(const MapHeader& header, std::span<std::uint8_t, kMapHeaderSize> bytes) {
  std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
  store_u32_le(bytes, 0, kMagic);
  store_u16_le(bytes, 4, kMapFormatVersion);
  store_u16_le(bytes, 6, kMapHeaderSize);
  store_u32_le(bytes, 8, header.sequence);
  store_u32_le(bytes, 12, static_cast<std::uint32_t>(header.window.width));
  store_u32_le(bytes, 16, static_cast<std::uint32_t>(header.window.height));
  store_u32_le(bytes, 20, std::bit_cast<std::uint32_t>(header.window.cell_m));
  store_u32_le(bytes, 24, std::bit_cast<std::uint32_t>(header.window.origin_x_cells));
  store_u32_le(bytes, 28, std::bit_cast<std::uint32_t>(header.window.origin_y_cells));
  store_u32_le(bytes, 32, header.payload_bytes);
  store_u32_le(bytes, 36, header.payload_crc);
  bytes[40] = std::bit_cast<std::uint8_t>(header.occupied_from);
  store_u32_le(bytes, kCrcAt, crc32(bytes.first(kCrcAt)));
}

Status decode_map_header(ByteView bytes, MapHeader& header) {
  if (bytes.size() < kMapHeaderSize) { return Status::not_ready; }
  bytes = bytes.first(kMapHeaderSize);
  if (std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0xFF; })) {
    return Status::not_ready;
  }
  if (load_u32_le(bytes, 0) != kMagic) { return Status::corrupt; }
  if (load_u32_le(bytes, kCrcAt) != crc32(bytes.first(kCrcAt))) { return Status::corrupt; }
  if (load_u16_le(bytes, 4) > kMapFormatVersion) { return Status::unsupported; }
  MapHeader read;
  read.sequence = load_u32_le(bytes, 8);
  read.window.width = load_i32_le(bytes, 12);
  read.window.height = load_i32_le(bytes, 16);
  read.window.cell_m = std::bit_cast<float>(load_u32_le(bytes, 20));
  read.window.origin_x_cells = load_i32_le(bytes, 24);
  read.window.origin_y_cells = load_i32_le(bytes, 28);
  read.payload_bytes = load_u32_le(bytes, 32);
  read.payload_crc = load_u32_le(bytes, 36);
  read.occupied_from = std::bit_cast<std::int8_t>(bytes[40]);
  if (read.window.width <= 0 || read.window.height <= 0 || read.window.width > kMaxSide ||
      read.window.height > kMaxSide || !(read.window.cell_m > 0.0F)) {
    return Status::corrupt;
  }
  header = read;
  return Status::ok;
}

void MapEncoder::begin(const RollingMapCore& map) {
  map_ = &map;
  window_ = map.window();
  head_size_ = 0;
  head_written_ = 0;
  literals_ = 0;
  cell_ = 0;
}

std::size_t MapEncoder::run_at(std::size_t cell, std::size_t longest) const {
  const std::span<const std::int8_t> cells = map_->occupancy();
  const std::size_t end = std::min(cells.size(), cell + longest);
  std::size_t next = cell + 1;
  while (next < end && cells[next] == cells[cell]) { ++next; }
  return next - cell;
}

void MapEncoder::next_token() {
  const std::size_t cells = map_->occupancy().size();
  head_written_ = 0;
  const std::size_t run = run_at(cell_, std::clamp(cells / kRunsOfAMap, kMinRun, kMaxRun));
  if (run >= kMinRun) {
    const std::size_t more = run - kMinRun;
    head_ = {static_cast<std::uint8_t>(128 + more / 256), static_cast<std::uint8_t>(more % 256),
             std::bit_cast<std::uint8_t>(map_->occupancy()[cell_])};
    head_size_ = 3;
    cell_ += run;
    return;
  }
  std::size_t end = cell_ + run;
  while (end < cells && end - cell_ < kMaxLiterals) {
    const std::size_t next = run_at(end, kMinRun);
    if (next >= kMinRun) { break; }
    end += next;
  }
  literals_ = std::min(end - cell_, kMaxLiterals);
  head_[0] = static_cast<std::uint8_t>(literals_ - 1);
  head_size_ = 1;
}

std::size_t MapEncoder::encode(std::span<std::uint8_t> out) {
  std::size_t written = 0;
  while (written < out.size()) {
    if (head_written_ < head_size_) {
      out[written] = head_[head_written_];
      ++head_written_;
    } else if (literals_ > 0) {
      out[written] = std::bit_cast<std::uint8_t>(map_->occupancy()[cell_]);
      ++cell_;
      --literals_;
    } else if (cell_ < map_->occupancy().size()) {
      next_token();
      continue;
    } else {
      break;
    }
    ++written;
  }
  return written;
}

bool MapDecoder::fits(const MapHeader& header, const RollingMapCore& target) {
  return header.window.cell_m == target.window().cell_m &&
         header.occupied_from == target.config().occupied_from;
}

Status MapDecoder::begin(const MapHeader& header, RollingMapCore& target) {
  const GridWindow& to = target.window();
  if (!fits(header, target)) { return Status::invalid_argument; }
  const int x = shift_of(header.window.origin_x_cells, header.window.width, to.width);
  const int y = shift_of(header.window.origin_y_cells, header.window.height, to.height);
  target.place(x, y);
  target_ = &target;
  width_ = header.window.width;
  shift_x_ = header.window.origin_x_cells - x;
  shift_y_ = header.window.origin_y_cells - y;
  cells_ = cells_of(header.window);
  cell_ = 0;
  count_ = 0;
  expect_ = Expect::token;
  return Status::ok;
}

void MapDecoder::fill(std::int8_t value, std::size_t count) {
  constexpr std::size_t kPiece = 64;
  std::array<std::int8_t, kPiece> piece{};
  piece.fill(value);
  const auto width = static_cast<std::size_t>(width_);
  while (count > 0) {
    const std::size_t column = cell_ % width;
    const std::size_t now = std::min({count, kPiece, width - column});
    target_->restore(static_cast<int>(column) + shift_x_,
                     static_cast<int>(cell_ / width) + shift_y_, std::span{piece}.first(now));
    cell_ += now;
    count -= now;
  }
}

Status MapDecoder::put(std::uint8_t byte) {
  switch (expect_) {
    case Expect::token:
      if (complete()) { return Status::corrupt; }
      count_ = byte < 128 ? byte + std::size_t{1} : (byte - std::size_t{128}) * 256 + kMinRun;
      expect_ = byte < 128 ? Expect::literal : Expect::length;
      break;
    case Expect::length:
      count_ += byte;
      expect_ = Expect::value;
      break;
    case Expect::value:
      if (count_ > cells_ - cell_) { return Status::corrupt; }
      fill(std::bit_cast<std::int8_t>(byte), count_);
      expect_ = Expect::token;
      break;
    case Expect::literal:
      if (complete()) { return Status::corrupt; }
      fill(std::bit_cast<std::int8_t>(byte), 1);
      --count_;
      if (count_ == 0) { expect_ = Expect::token; }
      break;
  }
  return Status::ok;
}

Status MapDecoder::decode(ByteView bytes) {
  for (const std::uint8_t byte : bytes) {
    const Status status = put(byte);
    if (!is_ok(status)) { return status; }
  }
  return Status::ok;
}

void place_coarse(const RollingMapCore& fine, RollingMapCore& coarse) {
  const int factor = factor_of(fine, coarse);
  coarse.place(floor_divide(fine.window().origin_x_cells, factor),
               floor_divide(fine.window().origin_y_cells, factor));
}

void restore_coarse_row(const RollingMapCore& fine, RollingMapCore& coarse, int row) {
  const int factor = factor_of(fine, coarse);
  const GridWindow& from = fine.window();
  const GridWindow& to = coarse.window();
  const int row_y = (to.origin_y_cells + row) * factor - from.origin_y_cells;
  const int first_y = std::max<std::int32_t>(0, row_y);
  const int end_y = std::min<std::int32_t>(from.height, row_y + factor);
  for (int column = 0; column < to.width; ++column) {
    const int column_x = (to.origin_x_cells + column) * factor - from.origin_x_cells;
    const int first_x = std::max<std::int32_t>(0, column_x);
    const int end_x = std::min<std::int32_t>(from.width, column_x + factor);
    std::int8_t most = 0;
    for (int y = first_y; y < end_y; ++y) {
      for (int x = first_x; x < end_x; ++x) {
        const std::int8_t cell =
            fine.occupancy()[static_cast<std::size_t>(y) * static_cast<std::size_t>(from.width) +
                             static_cast<std::size_t>(x)];
        if (cell != 0) { most = most == 0 ? cell : std::max(most, cell); }
      }
    }
    coarse.restore(column, row, std::span{&most, 1});
  }
}

}  // namespace picolo::inline v0
