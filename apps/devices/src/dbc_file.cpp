// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/devices/dbc_file.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace picolo::inline v0::devices {
namespace {

constexpr std::uint32_t kExtendedBit = 0x80000000U;
constexpr std::uint32_t kNoMessage = 0xC0000000U;  // holds signals that belong to none

/// Words, numbers and signs of one line, from left to right.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  void skip_space() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) {
      rest_.remove_prefix(1);
    }
  }
  bool take(char c) {
    skip_space();
    if (rest_.empty() || rest_.front() != c) { return false; }
    rest_.remove_prefix(1);
    return true;
  }
  std::string_view word() {
    skip_space();
    std::size_t size = 0;
    while (size < rest_.size() &&
           (std::isalnum(static_cast<unsigned char>(rest_[size])) != 0 || rest_[size] == '_')) {
      ++size;
    }
    const std::string_view found = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return found;
  }
  template <typename T>
  bool number(T& value) {
    skip_space();
    if (!rest_.empty() && rest_.front() == '+') { rest_.remove_prefix(1); }
    const auto result = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (result.ec != std::errc{}) { return false; }
    rest_.remove_prefix(static_cast<std::size_t>(result.ptr - rest_.data()));
    return true;
  }
  /// What stands between two quotation marks.
  bool quoted(std::string_view& text) {
    if (!take('"')) { return false; }
    const std::size_t end = rest_.find('"');
    if (end == std::string_view::npos) { return false; }
    text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return true;
  }
  bool skip_past(char c) {
    const std::size_t at = rest_.find(c);
    if (at == std::string_view::npos) { return false; }
    rest_.remove_prefix(at + 1);
    return true;
  }

 private:
  std::string_view rest_;
};

class Parser {
 public:
  Parser(DbcFile& file, std::vector<std::string>* imports) : file_(file), imports_(imports) {}

  void line(std::string_view text, std::size_t number) {
    number_ = number;
    Cursor cursor{text};
    const std::string_view keyword = cursor.word();
    if (keyword == "BO_") {
      message(cursor);
    } else if (keyword == "SG_") {
      signal(cursor);
    } else if (keyword == "SIG_VALTYPE_") {
      value_type(cursor);
    } else if (keyword == "CM_") {
      comment(cursor);
    }
  }

  void finish() {
    for (DbcFileMessage& message : file_.messages) {
      for (DbcFileSignal& signal : message.signals) { check(message, signal); }
    }
  }

 private:
  void problem(std::size_t line, const std::string& text) {
    file_.problems.push_back(file_.name + ":" + std::to_string(line) + ": " + text);
  }

  void message(Cursor& cursor) {
    current_ = nullptr;
    std::uint32_t id = 0;
    DbcFileMessage message;
    if (!cursor.number(id)) { return problem(number_, "a message without number; left out"); }
    message.name = cursor.word();
    if (message.name.empty() || !cursor.take(':') || !cursor.number(message.frame_bytes)) {
      return problem(number_, "a message must read 'BO_ number name: bytes sender'; left out");
    }
    if (id == kNoMessage) { return; }
    message.extended = (id & kExtendedBit) != 0;
    message.id = id & ~kExtendedBit;
    if (message.id > (message.extended ? 0x1FFFFFFFU : 0x7FFU)) {
      return problem(number_, message.name + ": the identifier has too many bits; left out");
    }
    if (file_.find(message.id, message.extended) != nullptr) {
      return problem(number_, message.name + ": a second message with this identifier; left out");
    }
    file_.messages.push_back(message);
    current_ = &file_.messages.back();
  }

