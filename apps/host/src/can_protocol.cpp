// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/can_protocol.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "picolo/controller/can_codec.hpp"
#include "picolo/controller/can_table.hpp"

namespace picolo::host {
namespace {

constexpr int kReportMs = 25;

// Never with an exponent: not every reader of DBC files knows them.
std::string plain(double value) {
  std::string text = fmt::format("{:.10f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') { text.pop_back(); }
  return text;
}

std::string factor(const CanSignal& signal) {
  return plain(1.0 / signal.per_unit);
}

std::string limit(const CanSignal& signal, std::int64_t raw) {
  if (signal.per_unit == 1) { return fmt::format("{}", raw); }
  return plain(static_cast<double>(raw) / signal.per_unit);
}

// The code for "not available" included: tools clamp what is outside, and that would look real.
std::pair<std::string, std::string> range(const CanSignal& signal) {
  return {limit(signal, signal.lowest()), limit(signal, signal.highest())};
}

const char* sender(const CanMessage& message) {
  return message.is_command ? "Host" : "Picolo";
}
const char* receiver(const CanMessage& message) {
  return message.is_command ? "Picolo" : "Host";
}

std::string dbc_message(const CanMessage& message, std::uint16_t base_id) {
  std::string text =
      fmt::format("BO_ {} {}: 8 {}\n", base_id + message.offset, message.name, sender(message));
  const auto line = [&](const char* name, int start, int bits, char sign, const std::string& scale,
                        const std::string& low, const std::string& high, const char* unit) {
    text += fmt::format(" SG_ {} : {}|{}@1{} ({},0) [{}|{}] \"{}\" {}\n", name, start, bits, sign,
                        scale, low, high, unit, receiver(message));
  };
  line("crc", 0, 8, '+', "1", "0", "255", "");
  line("counter", 8, 4, '+', "1", "0", "14", "");
  for (const CanSignal& signal : message.signals) {
    const auto [low, high] = range(signal);
    line(signal.name, signal.start_bit, signal.bits, signal.is_signed ? '-' : '+', factor(signal),
         low, high, signal.unit);
  }
  return text + "\n";
}

std::string period(const CanMessage& message) {
  return message.every == 0 ? "" : fmt::format("{} ms", message.every * kReportMs);
}

std::string code_text(const CanSignal& signal) {
  return signal.kind == CanKind::number ? fmt::format("{}", signal.not_available()) : "";
}

}  // namespace

std::string can_dbc(std::uint16_t base_id) {
  std::string text =
      "VERSION \"\"\n\nNS_ :\n\tCM_\n\tBA_DEF_\n\tBA_\n\tVAL_\n\tBA_DEF_DEF_\n\nBS_:\n\n"
      "BU_: Picolo Host\n\n\n";
  for (const CanMessage* message : can_table::kMessages) { text += dbc_message(*message, base_id); }
  text +=
      "CM_ \"Made from controller/include/picolo/controller/can_table.hpp by: picolo protocol "
      "--dbc\";\n";
  for (const CanMessage* message : can_table::kMessages) {
    const int id = base_id + message->offset;
    text += fmt::format("CM_ BO_ {} \"{}\";\n", id, message->meaning);
    for (const CanSignal& signal : message->signals) {
      if (*signal.meaning == '\0') { continue; }
      text += fmt::format("CM_ SG_ {} {} \"{}\";\n", id, signal.name, signal.meaning);
    }
  }
  text += "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_DEF_ BO_ \"E2EDataId\" INT 0 65535;\n";
  text += "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\nBA_DEF_DEF_ \"E2EDataId\" 0;\n";
  for (const CanMessage* message : can_table::kMessages) {
    const int id = base_id + message->offset;
    if (message->every > 0) {
      text += fmt::format("BA_ \"GenMsgCycleTime\" BO_ {} {};\n", id, message->every * kReportMs);
    }
    text += fmt::format("BA_ \"E2EDataId\" BO_ {} {};\n", id, kCanDataIdBase + message->offset);
  }
  for (const CanMessage* message : can_table::kMessages) {
    for (const CanSignal& signal : message->signals) {
      if (signal.names.empty()) { continue; }
      text += fmt::format("VAL_ {} {}", base_id + message->offset, signal.name);
      for (const CanName& name : signal.names) {
        text += fmt::format(" {} \"{}\"", name.value, name.text);
      }
      text += " ;\n";
    }
  }
  return text;
}

std::string can_tables(std::uint16_t base_id) {
  std::string text =
      "| message | id | from | every | data id | meaning |\n|---|---|---|---|---|---|\n";
  for (const CanMessage* message : can_table::kMessages) {
    text += fmt::format("| {} | 0x{:03X} | {} | {} | 0x{:04X} | {} |\n", message->name,
                        base_id + message->offset, sender(*message), period(*message),
                        kCanDataIdBase + message->offset, message->meaning);
  }
  text +=
      "\n| message | signal | bits | type | one step | range | not available | meaning |\n"
      "|---|---|---|---|---|---|---|---|\n";
  std::map<std::string, std::span<const CanName>> names;
  for (const CanMessage* message : can_table::kMessages) {
    for (const CanSignal& signal : message->signals) {
      const auto [low, high] = range(signal);
      const bool named = signal.kind == CanKind::name;
      if (named) { names[fmt::format("{}.{}", message->name, signal.name)] = signal.names; }
      text += fmt::format(
          "| {} | {} | {}..{} | {}{} | {} | {} | {} | {} |\n", message->name, signal.name,
          signal.start_bit, signal.start_bit + signal.bits - 1, signal.is_signed ? 'i' : 'u',
          signal.bits, named ? "" : fmt::format("{} {}", factor(signal), signal.unit),
          named ? "" : fmt::format("{} .. {}", low, high), code_text(signal), signal.meaning);
    }
  }
  text += "\n| signal | values |\n|---|---|\n";
  for (const auto& [signal, values] : names) {
    text += fmt::format("| {} |", signal);
    for (const CanName& name : values) { text += fmt::format(" {} {},", name.value, name.text); }
    text.pop_back();
    text += " |\n";
  }
  return text;
}

}  // namespace picolo::host
