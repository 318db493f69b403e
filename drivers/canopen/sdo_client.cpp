// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/sdo_client.hpp"

#include <array>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0::canopen {
namespace {

constexpr std::uint8_t kReadRequest = 0x40;
constexpr std::uint8_t kWritten = 0x60;
constexpr std::uint8_t kAborted = 0x80;
constexpr std::uint8_t kSegmented = 0x41;
constexpr std::uint8_t kSizeUnknown = 0x42;

CanFrame request(std::uint8_t node, std::uint8_t command, std::uint16_t index,
                 std::uint8_t subindex, std::uint32_t value) {
  CanFrame frame{.id = sdo_request_id(node), .length = 8};
  frame.data[0] = command;
  store_u16_le(frame.data, 1, index);
  frame.data[3] = subindex;
  store_u32_le(frame.data, 4, value);
  return frame;
}

/// The `size` lowest bytes from offset 4; `out_of_range` when they are not there.
Result<std::uint32_t> value_of(ByteView data, std::size_t size) {
  if (data.size() < 4 + size) { return Status::corrupt; }
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value |= static_cast<std::uint32_t>(data[4 + i]) << (8 * i);
  }
  return value;
}

}  // namespace

CanFrame sdo_read_frame(std::uint8_t node, std::uint16_t index, std::uint8_t subindex) {
  return request(node, kReadRequest, index, subindex, 0);
}

CanFrame sdo_write_frame(std::uint8_t node, std::uint16_t index, std::uint8_t subindex,
                         std::uint32_t value, std::uint8_t bytes) {
  constexpr std::array<std::uint8_t, 5> kCommands{0x22, 0x2F, 0x2B, 0x27, 0x23};
  return request(node, kCommands[bytes <= 4 ? bytes : 0], index, subindex, value);
}

Result<SdoAnswer> decode_sdo_answer(ByteView data) {
  if (data.size() < 4) { return Status::corrupt; }
  SdoAnswer answer{.index = load_u16_le(data, 1), .subindex = data[3]};
  const std::uint8_t command = data[0];
  std::size_t size = 4;
  if (command == kWritten) {
    answer.kind = SdoAnswer::Kind::written;
    return answer;
  }
  if (command == kAborted) {
    answer.kind = SdoAnswer::Kind::aborted;
  } else if (command == kSegmented) {
    answer.kind = SdoAnswer::Kind::segmented;
  } else if (command == kSizeUnknown) {
    size = data.size() - 4 < 4 ? data.size() - 4 : 4;
  } else if ((command & 0xF3U) == 0x43U) {
    size = 4U - ((command >> 2U) & 3U);
    answer.bytes = static_cast<std::uint8_t>(size);
  } else {
    return Status::corrupt;
  }
  const Result<std::uint32_t> value = value_of(data, size);
  if (!value) { return value.status(); }
  answer.value = *value;
  return answer;
}

void SdoClient::start(std::uint16_t index, std::uint8_t subindex, bool writing) {
  index_ = index;
  subindex_ = subindex;
  writing_ = writing;
  state_ = SdoState::waiting;
  deadline_ = Timestamp::max();
}

void SdoClient::read(std::uint16_t index, std::uint8_t subindex) {
  start(index, subindex, false);
  frame_ = sdo_read_frame(node_, index, subindex);
}

void SdoClient::write(std::uint16_t index, std::uint8_t subindex, std::uint32_t value,
                      std::uint8_t bytes) {
  start(index, subindex, true);
  frame_ = sdo_write_frame(node_, index, subindex, value, bytes);
}

bool SdoClient::consume(const CanFrame& frame) {
  if (state_ != SdoState::waiting || frame.extended || frame.remote ||
      frame.id != sdo_answer_id(node_)) {
    return false;
  }
  const Result<SdoAnswer> answer = decode_sdo_answer(ByteView{frame.data}.first(frame.length));
  if (!answer || answer->index != index_ || answer->subindex != subindex_) { return false; }
  value_ = answer->value;
  switch (answer->kind) {
    case SdoAnswer::Kind::value: state_ = writing_ ? SdoState::unsupported : SdoState::done; break;
    case SdoAnswer::Kind::written:
      state_ = writing_ ? SdoState::done : SdoState::unsupported;
      break;
    case SdoAnswer::Kind::segmented: state_ = SdoState::unsupported; break;
    case SdoAnswer::Kind::aborted: state_ = SdoState::aborted; break;
  }
  return true;
}

void SdoClient::service(Timestamp now) {
  if (state_ == SdoState::waiting && now >= deadline_) { state_ = SdoState::timed_out; }
}

}  // namespace picolo::inline v0::canopen