  void signal(Cursor& cursor) {
    if (current_ == nullptr) { return; }
    DbcFileSignal signal{.line = number_};
    signal.name = cursor.word();
    if (!cursor.take(':')) {
      if (!multiplexing(cursor.word(), signal) || !cursor.take(':')) { return malformed(); }
    }
    std::uint32_t start = 0;
    std::uint32_t length = 0;
    int order = 0;
    if (!cursor.number(start) || !cursor.take('|') || !cursor.number(length) || !cursor.take('@') ||
        !cursor.number(order)) {
      return malformed();
    }
    const bool is_signed = cursor.take('-');
    if (!is_signed && !cursor.take('+')) { return malformed(); }
    if (!cursor.take('(') || !cursor.number(signal.factor) || !cursor.take(',') ||
        !cursor.number(signal.offset) || !cursor.take(')') || signal.name.empty()) {
      return malformed();
    }
    std::string_view unit;
    if (cursor.skip_past(']') && cursor.quoted(unit)) { signal.unit = unit; }
    if (start > 63 || length > 64 || order > 1 || !std::isfinite(signal.factor) ||
        !std::isfinite(signal.offset)) {
      return problem(number_, signal.name + ": bits or factors that no frame has; left out");
    }
    signal.bits = {.start_bit = static_cast<std::uint8_t>(start),
                   .length = static_cast<std::uint8_t>(length),
                   .big_endian = order == 0,
                   .type = is_signed ? DbcType::signed_integer : DbcType::unsigned_integer};
    current_->signals.push_back(signal);
  }

  void malformed() {
    problem(number_,
            "a signal must read 'SG_ name : start|length@order+ (factor,offset) "
            "[min|max] \"unit\"'; left out");
  }

  static bool multiplexing(std::string_view word, DbcFileSignal& signal) {
    if (word == "M") {
      signal.is_selector = true;
      return true;
    }
    if (word.size() < 2 || word.front() != 'm') { return false; }
    word.remove_prefix(1);
    if (word.back() == 'M') { word.remove_suffix(1); }
    signal.is_multiplexed = true;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), signal.mux_value);
    return result.ec == std::errc{} && result.ptr == word.data() + word.size();
  }

  void value_type(Cursor& cursor) {
    std::uint32_t id = 0;
    if (!cursor.number(id)) { return; }
    const std::string_view name = cursor.word();
    int kind = 0;
    if (!cursor.take(':') || !cursor.number(kind)) { return; }
    for (DbcFileMessage& message : file_.messages) {
      if (message.id != (id & ~kExtendedBit) || message.extended != ((id & kExtendedBit) != 0)) {
        continue;
      }
      for (DbcFileSignal& signal : message.signals) {
        if (signal.name != name) { continue; }
        if (kind == 1) { signal.bits.type = DbcType::float32; }
        if (kind == 2) { signal.bits.type = DbcType::float64; }
      }
    }
  }

  void comment(Cursor& cursor) {
    constexpr std::string_view kImport = "IMPORT ";
    std::string_view text;
    if (!cursor.quoted(text) || text.substr(0, kImport.size()) != kImport) { return; }
    if (imports_ != nullptr) { imports_->emplace_back(text.substr(kImport.size())); }
  }

  void check(DbcFileMessage& message, DbcFileSignal& signal) {
    const std::string where = message.name + "." + signal.name;
    if (message.frame_bytes > 8) {
      signal.problem = where + ": frames beyond 8 bytes are CAN FD, which is not supported";
    } else if (!signal.bits.valid(message.frame_bytes)) {
      signal.problem = where + " lies past the end of its frame of " +
                       std::to_string(message.frame_bytes) +
                       " bytes, or is a float of another length; correct the file";
    } else if (signal.is_multiplexed && message.selector() == nullptr) {
      signal.problem = where + " is multiplexed, but its message has no selector (M)";
    }
    if (!signal.problem.empty()) { problem(signal.line, signal.problem); }
  }

  DbcFile& file_;
  std::vector<std::string>* imports_;
  DbcFileMessage* current_ = nullptr;
  std::size_t number_ = 0;
};

