// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The outcome of every fallible call.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

// The attribute confuses clang-format 14.
// clang-format off
enum class [[nodiscard]] Status : std::uint8_t {
  ok = 0,
  not_ready,         ///< nothing to deliver yet; call again in a later cycle
  full,              ///< a fixed capacity is used up; nothing was changed
  invalid_argument,  ///< a configuration or argument is outside its documented domain
  out_of_range,      ///< the instant, index or address is outside of what is held
  checksum,          ///< bytes were damaged on the way
  disconnected,      ///< the device or its line is gone; may come back
  io_error,          ///< the device refused an operation
  unsupported,       ///< the device or stored version cannot do this
  corrupt,           ///< stored data is damaged
  degenerate,        ///< the data does not determine the answer
};
// clang-format on

[[nodiscard]] constexpr bool is_ok(Status status) {
  return status == Status::ok;
}

/// The enumerator's name, for logs and messages.
[[nodiscard]] const char* to_string(Status status);

}  // namespace picolo::inline v0
