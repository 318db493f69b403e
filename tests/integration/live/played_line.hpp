// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial line whose device a test plays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "picolo/linux/file_descriptor.hpp"

namespace picolo::test {

class PlayedLine {
 public:
  PlayedLine();
  [[nodiscard]] const std::string& path() const { return path_; }
  void send(std::span<const std::uint8_t> bytes) const;
  /// What the program wrote; returns how much.
  std::size_t take(std::span<std::uint8_t> buffer) const;
  /// That the program has set, bits per second.
  [[nodiscard]] std::uint32_t rate() const;

 private:
  FileDescriptor master_;
  std::string path_;
};

}  // namespace picolo::test
