// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The other end of a serial line: the master of a pseudo-terminal, reachable under a path that
/// stays.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "picolo/linux/file_descriptor.hpp"

namespace picolo::test {

/// A fresh folder that is removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class PseudoTerminal {
 public:
  PseudoTerminal() { plug(); }

  /// A link to the slave; it names the new one after plug().
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "tty"; }
  bool send(std::span<const std::uint8_t> bytes) const;
  std::size_t receive(std::span<std::uint8_t> buffer) const;
  void unplug();
  void plug();
  [[nodiscard]] int master() const { return master_.get(); }

 private:
  TemporaryFolder folder_;
  FileDescriptor master_;
};

/// The rate that a line is set to, bits per second, arbitrary ones too.
std::uint32_t line_rate(int fd);

}  // namespace picolo::test
