// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial device that is played: the master of a pseudo-terminal under a path that stays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

  /// The device speaks at this rate: whoever opens the line at another one understands nothing, and
  /// is not understood. 0, as at first: at any.
  void set_baud(std::uint32_t baud) { baud_ = baud; }
  /// Bytes that nobody reads are lost, as on a real line.
  void send(std::span<const std::uint8_t> bytes);
  /// What the other side wrote.
  [[nodiscard]] std::vector<std::uint8_t> take();
  void unplug();
  void plug();
  [[nodiscard]] bool plugged() const { return master_.is_open(); }

 private:
  /// False: the other side has set another rate.
  [[nodiscard]] bool same_rate() const { return baud_ == 0 || other_baud() == baud_; }
  [[nodiscard]] std::uint32_t other_baud() const;

  std::string path_;
  std::uint32_t baud_ = 0;
  FileDescriptor master_;
};

}  // namespace picolo::tool
