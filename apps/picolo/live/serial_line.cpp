// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/serial_line.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "picolo/host/error.hpp"

namespace picolo::tool {

bool open_line(TermiosSerialPort& port, const std::string& path, const std::string& option) {
  errno = 0;
  const Status status = port.open(path.c_str());
  const int error = errno;
  if (status == Status::ok) { return true; }
  const std::string reason = std::generic_category().message(error);
  if (status == Status::io_error && (error == ENOENT || error == ENXIO || error == ENODEV)) {
    fmt::print(stderr, "picolo: {} {}: {}; waiting for it\n", option, path, reason);
    return false;
  }
  if (status == Status::io_error && error == EACCES) {
    throw host::UserError{host::ExitCode::device, path, "you may not open it",
                          "join the group dialout: sudo usermod -aG dialout $USER, log in again"};
  }
  throw host::UserError{host::ExitCode::device, path,
                        status == Status::unsupported ? "is no serial line, or not of this rate"
                                                      : "cannot be opened: " + reason,
                        option == "can"
                            ? "give another rate: slcan:PATH,500000,115200"
                            : "picolo doctor --" + option + " " + path + " looks closer"};
}

}  // namespace picolo::tool
