// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "stack_analysis.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

namespace picolo::target {
namespace {

/// Registers of a list such as {r4, r5, lr} or {d8-d11}.
std::uint32_t registers_in(const std::string& list) {
  static const std::regex item{R"(([a-z]+)(\d*)(?:-[a-z]+(\d+))?)"};
  std::uint32_t bytes = 0;
  for (std::sregex_iterator it{list.begin(), list.end(), item}, end; it != end; ++it) {
    const std::string kind = (*it)[1];
    const std::uint32_t each = kind == "d" ? 8 : 4;
    const std::string last = (*it)[3];
    bytes +=
        each *
        (last.empty() ? 1U : static_cast<std::uint32_t>(std::stoi(last) - std::stoi((*it)[2]) + 1));
  }
  return bytes;
}

/// How far an instruction moves the stack pointer down; negative: up.
std::optional<int> moves(const std::string& mnemonic, const std::string& operands, bool& dynamic) {
  static const std::regex amount{R"(^sp, (?:sp, )?#(\d+))"};
  static const std::regex indexed{R"(\[sp, #-(\d+)\]!)"};
  static const std::regex after{R"(\[sp\], #(\d+))"};
  std::smatch match;
  const auto begins = [&](const char* start) { return mnemonic.rfind(start, 0) == 0; };
  const auto list = [&] {
    return static_cast<int>(registers_in(operands.substr(operands.find('{'))));
  };
  if (begins("push") || begins("vpush")) { return list(); }
  if (begins("pop") || begins("vpop")) { return -list(); }
  if ((begins("stmdb") || begins("vstmdb")) && operands.rfind("sp!", 0) == 0) { return list(); }
  if ((begins("ldmia") || begins("vldmia")) && operands.rfind("sp!", 0) == 0) { return -list(); }
  if (begins("sub") && operands.rfind("sp", 0) == 0) {
    if (std::regex_search(operands, match, amount)) { return std::stoi(match[1]); }
    dynamic = true;
  }
  if (begins("add") && operands.rfind("sp", 0) == 0 && std::regex_search(operands, match, amount)) {
    return -std::stoi(match[1]);
  }
  if ((begins("str") || begins("vstr")) && std::regex_search(operands, match, indexed)) {
    return std::stoi(match[1]);
  }
  if ((begins("ldr") || begins("vldr")) && std::regex_search(operands, match, after)) {
    return -std::stoi(match[1]);
  }
  if (begins("mov") && operands.rfind("sp,", 0) == 0) { dynamic = true; }
  return std::nullopt;
}

/// Follows one function's instructions in the order of their addresses.
class Walker {
 public:
  explicit Walker(StackFunction& function) : function_(function) {}

  void step(const std::string& address, const std::string& mnemonic, const std::string& operands) {
    if (const auto known = at_target_.find(address); known != at_target_.end()) {
      depth_ = unreachable_ ? known->second : std::max(depth_, known->second);
    } else if (unreachable_) {
      depth_ = static_cast<int>(function_.frame_bytes);  // reached by a table or from below
    }
    unreachable_ = false;
    if (const auto move = moves(mnemonic, operands, function_.dynamic)) { depth_ += *move; }
    depth_ = std::max(depth_, 0);
    function_.frame_bytes = std::max(function_.frame_bytes, static_cast<std::uint32_t>(depth_));
    branch(mnemonic, operands);
  }

 private:
  void branch(const std::string& mnemonic, const std::string& operands) {
    static const std::regex place{R"(^(?:r\d+, )?([0-9a-f]+) <(.+)>$)"};
    static const std::regex inside{R"(^(.*)\+0x[0-9a-f]+$)"};
    const bool link = mnemonic == "bl" || mnemonic == "blx";
    const bool jump = mnemonic[0] == 'b' && !link && mnemonic != "bic" &&
                      mnemonic.rfind("bf", 0) != 0 && mnemonic.rfind("bic", 0) != 0 &&
                      mnemonic != "bkpt";
    const bool compare = mnemonic == "cbz" || mnemonic == "cbnz";
    const bool always =
        mnemonic == "b.n" || mnemonic == "b.w" || mnemonic == "b" || mnemonic == "bx";
    std::smatch match;
    if ((link || jump || compare) && std::regex_search(operands, match, place)) {
      std::smatch within;
      const std::string name = match[2];
      const bool own = name == function_.name ||
                       (std::regex_match(name, within, inside) && within[1] == function_.name);
      if (own && !link) {
        int& known = at_target_[match[1]];
        known = std::max(known, depth_);
      } else {
        call(own                                      ? function_.name
             : std::regex_match(name, within, inside) ? std::string{within[1]}
                                                      : name);
      }
    } else if (link || (mnemonic == "bx" && operands != "lr")) {
      call("");
    }
    if (always || (mnemonic.rfind("pop", 0) == 0 && operands.find("pc") != std::string::npos) ||
        (mnemonic.rfind("ld", 0) == 0 && operands.find("pc") != std::string::npos &&
         operands.find("[pc") == std::string::npos) ||
        mnemonic.rfind("tb", 0) == 0) {
      unreachable_ = true;
    }
  }
  void call(const std::string& target) {
    function_.calls.push_back({static_cast<std::uint32_t>(depth_), target});
  }

