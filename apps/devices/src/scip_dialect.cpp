// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// The simulated LD06, turning counter-clockwise, as a Hokuyo of 450 steps a turn of which 338 are
// measured.
#include <algorithm>
#include <optional>

#include "dialect.hpp"
#include "picolo/drivers/scip/scip_text.hpp"

namespace picolo::inline v0::devices {
namespace {

constexpr std::uint32_t kStepsPerTurn = 450;  ///< one a point of the LD06
constexpr std::uint32_t kLastStep = 337;
constexpr std::uint32_t kFrontStep = 169;
constexpr std::size_t kLineLength = 64;

class ScipDialect final : public LidarDialect {
 public:
  using LidarDialect::LidarDialect;

 private:
  /// The device's step that a point measures; nothing behind its back.
  static std::optional<std::uint32_t> step_of(const Ld06Packet& packet, std::size_t point) {
    const std::uint32_t along = span_cdeg(packet) * static_cast<std::uint32_t>(point) / 11U;
    const std::uint32_t turned = (packet.start_cdeg + along) % kLd06FullTurnCdeg;
    const std::uint32_t cell = kLd06FullTurnCdeg / kStepsPerTurn;
    const std::uint32_t step = (turned + cell / 2) / cell + kFrontStep;
    const std::uint32_t wrapped = step % kStepsPerTurn;
    if (wrapped > kLastStep) { return std::nullopt; }
    return wrapped;
  }

  void packet(const Ld06Packet& packet, Timestamp stamp) override {
    for (std::size_t i = 0; i < packet.points.size(); ++i) {
      const std::optional<std::uint32_t> step = step_of(packet, i);
      if (!step) { continue; }
      if (*step == 0) { values_.clear(); }
      if (values_.size() == *step) { values_.push_back(packet.points[i].distance_mm); }
      if (*step != kLastStep || values_.size() != kLastStep + 1) { continue; }
      if (scanning_) { put_scan(stamp); }
      values_.clear();
    }
    // As many bytes as a fast line carries between two packets of the LD06.
    for (std::size_t room = 400; !lines_.empty() && lines_.front().size() <= room;) {
      room -= lines_.front().size();
      say(lines_.front(), stamp);
      lines_.pop_front();
    }
  }

  void obey(std::uint8_t byte) override {
    if (byte != '\n') {
      if (command_.size() == kLineLength) { command_.clear(); }  // no command is so long
      command_.push_back(static_cast<char>(byte));
      return;
    }
    const std::string command = std::exchange(command_, {});
    const bool measures = command.rfind("MD", 0) == 0;
    const bool known = measures || command == "QT" || command == "PP" || command == "BM";
    put(command, false);
    put(known ? "00" : "0E", true);
    if (command == "PP") {
      for (const char* fact : {"MODL:picolo;", "DMIN:20;", "DMAX:12000;", "ARES:450;", "AMIN:0;",
                               "AMAX:337;", "AFRT:169;", "SCAN:600;"}) {
        put_parameter(fact);
      }
    }
    put("", false);
    if (command == "QT") { scanning_ = false; }
    if (measures) {
      scanning_ = true;
      scan_command_ = command;
    }
  }

  void put_scan(Timestamp stamp) {
    put(scan_command_, false);
    put("99", true);
    put(coded(static_cast<std::uint32_t>(stamp.time_since_epoch() / 1ms % (1 << 24)), 4), true);
    std::string data;
    for (const std::uint16_t value : values_) { data += coded(value, 3); }
    for (std::size_t at = 0; at < data.size(); at += kLineLength) {
      put(data.substr(at, kLineLength), true);
    }
    put("", false);
  }

  void put(const std::string& text, bool with_sum) {
    Bytes line{text.begin(), text.end()};
    if (with_sum) { line.push_back(scip_sum(line)); }
    line.push_back('\n');
    lines_.push_back(line);
  }
  /// The sum stands behind the semicolon and does not count it.
  void put_parameter(const std::string& text) {
    const Bytes fact{text.begin(), text.end() - 1};
    put(text + static_cast<char>(scip_sum(fact)), false);
  }
  static std::string coded(std::uint32_t value, unsigned size) {
    std::string text;
    for (unsigned i = size; i > 0; --i) {
      text.push_back(static_cast<char>(((value >> (6 * (i - 1))) & 0x3FU) + 0x30U));
    }
    return text;
  }

  std::vector<std::uint16_t> values_;
  std::deque<Bytes> lines_;
  std::string command_;
  std::string scan_command_;
  bool scanning_ = false;
};

}  // namespace

SerialPortPointer make_scip_dialect(SerialPort& ld06) {
  return make_port<ScipDialect>(ld06);
}

}  // namespace picolo::inline v0::devices
