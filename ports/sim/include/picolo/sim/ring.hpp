// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A queue of fixed capacity for one context, with a look at its oldest element.
#pragma once

#include <array>
#include <cstddef>

namespace picolo::inline v0::sim {

/// Cost: every call O(1), no heap. Full is a return value.
template <typename T, std::size_t Capacity>
class Ring {
 public:
  [[nodiscard]] bool push(const T& value) {
    if (size_ == Capacity) { return false; }
    items_[(first_ + size_) % Capacity] = value;
    ++size_;
    return true;
  }
  /// Precondition of front, back and pop: not empty.
  [[nodiscard]] T& front() { return items_[first_]; }
  [[nodiscard]] const T& front() const { return items_[first_]; }
  [[nodiscard]] const T& back() const { return items_[(first_ + size_ - 1) % Capacity]; }
  void pop() {
    first_ = (first_ + 1) % Capacity;
    --size_;
  }
  void clear() { size_ = 0; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t room() const { return Capacity - size_; }
  /// The element `index` places behind the oldest. Precondition: index < size().
  [[nodiscard]] const T& operator[](std::size_t index) const {
    return items_[(first_ + index) % Capacity];
  }

 private:
  std::array<T, Capacity> items_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace picolo::inline v0::sim
