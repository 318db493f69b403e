// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/scip/scip.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/polar.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kLineFeed = '\n';
constexpr Duration kSettle = 50ms;
constexpr std::size_t kStatusOffset = 3;  // a line that begins before is the status

std::size_t write_text(const char* text, std::span<std::uint8_t> out) {
  std::size_t size = 0;
  for (; text[size] != 0 && size < out.size(); ++size) {
    out[size] = static_cast<std::uint8_t>(text[size]);
  }
  return size;
}

void write_digits(std::uint32_t value, std::span<std::uint8_t> out) {
  for (std::size_t i = out.size(); i > 0; --i) {
    out[i - 1] = static_cast<std::uint8_t>('0' + value % 10);
    value /= 10;
  }
}

}  // namespace

ScipProtocol::ScipProtocol(const ScipConfig& config)
    : config_(config), clock_(config.clock), step_(config.active ? Step::quit : Step::scanning) {}

Duration ScipProtocol::step_time(std::uint32_t steps) const {
  // model.valid(): no zero here, whatever the wire said
  return Duration{
      std::int64_t{steps} * 60'000'000 /
      (std::int64_t{config_.model.steps_per_turn} * std::int64_t{config_.model.turns_per_minute})};
}

/// The echo has no checksum: what differs from the command before is believed when it comes twice.
bool ScipProtocol::believable(const ScipCommand& command) {
  const bool known = !has_command_ || command == command_ || command == rumour_;
  if (known) {
    command_ = command;
    has_command_ = true;
  }
  rumour_ = command;
  return known;
}

void ScipProtocol::begin_scan(const ScipCommand& command) {
  in_scan_ = believable(command) && scan_.begin(command);
  if (!in_scan_) { ++counters_.implausible; }
  offset_ = 0;
  line_start_ = 0;
}

void ScipProtocol::text_line(ByteView text, const ByteTime& time) {
  const Result<ScipCommand> echo = parse_scip_echo(text);
  if (echo) {
    echo_at_ = time.first_bit(text.size() + 1);
    begin_scan(*echo);
    return;
  }
  ScipModel model = config_.model;
  if (read_scip_parameter(text, model)) {
    if (model.valid()) { config_.model = model; }
    model_known_ = true;
    return;
  }
  // The empty line behind an answer tells nothing new either.
  if (!text.empty() && !is_scip_answer(text)) {
    counters_.skipped_bytes += static_cast<std::uint32_t>(text.size() + 1);
  }
}

void ScipProtocol::end_scan(std::size_t offset) {
  in_scan_ = false;
  if (!scan_.complete(offset)) {
    ++counters_.implausible;
    return;
  }
  ++counters_.frames;
  const ScipCommand& command = scan_.command();
  const auto steps = static_cast<std::uint32_t>(command.last_step - command.first_step);
  const Timestamp known = config_.use_device_clock && scan_.has_time()
                              ? clock_.map(echo_at_, Duration{std::int64_t{scan_.time_ms()} * 1000})
                              : echo_at_;
  const Duration latency = config_.latency < Duration{0} ? step_time(steps) : config_.latency;
  scan_start_ = std::max(known - latency, last_stamp_);
  next_value_ = 0;
  scan_values_ = command.values();
}

/// Two whole lines between which the line feed was lost, or turned into something else.
bool ScipProtocol::two_lines(std::size_t start, ByteView text) {
  constexpr std::size_t kFull = kScipLineLength + 1;
  if (text.size() <= kFull) { return false; }
  const ByteView head = text.first(kFull);
  for (std::size_t between = 0; between < 2 && kFull + between < text.size(); ++between) {
    const ByteView tail = text.subspan(kFull + between);
    if (!scan_.is_whole(start, head) || !scan_.is_whole(start + kFull + 1, tail)) { continue; }
    return scan_.line(start, head) && scan_.line(start + kFull + 1, tail);
  }
  return false;
}

void ScipProtocol::end_line(const ByteTime& time) {
  const ByteView text{line_.data(), line_size_};
  const std::size_t start = line_start_;
  line_size_ = 0;
  line_start_ = offset_;
  if (!in_scan_) {
    text_line(text, time);
    return;
  }
  if (start < kStatusOffset) {
    if (parse_scip_echo(text)) {  // torn off, and begun again
      text_line(text, time);
      return;
    }
    const bool scan_follows =
        text.size() >= 2 && ((text[0] == '9' && text[1] == '9') || !scan_.command().continuous);
    // A damaged status is no reason to lose the scan behind it.
    const bool whole = text.size() == 3 && scip_sum(text.first(2)) == text[2];
    if (whole && !scan_follows) { in_scan_ = false; }
    return;
  }
  if (text.empty()) {
    if (scan_.may_end_at(start)) { end_scan(start); }
    return;
  }
  if (scan_.line(start, text) || two_lines(start, text)) {
    if (scan_.has_last_line()) { end_scan(offset_); }
    return;
  }
  if (parse_scip_echo(text)) {
    // The empty line was lost. The next scan begins when this one has been taken.
    end_scan(start);
    scan_waits_ = true;
    next_echo_ = *parse_scip_echo(text);
    echo_at_ = time.first_bit(text.size() + 1);
    return;
  }
  ++counters_.bad_checksums;
}

