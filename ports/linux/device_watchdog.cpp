// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/device_watchdog.hpp"

#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace picolo::inline v0 {

Status DeviceWatchdog::open(const char* path, Duration timeout) {
  device_ = FileDescriptor{::open(path, O_WRONLY | O_CLOEXEC)};
  if (!device_.is_open()) { return Status::io_error; }
  if (timeout <= Duration{0}) { return Status::ok; }
  const auto wanted = static_cast<int>((timeout.count() + 999'999) / 1'000'000);
  int seconds = wanted;
  if (::ioctl(device_.get(), WDIOC_SETTIMEOUT, &seconds) != 0 || seconds != wanted) {
    disarm();
    return Status::unsupported;
  }
  return Status::ok;
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

Duration DeviceWatchdog::timeout() const {
  int seconds = 0;
  if (::ioctl(device_.get(), WDIOC_GETTIMEOUT, &seconds) != 0) { return Duration{0}; }
  return std::chrono::seconds{seconds};
}

}  // namespace picolo::inline v0
