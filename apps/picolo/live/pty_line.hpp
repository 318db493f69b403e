// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial device that is played: the master of a pseudo-terminal under a path that stays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "picolo/linux/file_descriptor.hpp"

namespace picolo::tool {

class PtyLine {
 public:
  /// `path` becomes a link to the terminal; an older link is replaced, anything else there is an
  /// error. Throws UserError (usage, device).
  explicit PtyLine(std::string path);
  PtyLine(const PtyLine&) = delete;
  PtyLine& operator=(const PtyLine&) = delete;
  ~PtyLine() { unplug(); }

  /// Bytes that nobody reads are lost, as on a real line.
  void send(std::span<const std::uint8_t> bytes);
  /// What the other side wrote; returns how much.
  std::size_t take(std::span<std::uint8_t> buffer);
  void unplug();
  void plug();
  [[nodiscard]] bool plugged() const { return master_.is_open(); }

 private:
  std::string path_;
  FileDescriptor master_;
};

}  // namespace picolo::tool
