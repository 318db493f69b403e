// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads and writes objects of one node (CiA 301 SDO), up to four bytes at once.
#pragma once

#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/canopen/cob_id.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0::canopen {

[[nodiscard]] constexpr std::uint16_t sdo_request_id(std::uint8_t node) {
  return static_cast<std::uint16_t>(0x600 + node);
}
[[nodiscard]] constexpr std::uint16_t sdo_answer_id(std::uint8_t node) {
  return static_cast<std::uint16_t>(0x580 + node);
}

/// What an answer says. `bytes` 0: the server did not tell the size; take that of the object.
struct SdoAnswer {
  enum class Kind : std::uint8_t { value, written, segmented, aborted };
  Kind kind = Kind::value;
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint8_t bytes = 0;
  std::uint32_t value = 0;  ///< the object's, the length of a segmented one, or the abort code
};

[[nodiscard]] CanFrame sdo_read_frame(std::uint8_t node, std::uint16_t index,
                                      std::uint8_t subindex);
/// Precondition: bytes 1 to 4.
[[nodiscard]] CanFrame sdo_write_frame(std::uint8_t node, std::uint16_t index,
                                       std::uint8_t subindex, std::uint32_t value,
                                       std::uint8_t bytes);
/// Servers may leave out bytes that carry nothing. `corrupt`: shorter than what it says.
[[nodiscard]] Result<SdoAnswer> decode_sdo_answer(ByteView data);

enum class SdoState : std::uint8_t { idle, waiting, done, aborted, timed_out, unsupported };

/// One transfer at a time. Context: one at a time. Cost: O(1).
class SdoClient {
 public:
  explicit SdoClient(std::uint8_t node = 1, Duration timeout = 200ms)
      : node_(node), timeout_(timeout) {}

  /// Start a transfer; `frame()` is to be sent. A running one is given up.
  void read(std::uint16_t index, std::uint8_t subindex);
  void write(std::uint16_t index, std::uint8_t subindex, std::uint32_t value, std::uint8_t bytes);
  [[nodiscard]] const CanFrame& frame() const { return frame_; }
  /// The frame is on the bus.
  void sent(Timestamp now) { deadline_ = now + timeout_; }
  /// True when the frame was the answer to this transfer.
  bool consume(const CanFrame& frame);
  void service(Timestamp now);
  [[nodiscard]] SdoState state() const { return state_; }
  /// Value read, or abort code.
  [[nodiscard]] std::uint32_t value() const { return value_; }

 private:
  void start(std::uint16_t index, std::uint8_t subindex, bool writing);

  std::uint8_t node_;
  Duration timeout_;
  CanFrame frame_{};
  std::uint16_t index_ = 0;
  std::uint8_t subindex_ = 0;
  bool writing_ = false;
  SdoState state_ = SdoState::idle;
  Timestamp deadline_ = Timestamp::max();
  std::uint32_t value_ = 0;
};

}  // namespace picolo::inline v0::canopen