void read_into(const std::filesystem::path& path, DbcFile& all, std::set<std::string>& seen) {
  if (!seen.insert(path.filename().string()).second) { return; }
  std::ifstream stream{path, std::ios::binary};
  if (!stream || std::filesystem::is_directory(path)) {
    throw std::invalid_argument{path.string() + ": cannot be read; check the name"};
  }
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  std::vector<std::string> imports;
  const DbcFile file = parse_dbc(text, path.string(), &imports);
  for (const DbcFileMessage& message : file.messages) {
    if (all.find(message.id, message.extended) == nullptr) { all.messages.push_back(message); }
  }
  all.problems.insert(all.problems.end(), file.problems.begin(), file.problems.end());
  for (const std::string& import : imports) {
    const std::filesystem::path name = std::filesystem::path{import}.filename();
    read_into(path.parent_path() / name, all, seen);
  }
}

}  // namespace

const DbcFileSignal* DbcFileMessage::selector() const {
  for (const DbcFileSignal& signal : signals) {
    if (signal.is_selector) { return &signal; }
  }
  return nullptr;
}

const DbcFileMessage* DbcFile::find(std::uint32_t id, bool extended) const {
  for (const DbcFileMessage& message : messages) {
    if (message.id == id && message.extended == extended) { return &message; }
  }
  return nullptr;
}

DbcFile parse_dbc(std::string_view text, const std::string& name,
                  std::vector<std::string>* imports) {
  DbcFile file{.name = name};
  Parser parser{file, imports};
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') { line.remove_suffix(1); }
    parser.line(line, ++number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  parser.finish();
  return file;
}

DbcFile read_dbc(const std::string& path) {
  DbcFile file{.name = path};
  std::set<std::string> seen;
  read_into(path, file, seen);
  if (file.messages.empty()) {
    throw std::invalid_argument{path + ": no message in it; give a DBC file (BO_ lines)"};
  }
  return file;
}

Result<double> dbc_value(const DbcFileMessage& message, const DbcFileSignal& signal,
                         ByteView data) {
  if (!signal.problem.empty()) { return Status::unsupported; }
  if (signal.is_multiplexed) {
    const DbcFileSignal* selector = message.selector();
    if (!selector->problem.empty()) { return Status::unsupported; }
    const Result<std::uint64_t> selected = dbc_raw(selector->bits, data);
    if (!selected || *selected != signal.mux_value) { return Status::out_of_range; }
  }
  const Result<std::uint64_t> raw = dbc_raw(signal.bits, data);
  if (!raw) { return raw.status(); }
  double value = 0.0;
  switch (signal.bits.type) {
    case DbcType::unsigned_integer: value = static_cast<double>(*raw); break;
    case DbcType::signed_integer:
      value = static_cast<double>(dbc_integer(signal.bits, data).value_or(0));
      break;
    case DbcType::float32:
      value = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(*raw)));
      break;
    case DbcType::float64: value = std::bit_cast<double>(*raw); break;
  }
  return value * signal.factor + signal.offset;
}

DbcWheelConfig dbc_wheel(const DbcFile& file, const std::string& signal) {
  const std::size_t dot = signal.find('.');
  const std::string message_name = signal.substr(0, dot);
  const std::string signal_name = dot == std::string::npos ? "" : signal.substr(dot + 1);
  for (const DbcFileMessage& message : file.messages) {
    if (message.name != message_name) { continue; }
    for (const DbcFileSignal& found : message.signals) {
      if (found.name != signal_name) { continue; }
      if (!found.problem.empty()) {
        throw std::invalid_argument{file.name + ":" + std::to_string(found.line) + ": " +
                                    found.problem};
      }
      DbcWheelConfig wheel{.id = message.id,
                           .extended = message.extended,
                           .frame_bytes = static_cast<std::uint8_t>(message.frame_bytes),
                           .signal = found.bits,
                           .factor = static_cast<float>(found.factor),
                           .offset = static_cast<float>(found.offset)};
      if (found.bits.length < 32) { wheel.counter.modulus = std::uint64_t{1} << found.bits.length; }
      if (found.is_multiplexed) {
        wheel.multiplexer = {message.selector()->bits, found.mux_value, true};
      }
      return wheel;
    }
  }
  throw std::invalid_argument{file.name + ": no signal '" + signal +
                              "'; name it MESSAGE.SIGNAL as in the file"};
}

}  // namespace picolo::inline v0::devices
