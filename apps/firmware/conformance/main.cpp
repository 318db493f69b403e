// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The HAL conformance suite on a board's own devices. Prints what is violated; the status is 0 when
// nothing is.

#include "conformance_image.hpp"
#include "platform.hpp"

int main() {
  picolo::conformance::Suite suite{picolo::platform::write};
  picolo::check_board(suite);
  picolo::platform::leave(suite.checked() > 0 && suite.violated() == 0 ? 0 : 1);
}
