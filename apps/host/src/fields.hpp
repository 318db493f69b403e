// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace picolo::host {

/// Thrown by `Fields` and caught by the reader of the line.
struct BadLine {
  std::string cause;
};

/// A line cut at white space, with checked access; every refusal names the field.
class Fields {
 public:
  explicit Fields(std::string_view line);

  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  [[nodiscard]] std::string_view text(std::size_t index) const;
  /// Finite unless `any_value`, which also takes nan and inf as lidar drivers write them.
  [[nodiscard]] double number(std::size_t index, const char* what, bool any_value = false) const;
  [[nodiscard]] std::size_t count(std::size_t index, const char* what) const;
  void expect_size(std::size_t expected, const char* what) const;

 private:
  std::vector<std::string_view> fields_;
};

/// The whole of `text` as a number, in the C locale whatever the user's.
[[nodiscard]] bool parse_number(std::string_view text, double& value);

}  // namespace picolo::host
