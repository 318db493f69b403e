// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "played_line.hpp"

// termios2 knows arbitrary rates; <termios.h> cannot be included beside it.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): posix_openpt
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace picolo::test {

PlayedLine::PlayedLine() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
  std::array<char, 128> name{};
  if (!master_.is_open() || ::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0 ||
      ::ptsname_r(master_.get(), name.data(), name.size()) != 0) {
    throw std::runtime_error("no pseudo-terminal: is /dev/pts mounted?");
  }
  path_ = name.data();
}

void PlayedLine::send(std::span<const std::uint8_t> bytes) const {
  static_cast<void>(!::write(master_.get(), bytes.data(), bytes.size()));
}

std::size_t PlayedLine::take(std::span<std::uint8_t> buffer) const {
  const ssize_t count = ::read(master_.get(), buffer.data(), buffer.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

std::uint32_t PlayedLine::rate() const {
  termios2 line{};
  return ::ioctl(master_.get(), TCGETS2, &line) == 0 ? line.c_ospeed : 0;
}

}  // namespace picolo::test
