// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The recordings with published answers.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "picolo/calibration/samples.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo::test {

/// third -1: all rows; else those with index modulo 3 = third.
inline std::vector<MotionSample> censi_samples(const std::string& name, int third = -1) {
  std::vector<MotionSample> samples;
  int index = 0;
  for (const std::string& line : gz_lines(data_path("calib/" + name + ".tuples.txt.gz"))) {
    if (line.empty() || line[0] == '#') { continue; }
    const std::vector<double> v = numbers_in(line);
    if (third < 0 || index % 3 == third) {
      samples.push_back({v[0], v[1], v[2], {v[3], v[4], v[5]}});
    }
    ++index;
  }
  return samples;
}

/// axle, l_diam, r_diam, l_x, l_y, l_theta, E_d, E_b, then 36 of the covariance.
inline std::vector<double> censi_expected(const std::string& name) {
  std::ifstream file{data_path("calib/" + name + "_expected.json")};
  std::string text;
  std::getline(file, text);
  std::vector<double> values;
  bool quoted = false;
  std::string plain;
  for (const char c : text) {
    if (c == '"') { quoted = !quoted; }
    plain.push_back(quoted || c == '"' ? ' ' : c);
  }
  return numbers_in(plain);
}

inline std::vector<WheelRates> seed_rates() {
  std::vector<WheelRates> rows;
  for (const std::string& line : gz_lines(data_path("calib/seed_odom.txt.gz"))) {
    const std::vector<double> v = numbers_in(line);
    rows.push_back({v[0], v[1], v[2]});
  }
  return rows;
}

inline std::vector<ScanMotion> seed_scans() {
  std::vector<ScanMotion> rows;
  for (const std::string& line : gz_lines(data_path("calib/seed_scan_match.txt.gz"))) {
    const std::vector<double> v = numbers_in(line);
    rows.push_back({v[0], {v[1], v[2], v[3]}});
  }
  return rows;
}

}  // namespace picolo::test
