// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the fuzzer feeds. A target that finds something wrong calls `fail`; the sanitizers find
/// the rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace picolo::fuzz {

using Input = std::span<const std::uint8_t>;

struct Target {
  const char* name;
  void (*run)(Input input);
  bool no_heap;  ///< firmware code: an allocation inside is a finding
};

[[nodiscard]] std::vector<Target> serial_targets();
[[nodiscard]] std::vector<Target> can_targets();
[[nodiscard]] std::vector<Target> slcan_targets();
[[nodiscard]] std::vector<Target> text_targets();
[[nodiscard]] std::vector<Target> store_targets();
[[nodiscard]] std::vector<Target> algorithm_targets();

/// Ends the process with a message, as a sanitizer does.
[[noreturn]] void fail(const char* what);
inline void require(bool condition, const char* what) {
  if (!condition) { fail(what); }
}

/// Numbers out of the input, zeros behind its end.
class Reader {
 public:
  explicit Reader(Input input) : input_(input) {}
  [[nodiscard]] bool empty() const { return at_ >= input_.size(); }
  [[nodiscard]] Input rest() const {
    return input_.subspan(at_ < input_.size() ? at_ : input_.size());
  }
  std::uint8_t byte() {
    const std::uint8_t value = empty() ? std::uint8_t{0} : input_[at_];
    ++at_;
    return value;
  }
  std::uint32_t word(std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) { value = (value << 8U) | byte(); }
    return value;
  }
  /// In [low, high], 2^16 steps.
  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(word(2)) / 65535.0F;
  }

 private:
  Input input_;
  std::size_t at_ = 0;
};

}  // namespace picolo::fuzz
