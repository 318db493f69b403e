// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/error.hpp"

namespace picolo::host {

UserError::UserError(ExitCode code, const std::string& file, const std::string& cause,
                     const std::string& cure)
    : std::runtime_error{(file.empty() ? "" : file + ": ") + cause +
                         (cure.empty() ? "" : "; " + cure)},
      code_{code} {}

}  // namespace picolo::host
