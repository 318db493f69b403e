// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Finds capsules in a stream that may have lost or gained bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

/// A capsule's checksum is an exclusive-or of eight bits: one damaged capsule in 256 passes, and
/// one that lost a byte passes with the first byte of its successor as its last. So a capsule that
/// does not stand where its predecessors say is believed only when another begins behind it and
/// none that does stand there overlaps it, and one behind which none begins is searched again from
/// its second byte on: what it swallowed of its successor is not lost.
/// Cost: O(1) a byte, at most O(capsule) after a rejection. Context: one at a time.
class RplidarCapsuleFinder {
 public:
  static constexpr std::size_t kMaxCapsule = 132;

  explicit RplidarCapsuleFinder(std::size_t capsule_size) : capsule_size_(capsule_size) {}

  /// Takes one byte; true when there is a new capsule.
  bool push(std::uint8_t byte);
  /// Valid until the next `push`.
  [[nodiscard]] ByteView capsule() const { return {window_.data(), capsule_size_}; }
  /// Bytes of the stream in front of the capsule, modulo 2^32.
  [[nodiscard]] std::uint32_t position() const { return position_; }
  /// When above 0, a capsule has just become complete that may still have to be confirmed: from its
  /// first byte up to the one pushed last.
  [[nodiscard]] std::size_t completed_bytes() const { return completed_bytes_; }
  [[nodiscard]] std::size_t capsule_size() const { return capsule_size_; }
  [[nodiscard]] const FramerCounters& counters() const { return counters_; }
  /// Forgets what waits; a stream of such capsules begins.
  void reset(std::size_t capsule_size);

 private:
  static constexpr std::size_t kConfirmation = 2;  ///< bytes of a header

  [[nodiscard]] FrameVerdict check(std::size_t offset) const;
  [[nodiscard]] FrameVerdict rival() const;
  [[nodiscard]] FrameVerdict confirmation() const;
  [[nodiscard]] bool stands_in_line() const;
  bool hand_out();
  void drop(std::size_t bytes);

  std::size_t capsule_size_;
  std::array<std::uint8_t, 2 * kMaxCapsule + kConfirmation> window_{};
  std::size_t size_ = 0;
  std::uint32_t position_ = 0;       ///< of the window in the stream
  std::uint32_t last_position_ = 0;  ///< of the last capsule handed out
  std::size_t completed_bytes_ = 0;
  bool was_complete_ = false;  ///< what stands at the front of the window
  bool handed_out_ = false;    ///< as above
  bool has_last_ = false;
  FramerCounters counters_{};
};

}  // namespace picolo::inline v0
