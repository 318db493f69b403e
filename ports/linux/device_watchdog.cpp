// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/device_watchdog.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace picolo::inline v0 {

Status DeviceWatchdog::open(const char* path) {
  device_ = FileDescriptor{::open(path, O_WRONLY | O_CLOEXEC)};
  return device_.is_open() ? Status::ok : Status::io_error;
}

void DeviceWatchdog::stroke() {
  constexpr char kAnything = 0;
  if (::write(device_.get(), &kAnything, 1) != 1) { ++failures_; }
}

void DeviceWatchdog::disarm() {
  constexpr char kMagic = 'V';
  if (::write(device_.get(), &kMagic, 1) != 1) { ++failures_; }
  device_.close();
}

}  // namespace picolo::inline v0
