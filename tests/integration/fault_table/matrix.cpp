// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "matrix.hpp"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <thread>

#include "picolo/core/random.hpp"

namespace picolo::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kChanged_m = 0.05;
constexpr double kChanged_rad = 1.0 * kDegree;
constexpr double kWrong_m = 0.20;
constexpr double kWrong_rad = 3.0 * kDegree;
constexpr int kInARow = 3;

struct Difference {
  double m = 0.0;
  double rad = 0.0;
  [[nodiscard]] bool beyond(double most_m, double most_rad) const {
    return m > most_m || rad > most_rad;
  }
};

Difference difference(const Pose2d& a, const Pose2d& b) {
  return {std::hypot(a.x_m - b.x_m, a.y_m - b.y_m),
          std::abs(std::remainder(a.theta_rad - b.theta_rad, 2.0 * std::numbers::pi))};
}

/// The twin's pose at an instant: the truth of a recorded drive.
Pose2d pose_at(const Twin& twin, Timestamp stamp) {
  const auto next =
      std::upper_bound(twin.begin(), twin.end(), stamp,
                       [](Timestamp at, const Publication& p) { return at < p.stamp; });
  if (next == twin.begin()) { return next->map_T_base; }
  const Publication& before = *(next - 1);
  if (next == twin.end() || next->stamp == before.stamp) { return before.map_T_base; }
  return interpolate(
      before.map_T_base, next->map_T_base,
      to_seconds_f64(stamp - before.stamp) / to_seconds_f64(next->stamp - before.stamp));
}

/// Memory that children write and the parent reads.
template <typename T>
class Shared {
 public:
  explicit Shared(std::size_t size)
      : bytes_(size * sizeof(T)),
        memory_(mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
        elements_(static_cast<T*>(memory_), size) {
    if (memory_ == MAP_FAILED) { std::abort(); }
    for (T& element : elements_) { std::construct_at(&element); }
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() { munmap(memory_, bytes_); }
  [[nodiscard]] std::span<T> elements() { return elements_; }

 private:
  std::size_t bytes_;
  void* memory_;
  std::span<T> elements_;
};

/// Children, as many at a time as there are processors.
class Children {
 public:
  template <typename Work>
  void start(const Work& work) {
    while (running_ >= most_) { wait_for_one(); }
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) { std::abort(); }
    if (child == 0) {
      work();
      _exit(0);
    }
    ++running_;
  }
  void join() {
    while (running_ > 0) { wait_for_one(); }
  }

 private:
  void wait_for_one() {
    int status = 0;
    if (wait(&status) < 0 || status != 0) { std::abort(); }
    --running_;
  }

  unsigned most_ = std::max(1U, std::thread::hardware_concurrency());
  unsigned running_ = 0;
};

std::vector<Publication> watch(Subject& subject) {
  std::vector<Publication> publications;
  publications.reserve(kFrames);
  while (publications.size() < kFrames) {
    subject.run_frame();
    publications.push_back(subject.publication());
  }
  return publications;
}

std::vector<Fault> faults_of(const std::vector<Sensor>& sensors, Timestamp begin,
                             std::uint64_t seed) {
  std::vector<Fault> faults;
  for (const Sensor sensor : sensors) {
    for (std::size_t kind = 0; kind < kKindNames.size(); ++kind) {
      const std::uint64_t cell = static_cast<std::uint64_t>(sensor) * 16 + kind;
      faults.push_back({.sensor = sensor,
                        .kind = static_cast<Kind>(kind),
                        .begin = begin,
                        .end = begin + kFaultLength,
                        .seed = seed * 1000 + cell});
    }
  }
  return faults;
}

/// Nothing of the pose comes from the accelerometer: it is judged by what it is for. The vehicle
/// leans for some seconds of the fault; that must be said, nothing else may be, and the vehicle may
/// not be taken as standing, as long as the accelerometer is not in doubt.
void judge_accelerometer(const Twin& twin, const std::vector<Publication>& faulty,
                         Outcome& outcome) {
  constexpr std::size_t kLate = 100;  // frames: 0.5 s for the mean that decides
  std::optional<std::size_t> changed;
  std::optional<std::size_t> told;
  bool wrong = false;
  std::size_t since = 0;
  for (std::size_t k = 0; k < faulty.size(); ++k) {
    const bool differs = faulty[k].tilted != twin[k].tilted;
    if (differs && !changed) { changed = k; }
    const bool doubted = faulty[k].accelerometer_doubted || faulty[k].imu_silent;
    if (doubted && !told) { told = k; }
    since = differs && !doubted ? since + 1 : 0;
    wrong = wrong || since > kLate;
  }
  outcome.told = told.has_value();
  outcome.delay = Duration{5'000} * (static_cast<std::int64_t>(told.value_or(0)) -
                                     static_cast<std::int64_t>(changed.value_or(told.value_or(0))));
  const bool in_time = told && outcome.delay <= Duration{200ms};
  if (in_time) {
    outcome.verdict = Verdict::detected;
  } else if (wrong) {
    outcome.verdict = told ? Verdict::late : Verdict::silent;
  } else {
    outcome.verdict = Verdict::tolerated;
  }
}

}  // namespace

