// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/pty_line.hpp"

// termios2 knows arbitrary rates; <termios.h> cannot be included beside it.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): posix_openpt
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "picolo/devices/wrong_rate.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {

namespace fs = std::filesystem;

PtyLine::PtyLine(std::string path) : path_(std::move(path)) {
  plug();
}

void PtyLine::plug() {
  if (plugged()) { return; }
  std::error_code error;
  if (fs::exists(fs::symlink_status(path_, error)) && !fs::is_symlink(path_, error)) {
    throw host::UserError{host::ExitCode::usage, path_, "exists and is no link",
                          "give a path where a link to a terminal may be made"};
  }
  FileDescriptor master{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  std::array<char, 128> name{};
  termios2 line{};
  if (!master.is_open() || ::grantpt(master.get()) != 0 || ::unlockpt(master.get()) != 0 ||
      ::ptsname_r(master.get(), name.data(), name.size()) != 0 ||
      ::ioctl(master.get(), TCGETS2, &line) != 0) {
    throw host::UserError{host::ExitCode::device, path_,
                          "no pseudo-terminal: " + std::generic_category().message(errno),
                          "mount devpts"};
  }
  line.c_iflag = 0;
  line.c_oflag = 0;
  line.c_lflag = 0;
  static_cast<void>(::ioctl(master.get(), TCSETS2, &line));
  fs::remove(path_, error);
  fs::create_symlink(name.data(), path_, error);
  if (error) {
    throw host::UserError{host::ExitCode::usage, path_, "cannot be made: " + error.message(),
                          "give a path in a folder that you may write to"};
  }
  master_ = std::move(master);
}

void PtyLine::unplug() {
  if (!plugged()) { return; }
  std::error_code ignored;
  fs::remove(path_, ignored);
  master_.close();
}

std::uint32_t PtyLine::other_baud() const {
  termios2 line{};
  return ::ioctl(master_.get(), TCGETS2, &line) == 0 ? line.c_ospeed : 0;
}

void PtyLine::send(std::span<const std::uint8_t> bytes) {
  if (!plugged()) { return; }
  if (same_rate()) {
    static_cast<void>(!::write(master_.get(), bytes.data(), bytes.size()));
    return;
  }
  const auto garbled = devices::received_at(bytes, baud_, std::max(1U, other_baud()));
  static_cast<void>(!::write(master_.get(), garbled.data(), garbled.size()));
}

std::vector<std::uint8_t> PtyLine::take() {
  std::vector<std::uint8_t> bytes(256);
  const ssize_t count = plugged() ? ::read(master_.get(), bytes.data(), bytes.size()) : 0;
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  if (bytes.empty() || same_rate()) { return bytes; }
  return devices::received_at(bytes, std::max(1U, other_baud()), baud_);
}

}  // namespace picolo::tool
