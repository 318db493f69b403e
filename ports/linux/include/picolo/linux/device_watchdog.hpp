// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The kernel's watchdog device.
#pragma once

#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/hal/watchdog.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::inline v0 {

/// Every stroke writes one byte. A process that dies without `disarm` lets the machine reset.
class DeviceWatchdog final : public Watchdog {
 public:
  /// `path`: usually /dev/watchdog. From then on it runs. `io_error`: errno says why.
  Status open(const char* path);
  /// Takes over an open device.
  void adopt(int fd) { device_ = FileDescriptor{fd}; }
  void stroke() override;
  /// The orderly end: writes the magic character and closes.
  void disarm();
  /// Strokes that the device refused.
  [[nodiscard]] std::uint32_t failures() const { return failures_; }

 private:
  FileDescriptor device_{};
  std::uint32_t failures_ = 0;
};

}  // namespace picolo::inline v0
