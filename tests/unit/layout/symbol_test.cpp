// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The static libraries refer to nothing that a bare-metal target has not, and own no memory.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "symbol_rules.hpp"

namespace picolo::layout {
namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe{popen(command.c_str(), "r"), pclose};
  std::string output;
  if (!pipe) { return output; }
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe.get())) {
    output.append(buffer.data(), count);
  }
  return output;
}

// Sanitizers and coverage add references of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
class Archive : public ::testing::TestWithParam<const char*> {};

TEST_P(Archive, RefersToNothingForbiddenAndOwnsNoMemory) {
  const auto symbols =
      parse_symbols(output_of(PICOLO_NM " --format=sysv " + std::string{GetParam()}));
  ASSERT_GT(symbols.size(), 10U) << "nm found nothing in " << GetParam();
  for (const Symbol& symbol : symbols) {
    EXPECT_EQ(symbol_violation(symbol), "") << GetParam() << ": " << symbol.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Layout, Archive, ::testing::Values(PICOLO_ARCHIVES));
#endif

TEST(SymbolRules, RefuseHeapExceptionsLibmAndOutput) {
  for (const char* name :
       {"malloc", "free", "_Znwm", "_ZdlPvm", "__cxa_throw", "__cxa_guard_acquire",
        "_Unwind_Resume", "_ZSt20__throw_length_errorPKc", "printf", "__assert_fail", "abort",
        "sinf", "atan2", "sincosf", "floor", "lroundf", "__cxa_atexit"}) {
    EXPECT_NE(symbol_violation({name, "U", ""}), "") << name;
  }
}

TEST(SymbolRules, AcceptMemoryCopiesCompilerHelpersAndOwnNames) {
  for (const char* name : {"memcpy", "memset", "memmove", "__popcountdi2", "__aeabi_fadd",
                           "_ZN6picolo2v010Occupancy10free_cellsEv"}) {
    EXPECT_EQ(symbol_violation({name, "U", ""}), "") << name;
  }
}

TEST(SymbolRules, RefuseWritableAndGuardedStatics) {
  EXPECT_NE(symbol_violation({"_ZL5count", "b", ".bss._ZL5count"}), "");
  EXPECT_NE(symbol_violation({"g_table", "D", ".data.g_table"}), "");
  EXPECT_NE(symbol_violation({"_ZGVZ4testvE1a", "b", ".bss"}), "");
  EXPECT_NE(symbol_violation({"_ZN13EigenOfPicoloL5tableE", "b", ".bss", 64}), "");
  EXPECT_EQ(symbol_violation({"_ZN13EigenOfPicoloL4lastE", "b", ".bss", 1}), "");
  EXPECT_NE(symbol_violation({"_ZTIN6picolo2v06CanBusE", "V", ".data.rel.ro"}), "");
  EXPECT_EQ(symbol_violation({"_ZL6kNames", "d", ".data.rel.ro.local"}), "");
  EXPECT_EQ(symbol_violation({"_ZL6kTable", "r", ".rodata"}), "");
  EXPECT_EQ(symbol_violation({"_ZN6picolo2v05crc32E", "T", ".text.crc32"}), "");
}

TEST(SymbolRules, ReadTheTableOfNm) {
  const auto symbols = parse_symbols(
      "\nSymbols from crc.o:\n\n"
      "Name                  Value           Class        Type         Size             Line  "
      "Section\n\n"
      "crc32               |0000000000000000|   T  |              FUNC|0000000000000040|     "
      "|.text\n"
      "memcpy              |                |   U  |            NOTYPE|                |     "
      "|*UND*\n");
  ASSERT_EQ(symbols.size(), 2U);
  EXPECT_EQ(symbols[0].name, "crc32");
  EXPECT_EQ(symbols[0].section, ".text");
  EXPECT_EQ(symbols[0].bytes, 0x40U);
  EXPECT_EQ(symbols[1].kind, "U");
}

}  // namespace
}  // namespace picolo::layout
