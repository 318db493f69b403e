// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// `Result<T>`: a value or the status that says why there is none.
#pragma once

#include <type_traits>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// Holds a `T` when `status() == Status::ok`. `T` is trivially copyable and default constructible.
/// Context: any. Cost: one copy of `T`.
template <typename T>
class [[nodiscard]] Result {
  static_assert(std::is_trivially_copyable_v<T> && std::is_default_constructible_v<T>);

 public:
  // Both implicit, so that a function returns a value or a status as it is.
  constexpr Result(const T& value) : value_(value) {}
  /// `Status::ok` without a value is a bug of the caller and becomes `invalid_argument`.
  constexpr Result(Status status)
      : status_(status == Status::ok ? Status::invalid_argument : status) {}

  [[nodiscard]] constexpr explicit operator bool() const { return status_ == Status::ok; }
  [[nodiscard]] constexpr Status status() const { return status_; }
  /// Precondition: holds a value; otherwise a default constructed `T`.
  [[nodiscard]] constexpr const T& operator*() const { return value_; }
  [[nodiscard]] constexpr const T* operator->() const { return &value_; }
  [[nodiscard]] constexpr T value_or(const T& other) const { return *this ? value_ : other; }

 private:
  T value_{};
  Status status_ = Status::ok;
};

}  // namespace picolo::inline v0