  StackFunction& function_;
  std::map<std::string, int> at_target_;
  int depth_ = 0;
  bool unreachable_ = false;
};

bool begins_with(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

class Search {
 public:
  Search(const std::map<std::string, StackFunction>& functions, const IndirectCalls& indirect,
         StackBound& bound)
      : functions_(functions), indirect_(indirect), bound_(bound) {}

  std::uint32_t worst(const std::string& name, std::vector<std::string>& way) {
    if (const auto known = known_.find(name); known != known_.end()) {
      way = known->second.second;
      return known->second.first;
    }
    const auto found = functions_.find(name);
    if (found == functions_.end()) {
      bound_.trouble.insert("no code of " + name);
      return 0;
    }
    if (!open_.insert(name).second) {
      bound_.trouble.insert("recursion through " + name);
      return 0;
    }
    if (found->second.dynamic) { bound_.trouble.insert("dynamic frame in " + name); }
    std::uint32_t most = found->second.frame_bytes;
    std::vector<std::string> deepest;
    for (const StackFunction::Call& call : found->second.calls) {
      for (const std::string& target : targets(name, call.target)) {
        std::vector<std::string> below;
        const std::uint32_t depth = call.depth_bytes + worst(target, below);
        if (depth > most) {
          most = depth;
          deepest = below;
        }
      }
    }
    open_.erase(name);
    deepest.insert(deepest.begin(), name + " " + std::to_string(found->second.frame_bytes));
    way = deepest;
    known_[name] = {most, deepest};
    return most;
  }

 private:
  std::set<std::string> targets(const std::string& caller, const std::string& target) {
    if (!target.empty()) { return {target}; }
    const std::pair<const std::string, std::set<std::string>>* row = nullptr;
    for (const auto& candidate : indirect_) {
      const bool longer = row == nullptr || candidate.first.size() > row->first.size();
      if (begins_with(caller, candidate.first) && longer) { row = &candidate; }
    }
    if (row == nullptr) {
      bound_.trouble.insert("a call through a pointer that is not listed, in " + caller);
      return {};
    }
    std::set<std::string> all;
    for (const std::string& wanted : row->second) {
      const std::size_t before = all.size();
      for (const auto& [name, function] : functions_) {
        if (begins_with(name, wanted)) { all.insert(name); }
      }
      if (all.size() == before) {
        bound_.trouble.insert("listed, but not in the image: " + wanted);
      }
    }
    return all;
  }

  const std::map<std::string, StackFunction>& functions_;
  const IndirectCalls& indirect_;
  StackBound& bound_;
  std::map<std::string, std::pair<std::uint32_t, std::vector<std::string>>> known_;
  std::set<std::string> open_;
};

}  // namespace

std::map<std::string, StackFunction> parse_disassembly(const std::string& text) {
  static const std::regex head{R"(^[0-9a-f]+ <(.+)>:$)"};
  static const std::regex row{R"(^\s*([0-9a-f]+):\t(\S+)(?:\t(.*))?$)"};
  std::map<std::string, StackFunction> functions;
  std::istringstream lines(text);
  std::optional<Walker> walker;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, head)) {
      StackFunction& function = functions[match[1]];
      function.name = match[1];
      walker.emplace(function);
    } else if (walker && std::regex_match(line, match, row)) {
      std::string operands = match[3];
      operands = operands.substr(0, operands.find("\t@"));
      walker->step(match[1], match[2], operands);
    }
  }
  return functions;
}

IndirectCalls read_indirect_calls(const std::string& path) {
  IndirectCalls calls;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t arrow = line.find(" -> ");
    if (line.empty() || line[0] == '#' || arrow == std::string::npos) { continue; }
    std::set<std::string>& targets = calls[line.substr(0, arrow)];
    const std::string target = line.substr(arrow + 4);
    if (target != "nothing") { targets.insert(target); }
  }
  return calls;
}

StackBound worst_stack(const std::map<std::string, StackFunction>& functions,
                       const IndirectCalls& indirect, const std::string& entry) {
  StackBound bound;
  Search search{functions, indirect, bound};
  for (const auto& [name, function] : functions) {
    if (begins_with(name, entry)) { bound.bytes = search.worst(name, bound.way); }
  }
  if (bound.way.empty()) { bound.trouble.insert("no function begins with " + entry); }
  return bound;
}

}  // namespace picolo::target
