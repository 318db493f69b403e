// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

const char* to_string(Status status) {
  switch (status) {
    case Status::ok: return "ok";
    case Status::not_ready: return "not_ready";
    case Status::full: return "full";
    case Status::invalid_argument: return "invalid_argument";
    case Status::out_of_range: return "out_of_range";
    case Status::checksum: return "checksum";
    case Status::disconnected: return "disconnected";
    case Status::io_error: return "io_error";
    case Status::unsupported: return "unsupported";
    case Status::corrupt: return "corrupt";
    case Status::degenerate: return "degenerate";
  }
  return "unknown";
}

}  // namespace picolo::inline v0
