// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/pty_line.hpp"

#include <fcntl.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): posix_openpt
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

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
  termios line{};
  if (!master.is_open() || ::grantpt(master.get()) != 0 || ::unlockpt(master.get()) != 0 ||
      ::ptsname_r(master.get(), name.data(), name.size()) != 0 ||
      ::tcgetattr(master.get(), &line) != 0) {
    throw host::UserError{host::ExitCode::device, path_,
                          "no pseudo-terminal: " + std::generic_category().message(errno),
                          "mount devpts"};
  }
  ::cfmakeraw(&line);
  static_cast<void>(::tcsetattr(master.get(), TCSANOW, &line));
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

void PtyLine::send(std::span<const std::uint8_t> bytes) {
  if (plugged()) { static_cast<void>(!::write(master_.get(), bytes.data(), bytes.size())); }
}

std::size_t PtyLine::take(std::span<std::uint8_t> buffer) {
  if (!plugged()) { return 0; }
  const ssize_t count = ::read(master_.get(), buffer.data(), buffer.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace picolo::tool
