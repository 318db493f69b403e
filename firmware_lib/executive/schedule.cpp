// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/executive/schedule.hpp"

#include <algorithm>

namespace picolo::inline v0 {
namespace {

/// How many of the frames [from, from + count) release the task.
std::int64_t releases(const TaskEntry& task, std::int64_t from, std::int64_t count) {
  const std::int64_t period = task.period_frames;
  const std::int64_t before_first = (task.offset_frames - from % period + period) % period;
  return count <= before_first ? 0 : (count - before_first - 1) / period + 1;
}

}  // namespace

Schedule::Schedule(const ExecutiveConfig& config, std::span<const TaskEntry> table,
                   std::span<TaskState> states)
    : config_(config), table_(table), states_(states) {}

Status Schedule::start(Timestamp first) {
  if (table_.size() != states_.size() || !valid_table(config_, table_)) {
    return Status::invalid_argument;
  }
  next_release_ = first;
  number_ = 0;
  position_ = 0;
  started_ = true;
  for (TaskState& state : states_) {
    state.pending = false;
    state.skip_next = false;
  }
  begin_round();
  return Status::ok;
}

void Schedule::begin_round() {
  std::uint32_t expected = 0;
  for (const TaskEntry& task : table_) { expected += config_.frames() / task.period_frames; }
  monitor_.begin(expected);
  if (position_ != 0) {  // entered in the middle, after a slip
    monitor_.spoil();
  }
}

void Schedule::slip(std::int64_t frames) {
  const std::int64_t to = position_ + frames;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const std::int64_t lost = releases(table_[i], position_, frames);
    if (lost == 0) { continue; }
    const bool runs_anyway = table_[i].due(static_cast<std::uint32_t>(to % config_.frames()));
    const std::int64_t made_up = runs_anyway ? 0 : 1;
    states_[i].counters.slips += static_cast<std::uint32_t>(lost - made_up);
    states_[i].pending = true;
  }
  frames_.slipped += static_cast<std::uint32_t>(frames);
  number_ += static_cast<std::uint32_t>(frames);
  next_release_ += frames * config_.minor_frame;
  position_ = static_cast<std::uint32_t>(to % config_.frames());
  if (to >= config_.frames()) {
    frames_.major_frames += static_cast<std::uint32_t>(to / config_.frames());
    begin_round();
  } else {
    monitor_.spoil();
  }
}

Result<FrameInfo> Schedule::begin_frame(Timestamp now) {
  if (!started_ || now < next_release_) { return Status::not_ready; }
  const std::int64_t late = (now - next_release_) / config_.minor_frame;
  if (late > 1) { slip(late - 1); }
  frames_.worst_lateness = std::max(frames_.worst_lateness, Duration{now - next_release_});
  return FrameInfo{next_release_, now, number_};
}

bool Schedule::take(std::size_t task) {
  TaskState& state = states_[task];
  if (!table_[task].due(position_) && !state.pending) { return false; }
  state.pending = false;
  if (state.skip_next) {
    state.skip_next = false;
    ++state.counters.skipped;
    return false;
  }
  running_ = static_cast<std::uint8_t>(task);
  return true;
}

void Schedule::finish(std::size_t task, Duration time, std::uint32_t cycles, bool passed) {
  running_ = kNoTask;
  TaskState& state = states_[task];
  TaskCounters& counters = state.counters;
  ++counters.runs;
  counters.last_cycles = cycles;
  counters.worst_cycles = std::max(counters.worst_cycles, cycles);
  if (!passed) {
    ++counters.unfinished;
  } else if (table_[task].due(position_)) {
    monitor_.pass(position_ * static_cast<std::uint32_t>(table_.size()) +
                  static_cast<std::uint32_t>(task));
  }
  if (time <= table_[task].budget) { return; }
  ++counters.overruns;
  ++overruns_;
  if (!faulted_) { overran_ = static_cast<std::uint8_t>(task); }
  state.skip_next = table_[task].policy == OverrunPolicy::skip_next;
  faulted_ = faulted_ || table_[task].policy == OverrunPolicy::fault;
}

bool Schedule::end_frame(Timestamp now) {
  ++frames_.frames;
  ++number_;
  ++position_;
  next_release_ += config_.minor_frame;
  if (now > next_release_) { ++frames_.late_ends; }
  if (position_ < config_.frames()) { return false; }
  const bool complete = monitor_.complete() && !faulted_;
  ++frames_.major_frames;
  frames_.strokes += complete ? 1U : 0U;
  position_ = 0;
  begin_round();
  return complete;
}

}  // namespace picolo::inline v0
