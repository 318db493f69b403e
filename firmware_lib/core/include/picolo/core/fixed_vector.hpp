// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A vector of fixed capacity: storage inside, no heap, full is a return value.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

namespace picolo::inline v0 {

/// Cost: every call O(1). Context: one at a time. Constant-initialisable (`constinit`).
template <typename T, std::size_t Capacity>
class FixedVector {
  static_assert(std::is_trivially_copyable_v<T> && Capacity > 0);

 public:
  /// False when full; nothing is changed then.
  [[nodiscard]] constexpr bool push_back(const T& value) {
    if (size_ == Capacity) { return false; }
    items_[size_] = value;
    ++size_;
    return true;
  }
  constexpr void clear() { size_ = 0; }
  /// Shrinks or grows over what the storage holds; false when beyond the capacity.
  [[nodiscard]] constexpr bool resize(std::size_t size) {
    if (size > Capacity) { return false; }
    size_ = size;
    return true;
  }

  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
  [[nodiscard]] constexpr bool full() const { return size_ == Capacity; }
  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }
  [[nodiscard]] constexpr T& operator[](std::size_t index) { return items_[index]; }
  [[nodiscard]] constexpr const T& operator[](std::size_t index) const { return items_[index]; }
  [[nodiscard]] constexpr const T* begin() const { return items_.data(); }
  [[nodiscard]] constexpr const T* end() const { return items_.data() + size_; }
  [[nodiscard]] constexpr std::span<const T> view() const { return {items_.data(), size_}; }
  [[nodiscard]] constexpr std::span<T> view() { return {items_.data(), size_}; }

 private:
  std::array<T, Capacity> items_{};
  std::size_t size_ = 0;
};

}  // namespace picolo::inline v0