std::size_t ScipProtocol::push(std::uint8_t byte, const ByteTime& time,
                               std::span<RangeReading> /*readings*/) {
  if (scan_waits_) {
    scan_waits_ = false;
    begin_scan(next_echo_);
  }
  ++offset_;
  if (byte == kLineFeed) {
    end_line(time);
  } else if (line_size_ < line_.size()) {
    line_[line_size_] = byte;
    ++line_size_;
  } else {
    ++counters_.skipped_bytes;
  }
  if (scan_ready()) { deadline_ = time.arrived + config_.silence_timeout; }
  return 0;
}

std::size_t ScipProtocol::pull(std::span<RangeReading> readings) {
  std::size_t count = 0;
  const ScipCommand& command = scan_.command();
  const ScipModel& model = config_.model;
  for (; next_value_ < scan_values_ && count < readings.size(); ++next_value_, ++count) {
    const auto steps = static_cast<std::uint32_t>(next_value_ * command.cluster);
    const std::uint32_t range_mm = scan_.value(next_value_);
    const bool measured = range_mm >= model.min_mm && range_mm <= model.max_mm;
    RangeReading& reading = readings[count];
    reading.stamp = scan_start_ + step_time(steps);
    reading.range_m = measured ? static_cast<float>(range_mm) / 1000.0F : 0.0F;
    const auto step = static_cast<std::int32_t>(command.first_step + steps);
    reading.bearing_rad = clockwise_bearing_rad(static_cast<std::int32_t>(model.front_step) - step,
                                                static_cast<std::int32_t>(model.steps_per_turn));
    reading.starts_sweep = next_value_ == 0;
    reading.ends_sweep = next_value_ + 1 == scan_values_;
    last_stamp_ = reading.stamp;
  }
  counters_.samples += static_cast<std::uint32_t>(count);
  return count;
}

std::size_t ScipProtocol::ask(const char* text, Step next, Timestamp deadline,
                              std::span<std::uint8_t> out) {
  step_ = next;
  deadline_ = deadline;
  return write_text(text, out);
}

std::size_t ScipProtocol::ask_scans(Timestamp now, std::span<std::uint8_t> out) {
  const std::size_t size =
      ask("MD0000000001000\n", Step::scanning, now + config_.silence_timeout, out);
  write_digits(config_.model.first_step, out.subspan(2, 4));
  write_digits(config_.model.last_step, out.subspan(6, 4));
  return size;
}

std::size_t ScipProtocol::request(Timestamp now, std::span<std::uint8_t> out) {
  if (!config_.active) { return 0; }
  const bool due = now >= deadline_;
  switch (step_) {
    case Step::quit: return ask("QT\n", Step::version, now + kSettle, out);
    case Step::version:
      // Older devices start in SCIP 1.1; the others answer with an error and carry on.
      return due ? ask("SCIP2.0\n", Step::parameters, now + kSettle, out) : 0;
    case Step::parameters:
      if (!due) { return 0; }
      model_known_ = false;
      return ask("PP\n", Step::await, now + config_.answer_timeout, out);
    case Step::await:
      if (!due) { return 0; }
      if (!model_known_) {
        ++counters_.restarts;
        step_ = Step::quit;
        return 0;
      }
      step_ = Step::laser;
      return 0;
    case Step::laser: return ask("BM\n", Step::start, now + kSettle, out);
    case Step::start: return due ? ask_scans(now, out) : 0;
    case Step::scanning:
      if (due) {
        ++counters_.restarts;
        step_ = Step::quit;
      }
      return 0;
    case Step::resting: return 0;
  }
  return 0;
}

std::size_t ScipProtocol::farewell(std::span<std::uint8_t> out) {
  return ask("QT\n", Step::resting, Timestamp::max(), out);
}

void ScipProtocol::interrupted() {
  in_scan_ = false;
  scan_waits_ = false;
  line_size_ = 0;
  if (config_.active && step_ != Step::resting) {
    step_ = Step::quit;
    deadline_ = Timestamp::min();
  }
}

SerialCounters ScipProtocol::counters() const {
  SerialCounters counters = counters_;
  counters.clock_restarts = clock_.restarts();
  return counters;
}

}  // namespace picolo::inline v0
