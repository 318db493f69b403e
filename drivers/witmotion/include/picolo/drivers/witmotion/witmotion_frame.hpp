// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The standard frame of WitMotion sensors (WT901, JY901, JY61P, HWT905 and kin): 55, type, four
/// i16, sum.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/status.hpp"
#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kWitMotionFrameSize = 11;

enum class WitMotionType : std::uint8_t {
  time = 0x50,
  acceleration = 0x51,  ///< x y z, temperature
  rate = 0x52,          ///< x y z, temperature or voltage
  angle = 0x53,         ///< roll pitch yaw, version
  magnetic = 0x54,
  ports = 0x55,
  pressure = 0x56,
  position = 0x57,
  gps = 0x58,
  quaternion = 0x59,
  satellites = 0x5A,
};

/// Any other type of the protocol arrives as its number.
struct WitMotionFrame {
  WitMotionType type{};
  std::array<std::int16_t, 4> words{};
};

/// Precondition: bytes.size() >= kWitMotionFrameSize; the sum was tested.
[[nodiscard]] WitMotionFrame parse_witmotion(ByteView bytes);

/// Header, type 0x50 to 0x5F, sum of the first ten bytes.
struct WitMotionFormat {
  static constexpr std::size_t kMaxFrame = kWitMotionFrameSize;
  [[nodiscard]] FrameCheck check(ByteView bytes) const;
};

/// Bytes to frames. Incremental: the same frames come out however the stream is cut into pieces.
class WitMotionDecoder {
 public:
  /// Takes one byte. `ok`: it completed `frame()`. `not_ready`: it did not. Cost: O(1), after
  /// damage O(frame).
  Status push(std::uint8_t byte);
  [[nodiscard]] const WitMotionFrame& frame() const { return frame_; }
  /// Bytes of the frame that is on its way: at most (pending + n) / 11 frames complete within the
  /// next n bytes.
  [[nodiscard]] std::size_t pending() const { return framer_.pending(); }
  void reset() { framer_.reset(); }
  [[nodiscard]] const FramerCounters& counters() const { return framer_.counters(); }

 private:
  Framer<WitMotionFormat> framer_;
  WitMotionFrame frame_{};
};

}  // namespace picolo::inline v0
