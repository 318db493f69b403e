// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Runs the conformance suite on the port and prints what is left to do. On a board: start the
// port's devices first, write to a spare UART or through semihosting, and stop instead of
// returning.

#include <cstdio>

#include "picolo/hal/conformance/suite.hpp"
#include "picolo/template/template_bench.hpp"

int main() {
  picolo::template_port::TemplateBench bench;
  picolo::conformance::Suite suite{[](const char* text) { std::fputs(text, stdout); }};
  picolo::conformance::check_port(bench, suite);
  return suite.violated() == 0 ? 0 : 1;
}
