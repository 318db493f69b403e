// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// struct termios2 lives in a header that does not go together with <termios.h>, which <pty.h>
// includes.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include "pseudo_terminal.hpp"

namespace picolo::test {

std::uint32_t line_rate(int fd) {
  termios2 line{};
  return ::ioctl(fd, TCGETS2, &line) == 0 ? line.c_ospeed : 0;
}

}  // namespace picolo::test
