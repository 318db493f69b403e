// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Finds frames in a stream of bytes that may lie: lost, damaged, inserted, or header bytes inside
/// of the payload.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0 {

enum class FrameVerdict : std::uint8_t {
  incomplete,   ///< may become a frame
  complete,     ///< the first `size` bytes are a frame
  no_header,    ///< no frame begins here
  implausible,  ///< sound by its checksum, impossible by its content
  checksum,     ///< damaged
};

struct FrameCheck {
  FrameVerdict verdict = FrameVerdict::incomplete;
  std::size_t size = 0;  ///< of the complete frame
};

/// What a device's format tells: how long a frame can be, and what the bytes at the front of the
/// window are. `check` is asked with 1 to kMaxFrame bytes and must not answer `incomplete` to
/// kMaxFrame of them.
template <typename F>
concept FrameFormat = requires(const F& format, ByteView bytes) {
  { F::kMaxFrame } -> std::convertible_to<std::size_t>;
  { format.check(bytes) } -> std::same_as<FrameCheck>;
};

/// Formats whose frames tell their own length say `kVariableSize = true`: a damaged length must not
/// hold back the good frames behind it.
template <typename F>
concept VariableFrameFormat = FrameFormat<F> && requires {
  requires F::kVariableSize;
};

/// Never reset.
struct FramerCounters {
  std::uint32_t frames = 0;
  std::uint32_t bad_checksums = 0;
  std::uint32_t implausible = 0;
  std::uint32_t skipped_bytes = 0;  ///< bytes that were part of no frame
};

/// A window over the stream that begins where a frame may begin. What is rejected is searched again
/// from its second byte on, so no byte of a good frame is ever lost to a bad one before it.
/// `push(byte); while (next()) { use(frame()); }`. Frames of fixed size: at most one a byte.
/// Cost: a byte costs one check, and after a rejection at most kMaxFrame of them.
/// Context: one at a time.
template <FrameFormat Format>
class Framer {
 public:
  explicit constexpr Framer(const Format& format = {}) : format_(format) {}

  /// Gives up the frame handed out before. Precondition: `next()` was called since the last push.
  constexpr void push(std::uint8_t byte) {
    drop(frame_size_);
    frame_size_ = 0;
    window_[size_] = byte;
    ++size_;
  }

  /// Moves on to the next frame in the window; false when more bytes are needed.
  constexpr bool next() {
    std::size_t start = frame_size_;  // the frame handed out before is done with
    frame_size_ = 0;
    while (start < size_) {
      const FrameCheck found = format_.check({window_.data() + start, size_ - start});
      if (found.verdict == FrameVerdict::complete) {
        frame_size_ = found.size;
        last_size_ = found.size;
        ++counters_.frames;
        break;
      }
      if (found.verdict == FrameVerdict::incomplete && size_ - start < Format::kMaxFrame) {
        if (!rival_is_complete(start)) { break; }
        counters_.skipped_bytes += static_cast<std::uint32_t>(rival_ - start);
        start = rival_;
        continue;
      }
      count(found.verdict);
      ++counters_.skipped_bytes;
      ++start;
    }
    drop(start);
    return frame_size_ > 0;
  }

  /// The frame that `next` found; valid until the next call of `next` or `push`.
  [[nodiscard]] constexpr ByteView frame() const { return {window_.data(), frame_size_}; }
  /// Bytes received after the end of `frame()`: 0 unless a rejected candidate hid it.
  [[nodiscard]] constexpr std::size_t bytes_after_frame() const { return size_ - frame_size_; }
  /// Bytes that wait for the rest of their frame.
  [[nodiscard]] constexpr std::size_t pending() const { return size_ - frame_size_; }
  [[nodiscard]] constexpr const FramerCounters& counters() const { return counters_; }
  [[nodiscard]] constexpr const Format& format() const { return format_; }
  /// Forgets what waits: the stream was interrupted.
  constexpr void reset() {
    size_ = 0;
    frame_size_ = 0;
    rival_ = 0;
  }
  /// What waits and what follows is of another format.
  constexpr void set_format(const Format& format) { format_ = format; }

 private:
  /// A candidate that waits for more bytes than the last frame had may be one whose length was
  /// damaged: true when a whole frame stands behind it. Cost: O(1) a byte, and what was skipped.
  constexpr bool rival_is_complete(std::size_t start) {
    if constexpr (VariableFrameFormat<Format>) {
      if (last_size_ == 0 || size_ - start <= last_size_) { return false; }
      rival_ = std::max(rival_, start + 1);
      for (; rival_ < size_; ++rival_) {
        const FrameVerdict verdict =
            format_.check({window_.data() + rival_, size_ - rival_}).verdict;
        if (verdict == FrameVerdict::complete) { return true; }
        if (verdict == FrameVerdict::incomplete) { return false; }
      }
    }
    return false;
  }

  constexpr void count(FrameVerdict verdict) {
    if (verdict == FrameVerdict::checksum) { ++counters_.bad_checksums; }
    if (verdict == FrameVerdict::implausible) { ++counters_.implausible; }
  }

  constexpr void drop(std::size_t bytes) {
    if (bytes == 0) { return; }
    std::copy(window_.data() + bytes, window_.data() + size_, window_.data());
    size_ -= bytes;
    rival_ = 0;
  }

  Format format_;
  std::array<std::uint8_t, Format::kMaxFrame> window_{};
  std::size_t size_ = 0;
  std::size_t frame_size_ = 0;
  std::size_t last_size_ = 0;  ///< of the frame before
  std::size_t rival_ = 0;      ///< where in the window the next candidate stands
  FramerCounters counters_{};
};

}  // namespace picolo::inline v0
