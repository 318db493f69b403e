// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Opening a serial line by the path that the command line gives it.
#pragma once

#include <string>

#include "picolo/linux/termios_serial_port.hpp"

namespace picolo::tool {

/// Opens a line, or says that it is waited for. Throws UserError (device) for what waiting cannot
/// cure. `option`: the command line's, for picolo doctor. False: not there yet; `read` looks again.
bool open_line(TermiosSerialPort& port, const std::string& path, const std::string& option);

}  // namespace picolo::tool
