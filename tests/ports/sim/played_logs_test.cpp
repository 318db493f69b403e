// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Recorded logs through frames and packets: nothing of them is lost or bent on the wire.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "picolo/host/carmen.hpp"
#include "support/data.hpp"
#include "wire_firmware.hpp"

namespace picolo::sim {
namespace {

struct Recording {
  std::vector<std::vector<RecordedBeam>> beams;
  std::vector<LogStep> steps;
};

Recording read(const std::string& name, std::size_t max_scans) {
  host::Diagnostics diagnostics;
  host::LineReader reader{test::data_path(name).string()};
  const host::CarmenLog log = host::read_carmen(reader, diagnostics);
  Recording recording;
  for (const host::LogScan& scan : log.scans) {
    if (recording.beams.size() == max_scans) { break; }
    std::vector<RecordedBeam> beams;
    for (std::size_t k = 0; k < scan.ranges_m.size(); ++k) {
      beams.push_back({scan.ranges_m[k], scan.bearings_rad[k]});
    }
    recording.beams.push_back(std::move(beams));
    recording.steps.push_back({.odom_T_base = scan.odom_T_base});
  }
  for (std::size_t i = 0; i < recording.steps.size(); ++i) {
    recording.steps[i].beams = recording.beams[i];
  }
  return recording;
}

struct Named {
  const char* file;
  std::size_t scans;
};

class PlayedLogs : public ::testing::TestWithParam<Named> {};

TEST_P(PlayedLogs, ArriveBeamByBeamAndPoseByPose) {
  PICOLO_NEED_DATA(GetParam().file);
  const Recording recording = read(GetParam().file, GetParam().scans);
  ASSERT_EQ(recording.steps.size(), GetParam().scans);
  const PlayedLog played = play({}, recording.steps);
  expect_played(played, recording.steps);
  RecordProperty("virtual_seconds", std::to_string(played.duration / 1s));
}

INSTANTIATE_TEST_SUITE_P(All, PlayedLogs,
                         ::testing::Values(Named{"radish/freiburg-101.clf.gz", 292},
                                           Named{"radish/freiburg-079.clf.gz", 150},
                                           Named{"radish/intel.clf.gz", 60},
                                           Named{"radish/csail.clf.gz", 60},
                                           Named{"raw2d/mines_exp1.clf.gz", 40},
                                           Named{"raw2d/malaga_sena_loop.clf.gz", 40},
                                           Named{"raw2d/intel_raw.clf.gz", 60}));

}  // namespace
}  // namespace picolo::sim