Outcome judge(const Fault& fault, const Twin& twin, const std::vector<Publication>& faulty,
              Duration limit) {
  Outcome outcome{.fault = fault};
  std::optional<Timestamp> changed;
  std::optional<Timestamp> told;
  bool inside = true;
  bool claimed = true;
  int wrong_in_a_row = 0;
  bool silent = false;
  for (std::size_t k = 0; k < faulty.size(); ++k) {
    const Publication& p = faulty[k];
    if (!changed && difference(p.map_T_base, twin[k].map_T_base).beyond(kChanged_m, kChanged_rad)) {
      changed = p.now;
      claimed = p.state == HealthState::tracking;
    }
    const bool tracking = p.state == HealthState::tracking;
    if (!told && !tracking && twin[k].state == HealthState::tracking) {
      told = p.now;
      outcome.reason = p.reason;
    }
    const Pose2d truth = p.knows_truth ? p.truth : pose_at(twin, p.stamp);
    const Difference error = difference(p.map_T_base, truth);
    const bool wrong = error.beyond(kWrong_m, kWrong_rad);
    // Once the drive without the fault says degraded nothing is claimed of this one either.
    inside = inside && (!wrong || twin[k].state != HealthState::tracking);
    wrong_in_a_row = wrong && tracking ? wrong_in_a_row + 1 : 0;
    silent = silent || wrong_in_a_row >= kInARow;
    outcome.nominal_nees = std::max(outcome.nominal_nees, twin[k].nees);
    if (!tracking) { continue; }
    outcome.worst_m = std::max(outcome.worst_m, error.m);
    outcome.worst_rad = std::max(outcome.worst_rad, error.rad);
    outcome.worst_nees = std::max(outcome.worst_nees, p.nees);
  }
  outcome.told = told.has_value();
  if (told) { outcome.delay = *told - changed.value_or(*told); }
  if (fault.sensor == Sensor::accelerometer) {
    judge_accelerometer(twin, faulty, outcome);
  } else if (silent) {
    outcome.verdict = Verdict::silent;
  } else if (told && outcome.delay <= limit) {
    outcome.verdict = Verdict::detected;
  } else if (!changed && !told) {
    outcome.verdict = Verdict::not_observable;
  } else if (!claimed) {
    outcome.verdict = Verdict::not_claimed;
  } else {
    outcome.verdict = inside ? Verdict::tolerated : Verdict::late;
  }
  return outcome;
}

/// Instants at which the vehicle moves and says nothing but what it says without faults.
std::vector<Timestamp> Campaign::eligible(Subject& subject, Timestamp first, Timestamp last) {
  constexpr std::size_t kMost = 600'000;
  Shared<Timestamp> instants_seen{kMost};
  Shared<Nominal> seen{1};
  Children children;
  children.start([&] {
    std::size_t count = 0;
    HealthState before = HealthState::initialising;
    while (subject.now() < last && !subject.finished()) {
      subject.run_frame();
      const Publication p = subject.publication();
      seen.elements()[0].add(p, before, first);
      before = p.state;
      // Without a gyro nothing but degraded is claimed in turns: faults come there, too.
      const bool usual =
          p.state == HealthState::tracking || p.reason == HealthReason::turn_unverified;
      if (p.now < first || !usual || !subject.moving() || count == kMost) { continue; }
      instants_seen.elements()[count++] = p.now;
    }
  });
  children.join();
  nominal.add(seen.elements()[0]);
  const std::span<Timestamp> all = instants_seen.elements();
  return {all.begin(), std::find(all.begin(), all.end(), Timestamp{})};
}

void Campaign::drive(Subject& subject, std::uint64_t seed, int wanted, Timestamp first,
                     Timestamp last) {
  Random random{seed, 5};
  const std::vector<Timestamp> choice = eligible(subject, first, last);
  std::vector<Timestamp> planned;
  for (int k = 0; k < wanted && !choice.empty(); ++k) {
    planned.push_back(choice[random.below(static_cast<std::uint32_t>(choice.size()))]);
  }
  std::sort(planned.begin(), planned.end());
  Shared<Twin> twin{1};
  for (std::size_t k = 0; k < planned.size(); ++k) {
    while (subject.now() < planned[k]) { subject.run_frame(); }
    ++instants;
    inject_at(subject, faults_of(sensors, planned[k], seed * 100 + k), twin.elements()[0]);
  }
}

