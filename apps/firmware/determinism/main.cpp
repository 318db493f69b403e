// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Prints one hash a case: for this processor, this compiler, these options.
//   (nothing)            every drive of the simulation, the 3D sequence, arithmetic
//   drive NAME [START]   one drive; START: microseconds on the clock at its beginning
//   3d                   the 3D sequence
//   arithmetic           + - * / and their kin on random operands
//   log FILE [TITLE]     sweeps that a host wrote (tests/target/platforms/one_hash_test.cpp)

#include <cstring>
#include <new>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/odometry/loam_odometry.hpp"
#include "picolo/simulated/arithmetic.hpp"
#include "picolo/simulated/scans3d.hpp"
#include "picolo/simulated/trajectory_hash.hpp"
#include "platform.hpp"

namespace picolo {

#ifdef PICOLO_HOSTILE
double hostile_eigen(double seed);
#endif

namespace {

/// Memory of one case at a time, for objects that are too big for a stack.
alignas(64) constinit std::byte g_memory[PICOLO_IMAGE_BYTES];

template <typename T>
T& only(auto&&... arguments) {
  static_assert(sizeof(T) <= sizeof g_memory);
  return *new (g_memory) T(static_cast<decltype(arguments)&&>(arguments)...);
}

struct NamedScene {
  const char* name;
  sim::SceneName scene;
};
constexpr NamedScene kScenes[] = {{"office", sim::SceneName::office},
                                  {"corridor", sim::SceneName::corridor},
                                  {"hall", sim::SceneName::hall}};

bool print(const char* group, const char* name, std::uint64_t hash, bool good) {
  platform::write(group);
  platform::write(name);
  platform::write(" ");
  platform::write_hex(hash);
  platform::write(good ? "\n" : " NOT A NUMBER\n");
  return good;
}

bool drive(const NamedScene& named, Timestamp start) {
  auto& robot = only<SimulatedController<RoomProfile>>(hashed_drive(named.scene, start));
  if (robot.start() != Status::ok) { return false; }
  TrajectoryHash poses{start};
  while (robot.controller().next_frame() < start + kHashedDrive) {
    if (robot.run_frame() != Status::ok) { return false; }
    poses.add(robot.controller().estimate());
  }
  const std::uint64_t whole = whole_hash(poses, robot.controller().pipeline().localiser().map());
  return print("sim/", named.name, whole, !poses.poisoned());
}

bool yard() {
  auto& odometry = only<LoamOdometry<>>(LoamConfig{});
  alignas(8) static std::array<RingPoint, kYardAzimuths> points;
  Yard yard{5};
  Hash hash;
  for (std::size_t scan = 0; scan < kYardScans; ++scan) {
    odometry.core().begin_scan();
    for (std::size_t ring = 0; ring < kYardRings; ++ring) {
      yard.measure(scan, ring, points);
      if (odometry.core().add_ring(ring, points) != Status::ok) { return false; }
    }
    while (!odometry.core().step()) {}
    const LoamReport& report = odometry.core().report();
    hash.add(report.map_T_lidar.translation_m.x);
    hash.add(report.map_T_lidar.translation_m.y);
    hash.add(report.map_T_lidar.translation_m.z);
    hash.add(report.map_T_lidar.rotation.w);
    hash.add(report.map_T_lidar.rotation.x);
    hash.add(report.map_T_lidar.rotation.y);
    hash.add(report.map_T_lidar.rotation.z);
    for (const float element : report.covariance) { hash.add(element); }
    hash.add(report.matched_edges);
    hash.add(report.matched_surfaces);
  }
  return print("sim3d/", "yard", hash.value(), !hash.poisoned());
}

/// Little-endian words of a file.
class Words {
 public:
  explicit Words(int file) : file_(file) {}
  [[nodiscard]] bool floats(std::span<float> values) {
    return platform::read_file(file_, {reinterpret_cast<std::uint8_t*>(values.data()),
                                       values.size_bytes()}) == values.size_bytes();
  }
  template <typename T>
  [[nodiscard]] bool one(T& value) {
    std::uint8_t bytes[sizeof(T)];
    if (platform::read_file(file_, bytes) != sizeof(T)) { return false; }
    std::memcpy(&value, bytes, sizeof(T));
    return true;
  }

 private:
  int file_;
};

bool log(const char* path, const char* title) {
  const int file = platform::open_file(path);
  if (file < 0) { return false; }
  auto& localiser = only<Localiser<HallProfile>>();
  static float x_m[HallProfile::kReturns];
  static float y_m[HallProfile::kReturns];
  Words words{file};
  Hash hash;
  Pose2d odom_T_base;
  std::uint32_t count = 0;
  while (words.one(odom_T_base.x_m)) {
    UndistortedSweep sweep;
    if (!words.one(odom_T_base.y_m) || !words.one(odom_T_base.theta_rad) || !words.one(count) ||
        count > HallProfile::kReturns || !words.floats({x_m, count}) ||
        !words.floats({y_m, count})) {
      return false;
    }
    sweep.odom_T_base = odom_T_base;
    sweep.points = {{x_m, count}, {y_m, count}};
    if (localiser.core().process(sweep, true) != Status::ok) { return false; }
    const Pose2d& pose = localiser.core().map_T_base();
    hash.add(pose.x_m);
    hash.add(pose.y_m);
    hash.add(pose.theta_rad);
  }
  add_map(localiser.core().map(), hash);
  return print("", title[0] == '\0' ? path : title, hash.value(), !hash.poisoned());
}

std::int64_t number(const char* text) {
  std::int64_t value = 0;
  for (; *text >= '0' && *text <= '9'; ++text) { value = value * 10 + (*text - '0'); }
  return value;
}

bool run() {
#ifdef PICOLO_HOSTILE
  if (!(hostile_eigen(0.5) > 0.0)) { return false; }
#endif
  char command[16];
  char name[160];
  char last[40];
  platform::argument(0, command);
  platform::argument(1, name);
  platform::argument(2, last);
  const bool everything = command[0] == '\0';
  bool good = true;
  bool known = everything;
  if (everything || std::strcmp(command, "drive") == 0) {
    for (const NamedScene& scene : kScenes) {
      if (!everything && std::strcmp(name, scene.name) != 0) { continue; }
      known = true;
      good = drive(scene, Timestamp{Duration{number(last)}}) && good;
    }
  }
  if (everything || std::strcmp(command, "3d") == 0) {
    known = true;
    good = yard() && good;
  }
  if (everything || std::strcmp(command, "arithmetic") == 0) {
    known = true;
    good = print("arithmetic/", "ieee754", hash_of_arithmetic(), true) && good;
  }
  if (std::strcmp(command, "log") == 0) {
    known = true;
    good = log(name, last) && good;
  }
  if (!known) {
    platform::write(
        "usage: [drive office|corridor|hall [START]] | [3d] | [arithmetic] | "
        "[log FILE [TITLE]]\n");
  }
  return known && good;
}

}  // namespace
}  // namespace picolo

int main() {
  picolo::platform::leave(picolo::run() ? 0 : 1);
}
