// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How conformance checks report: without a test framework, so that they run on a bare board too.
///
/// A port supplies a harness per interface, a small struct that plays the other end of the wire;
/// what it must offer is a concept in each header. `check_can_bus(harness, checker)` and its
/// sisters then test the port's object against the contracts of hal, and report each violation with
/// the contract's words and the usual cure.
#pragma once

#include <cstdint>

namespace picolo::inline v0::conformance {

/// Called once for each violated contract, at once. Both texts are literals.
using Report = void (*)(void* context, const char* contract, const char* cure);

class Checker {
 public:
  explicit Checker(Report report, void* context = nullptr) : report_(report), context_(context) {}

  /// Returns `holds`, so that a check can stop where going on makes no sense.
  bool expect(bool holds, const char* contract, const char* cure) {
    ++checked_;
    if (!holds) {
      ++violated_;
      report_(context_, contract, cure);
    }
    return holds;
  }
  [[nodiscard]] std::uint32_t checked() const { return checked_; }
  [[nodiscard]] std::uint32_t violated() const { return violated_; }

 private:
  Report report_;
  void* context_;
  std::uint32_t checked_ = 0;
  std::uint32_t violated_ = 0;
};

}  // namespace picolo::inline v0::conformance