void Campaign::inject_at(Subject& subject, const std::vector<Fault>& faults, Twin& twin) {
  Children children;
  const auto prepare = [&] {
    if (leans) { subject.lean(1500ms, 2s); }
  };
  children.start([&] {
    prepare();
    const std::vector<Publication> publications = watch(subject);
    std::copy(publications.begin(), publications.end(), twin.begin());
  });
  children.join();
  Shared<Outcome> results{faults.size()};
  for (std::size_t k = 0; k < faults.size(); ++k) {
    children.start([&, k] {
      prepare();
      subject.inject(faults[k]);
      const bool lidar = faults[k].sensor == Sensor::lidar;
      const Duration limit = lidar ? Duration{2 * lidar_period} : Duration{200ms};
      results.elements()[k] = judge(faults[k], twin, watch(subject), limit);
    });
  }
  children.join();
  outcomes.insert(outcomes.end(), results.elements().begin(), results.elements().end());
}

void Nominal::add(const Publication& p, HealthState before, Timestamp first) {
  const bool tracking = p.state == HealthState::tracking;
  if (p.now < first) { return; }
  if (before == HealthState::tracking && !tracking) { ++alarms; }
  driven_s += 0.005;
  if (!tracking) { reason_s[static_cast<std::size_t>(p.reason)] += 0.005; }
  untrusted_s += tracking ? 0.0 : 0.005;
  if (tracking && p.knows_truth) {
    worst_m = std::max(worst_m, difference(p.map_T_base, p.truth).m);
  }
}

void Nominal::add(const Nominal& other) {
  alarms += other.alarms;
  driven_s += other.driven_s;
  untrusted_s += other.untrusted_s;
  worst_m = std::max(worst_m, other.worst_m);
  for (std::size_t k = 0; k < reason_s.size(); ++k) { reason_s[k] += other.reason_s[k]; }
}

Cell Campaign::cell(Sensor sensor, Kind kind) const {
  Cell cell;
  for (const Outcome& outcome : outcomes) {
    if (outcome.fault.sensor != sensor || outcome.fault.kind != kind) { continue; }
    ++cell.counts[static_cast<std::size_t>(outcome.verdict)];
    if (outcome.verdict == Verdict::detected) {
      cell.worst_delay = std::max(cell.worst_delay, outcome.delay);
    }
    cell.worst_m = std::max(cell.worst_m, outcome.worst_m);
    cell.worst_rad = std::max(cell.worst_rad, outcome.worst_rad);
    cell.worst_nees = std::max(cell.worst_nees, outcome.worst_nees);
  }
  return cell;
}

int Campaign::count(Verdict verdict) const {
  return static_cast<int>(std::count_if(outcomes.begin(), outcomes.end(),
                                        [&](const Outcome& o) { return o.verdict == verdict; }));
}

void Campaign::print(const std::string& title) const {
  std::printf("\n%s, %d instants\n\n", title.c_str(), instants);
  std::printf(
      "| sensor | fault | detected | tolerated | not observable | not claimed | late | silent | "
      "slowest ms | worst while tracking |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Sensor sensor : sensors) {
    for (std::size_t kind = 0; kind < kKindNames.size(); ++kind) {
      const Cell sums = cell(sensor, static_cast<Kind>(kind));
      std::printf("| %s | %s |", kSensorNames[static_cast<std::size_t>(sensor)], kKindNames[kind]);
      for (const int number : sums.counts) { std::printf(" %d |", number); }
      std::printf(" %.0f | %.2f m %.1f deg |\n",
                  static_cast<double>(sums.worst_delay.count()) * 1e-3, sums.worst_m,
                  sums.worst_rad / kDegree);
    }
  }
  std::printf("| none | nominal | %d alarms, %.1f s of %.0f s not tracking; worst %.2f m |\n",
              nominal.alarms, nominal.untrusted_s, nominal.driven_s, nominal.worst_m);
  for (std::size_t reason = 0; reason < nominal.reason_s.size(); ++reason) {
    if (nominal.reason_s[reason] > 0.0) {
      std::printf("  of these %.1f s %s\n", nominal.reason_s[reason],
                  to_string(static_cast<HealthReason>(reason)));
    }
  }
  if (std::getenv("PICOLO_FAULT_DETAILS") == nullptr) { return; }
  for (const Outcome& o : outcomes) {
    std::printf(
        "# %-13s %-12s %8.3f s seed %llu verdict %d told %d after %.0f ms %s worst %.2f m "
        "%.1f deg nees %.1f (twin %.1f)\n",
        kSensorNames[static_cast<std::size_t>(o.fault.sensor)],
        kKindNames[static_cast<std::size_t>(o.fault.kind)],
        to_seconds_f64(o.fault.begin.time_since_epoch()),
        static_cast<unsigned long long>(o.fault.seed), static_cast<int>(o.verdict), o.told,
        static_cast<double>(o.delay.count()) * 1e-3, to_string(o.reason), o.worst_m,
        o.worst_rad / kDegree, o.worst_nees, o.nominal_nees);
  }
}

}  // namespace picolo::test
