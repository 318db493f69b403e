// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Worst stack of a linked Thumb image, from its disassembly: what really runs, the compiler's
/// library included.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace picolo::target {

struct StackFunction {
  std::string name;  ///< demangled
  std::uint32_t frame_bytes = 0;
  bool dynamic = false;  ///< the stack pointer moves by a register
  struct Call {
    std::uint32_t depth_bytes = 0;  ///< of this frame at the call
    std::string target;             ///< empty: through a pointer
  };
  std::vector<Call> calls;
};

/// From `objdump -d -C --no-show-raw-insn`.
std::map<std::string, StackFunction> parse_disassembly(const std::string& text);

/// Who may be called through pointers: beginnings of names, caller -> targets. `nothing` for a call
/// that cannot happen.
using IndirectCalls = std::map<std::string, std::set<std::string>>;
IndirectCalls read_indirect_calls(const std::string& path);

struct StackBound {
  std::uint32_t bytes = 0;
  std::vector<std::string> way;  ///< deepest chain
  std::set<std::string>
      trouble;  ///< recursion, dynamic frames, unlisted indirect calls, unknown functions
};
StackBound worst_stack(const std::map<std::string, StackFunction>& functions,
                       const IndirectCalls& indirect, const std::string& entry);

}  // namespace picolo::target
