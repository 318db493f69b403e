// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The other end of an SLCAN line: what a USB adapter does.
#pragma once

#include <deque>
#include <string>

#include "picolo/drivers/slcan/slcan_line.hpp"

namespace picolo::test {

class SlcanAdapter {
 public:
  /// Bytes of the computer or board. What they bring is in `answers` and, when the channel is open,
  /// in `frames`.
  void take(ByteView bytes) {
    for (const std::uint8_t byte : bytes) {
      const slcan::LineCutter::Event event = cutter_.add(byte);
      if (event == slcan::LineCutter::Event::line) { obey(cutter_.line()); }
      if (event == slcan::LineCutter::Event::overlong) { ++damaged; }
    }
  }
  [[nodiscard]] static std::string line_of(const CanFrame& frame) {
    const slcan::Line line = slcan::encode(frame);
    return std::string{line.view().begin(), line.view().end()} + '\r';
  }

  bool open = false;
  char rate = 0;
  unsigned damaged = 0;  ///< lines that are no command
  std::string answers;
  std::deque<CanFrame> frames;

 private:
  void obey(ByteView line) {
    const char command = line.empty() ? '\r' : static_cast<char>(line[0]);
    bool done = true;
    if (command == 'C') {
      done = open;
      open = false;
    } else if (command == 'S') {
      done = !open && line.size() == 2;
      rate = done ? static_cast<char>(line[1]) : rate;
    } else if (command == 'O') {
      done = !open && rate != 0;
      open = true;
    } else if (command != '\r') {
      const Result<CanFrame> frame = slcan::decode(line);
      damaged += frame ? 0U : 1U;
      done = frame && open;
      if (done) {
        frames.push_back(*frame);
        answers += frame->extended ? 'Z' : 'z';
      }
    }
    answers += done ? '\r' : '\a';
  }

  slcan::LineCutter cutter_{};
};

}  // namespace picolo::test
