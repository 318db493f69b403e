// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a command ends: the exit codes of the tool and the error that carries one.
#pragma once

#include <stdexcept>
#include <string>

namespace picolo::host {

enum class ExitCode : int {
  done = 0,
  refused = 1,  ///< it ran, but its result must not be used; the message says why
  usage = 2,    ///< command line or configuration
  input = 3,    ///< unreadable, damaged, or without a valid record
  device = 4,   ///< a device, a line, or the disk failed while in use
};

/// Ends a command. `what()` reads "FILE: cause; cure".
class UserError : public std::runtime_error {
 public:
  UserError(ExitCode code, const std::string& file, const std::string& cause,
            const std::string& cure);
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace picolo::host
