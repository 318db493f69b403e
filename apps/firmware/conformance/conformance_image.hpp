// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a board adds to the conformance image, in a file of its own beside main.cpp.
#pragma once

#include "picolo/hal/conformance/suite.hpp"

namespace picolo {

/// Starts the port's devices, calls conformance::check_port with their bench, then checks what only
/// this board has.
void check_board(conformance::Suite& suite);

}  // namespace picolo
