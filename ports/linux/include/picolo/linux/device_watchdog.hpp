// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The kernel's watchdog device.
#pragma once

#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/core/time.hpp"
#include "picolo/hal/watchdog.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::inline v0 {

/// Every stroke writes one byte. A process that dies, or destroys this object, without `disarm`
/// lets the machine reset when the time has run out.
class DeviceWatchdog final : public Watchdog {
 public:
  /// `path`: usually /dev/watchdog. From then on it runs. `timeout`: asked of the device, rounded
  /// up to seconds; 0 keeps its own. `unsupported`: the device cannot do this time; it was stopped
  /// again. `io_error`: errno says why; EBUSY: another process (systemd?) has it.
  Status open(const char* path, Duration timeout = Duration{0});
  /// Takes over an open device.
  void adopt(int fd) { device_ = FileDescriptor{fd}; }
  [[nodiscard]] bool is_open() const { return device_.is_open(); }
  void stroke() override;
  /// The orderly end: writes the magic character and closes. A device built with `nowayout` goes
  /// on.
  void disarm();
  /// Strokes must be closer than this; 0: the device does not tell.
  [[nodiscard]] Duration timeout() const;
  /// Strokes that the device refused.
  [[nodiscard]] std::uint32_t failures() const { return failures_; }

 private:
  FileDescriptor device_{};
  std::uint32_t failures_ = 0;
};

}  // namespace picolo::inline v0
