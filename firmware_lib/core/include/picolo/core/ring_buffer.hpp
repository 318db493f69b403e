// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Single producer, single consumer ring: the only way data leaves an interrupt. The only header
/// that includes <atomic>.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace picolo::inline v0 {

/// Cost: every call O(1), wait-free. Context: `push` from one context, `pop` from one other.
/// A full ring refuses the newest and counts it; the consumer never sees a torn value.
template <typename T, std::uint32_t Capacity>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(Capacity >= 2 && (Capacity & (Capacity - 1)) == 0, "capacity is a power of two");

 public:
  [[nodiscard]] bool push(const T& value) {
    const std::uint32_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == Capacity) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    items_[head & (Capacity - 1)] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// False when empty; `value` is untouched then.
  [[nodiscard]] bool pop(T& value) {
    const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
    if (head_.load(std::memory_order_acquire) == tail) { return false; }
    value = items_[tail & (Capacity - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Context: either end; exact there but for what the other end does meanwhile.
  [[nodiscard]] std::uint32_t size() const {
    const std::uint32_t tail = tail_.load(std::memory_order_acquire);
    return head_.load(std::memory_order_acquire) - tail;
  }
  [[nodiscard]] static constexpr std::uint32_t capacity() { return Capacity; }
  /// How many values `push` refused since construction; never reset.
  [[nodiscard]] std::uint32_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::array<T, Capacity> items_{};
  std::atomic<std::uint32_t> head_{0};
  std::atomic<std::uint32_t> tail_{0};
  std::atomic<std::uint32_t> dropped_{0};
};

/// One writer publishes, any number of readers of any priority copy the newest complete value.
/// Four slots, each an array of relaxed atomic words, and one sequence number: a reader starts over
/// only when the writer published three more values during its copy, and gives up after `kAttempts`
/// (`read` then returns false), so that it is bounded however badly it is preempted.
/// Cost: O(sizeof(T)), wait-free on both sides.
/// Context: `publish` from one context, `read` from any.
/// `FirstSequence` is for tests, which cannot wait for the sequence to wrap.
template <typename T, std::uint32_t FirstSequence = 0>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>);
  static constexpr std::size_t kWords = (sizeof(T) + 3) / 4;
  static constexpr std::uint32_t kSlots = 4;
  static constexpr int kAttempts = 4;

 public:
  void publish(const T& value) {
    std::array<std::uint32_t, kWords> words{};
    copy_bytes(words.data(), &value);
    const std::uint32_t sequence = sequence_.load(std::memory_order_relaxed) + 1;
    auto& slot = slots_[sequence % kSlots];
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < kWords; ++i) { slot[i].store(words[i], std::memory_order_relaxed); }
    sequence_.store(sequence, std::memory_order_release);
    published_.store(1, std::memory_order_release);  // the sequence alone may be 0 again after 2^32
  }

  /// False when nothing was published yet, or when the reader was overtaken `kAttempts` times.
  [[nodiscard]] bool read(T& value) const {
    if (published_.load(std::memory_order_acquire) == 0) { return false; }
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const std::uint32_t before = sequence_.load(std::memory_order_acquire);
      std::array<std::uint32_t, kWords> words{};
      const auto& slot = slots_[before % kSlots];
      for (std::size_t i = 0; i < kWords; ++i) {
        words[i] = slot[i].load(std::memory_order_relaxed);
      }
      std::atomic_thread_fence(std::memory_order_acquire);
      // The slot is rewritten only while sequence_ goes from before + 3 to before + 4.
      if (sequence_.load(std::memory_order_relaxed) - before < kSlots - 1) {
        copy_bytes(&value, words.data());
        return true;
      }
    }
    return false;
  }

  /// Number of values published so far, modulo 2^32.
  [[nodiscard]] std::uint32_t sequence() const { return sequence_.load(std::memory_order_acquire); }

 private:
  static void copy_bytes(void* to, const void* from) { __builtin_memcpy(to, from, sizeof(T)); }

  std::array<std::array<std::atomic<std::uint32_t>, kWords>, kSlots> slots_{};
  std::atomic<std::uint32_t> sequence_{FirstSequence};
  std::atomic<std::uint32_t> published_{0};
};

}  // namespace picolo::inline v0
