// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What work costs, and what the executive's tasks may cost at most: bounds come from the declared
/// work of a frame or a sweep times the declared cost of its units, not from what was measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "picolo/controller/controller_config.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::target {

/// Instructions at most. Every sweep of the measured drives is held to them.
struct UnitCosts {
  double can_frame;    ///< with what follows from it
  double command;      ///< carried out: a calibration is reset, a pose set
  double serial_byte;  ///< framed, decoded, assembled
  double calibrated;   ///< what the calibration makes of samples, in each of two tasks
  double cycle;        ///< odometry, publication and health of one frame
  double report;       ///< frames out, once in five frames
  double returned;     ///< of a sweep, undistorted
  double surface;      ///< of a return, found
  double sweep;        ///< once a sweep: prediction, move of the window, books
  double point_iteration;
  double iteration;    ///< beside its points: solve, conditioning
  double agreement;    ///< of a point with what the map holds, told after a poor match
  double covariance;   ///< of a point: in how far walls err together
  double conclusion;   ///< once a match: covariances, correction
  double ray;          ///< and its hit, into both maps
  double cell;         ///< walked by a ray; one that changes costs three more
  double obstacle;     ///< new: paints the field
  double tile;         ///< of the field, computed anew
  double lookup;       ///< of a correlative search
  double plane;        ///< of scores, looked through for maxima
  double node;         ///< of the search of the whole map, all points of it
  double calibration;  ///< a slice of the routine or of its scan match
};

/// Work of one sweep.
struct SweepWork {
  double returns = 0.0;
  double iterations = 0.0;
  double point_iterations = 0.0;
  double cells = 0.0;
  double changed_cells = 0.0;
  double obstacles = 0.0;
  double tiles = 0.0;
};

/// Counts of a localiser so far, of both its maps; differences are work.
inline SweepWork work_so_far(const LocaliserCore& localiser) {
  const MapWork& fine = localiser.map().work();
  const MapWork& coarse = localiser.coarse_map().work();
  const auto sum = [](std::uint32_t a, std::uint32_t b) {
    return static_cast<double>(a) + static_cast<double>(b);
  };
  return {.point_iterations = static_cast<double>(localiser.counters().point_iterations),
          .cells = sum(fine.ray_cells, coarse.ray_cells),
          .changed_cells = sum(fine.changed_cells, coarse.changed_cells),
          .obstacles = sum(fine.new_obstacles, coarse.new_obstacles),
          .tiles = sum(fine.repaired_tiles, coarse.repaired_tiles)};
}

/// Of a sweep of so many points.
inline SweepWork work_between(const SweepWork& before, const SweepWork& after, double points) {
  const double walked = after.point_iterations - before.point_iterations;
  return {.returns = points,
          .iterations = points > 0.0 ? walked / points : 0.0,
          .point_iterations = walked,
          .cells = after.cells - before.cells,
          .changed_cells = after.changed_cells - before.changed_cells,
          .obstacles = after.obstacles - before.obstacles,
          .tiles = after.tiles - before.tiles};
}

/// A poor match is compared with the map by each of the three who may ask for a search, at most.
inline constexpr double kAgreements = 3;

/// The end of a match.
inline double conclusion_of(const UnitCosts& unit, double points) {
  return unit.conclusion + points * (unit.covariance + kAgreements * unit.agreement);
}

/// Instructions of a sweep without a search: undistortion, match, map.
inline double cost_of(const UnitCosts& unit, const SweepWork& work) {
  return unit.sweep + work.returns * (unit.returned + unit.surface + unit.ray) +
         work.iterations * unit.iteration + work.point_iterations * unit.point_iteration +
         conclusion_of(unit, work.returns) + (work.cells + 3.0 * work.changed_cells) * unit.cell +
         work.obstacles * unit.obstacle + work.tiles * unit.tile;
}

inline constexpr UnitCosts kCortexM7{.can_frame = 520,
                                     .command = 10'000,
                                     .serial_byte = 125,
                                     .calibrated = 4'000,
                                     .cycle = 8'000,
                                     .report = 10'500,
                                     .returned = 300,
                                     .surface = 250,
                                     .sweep = 250'000,
                                     .point_iteration = 155,
                                     .iteration = 4'500,
                                     .agreement = 70,
                                     .covariance = 60,
                                     .conclusion = 20'000,
                                     .ray = 500,
                                     .cell = 15.5,
                                     .obstacle = 1'500,
                                     .tile = 26'000,
                                     .lookup = 14,
                                     .plane = 35'000,
                                     .node = 4'000,
                                     .calibration = 680'000};
/// Double precision in software: dear per sweep and per cycle, not per point.
inline constexpr UnitCosts kCortexM4F{.can_frame = 520,
                                      .command = 26'000,
                                      .serial_byte = 135,
                                      .calibrated = 5'000,
                                      .cycle = 70'000,
                                      .report = 21'000,
                                      .returned = 650,
                                      .surface = 250,
                                      .sweep = 253'000,
                                      .point_iteration = 170,
                                      .iteration = 6'000,
                                      .agreement = 80,
                                      .covariance = 60,
                                      .conclusion = 50'000,
                                      .ray = 500,
                                      .cell = 15.5,
                                      .obstacle = 1'500,
                                      .tile = 26'000,
                                      .lookup = 14,
                                      .plane = 35'000,
                                      .node = 4'000,
                                      .calibration = 107'200};

/// What the vehicle of the images can bring at most, and what the library lets through.
inline constexpr double kCanFrames = 5;      ///< of 5 ms: two drives at 100 Hz, a heartbeat
inline constexpr double kSerialBytes = 174;  ///< of 5 ms: 115 at 230400 baud, 58 at 115200, one cut
inline constexpr double kReturns = 450;      ///< a sweep of an LD06 at 10 Hz
inline constexpr double kPainted = 1.4;  ///< obstacles a hit can make: fine and part of a coarse
inline constexpr double kMargin = 1.35;

/// Of a sweep at its worst: every ray 12 m long (150 cells, 38 coarse ones) in a place half of
/// which nobody has seen, each hit a new obstacle, and so many old ones cleared that half of the
/// window's tiles are computed anew.
inline SweepWork worst_sweep(const LocaliserConfig& config) {
  const double iterations = config.fine.max_iterations;
  return {.returns = kReturns,
          .iterations = iterations,
          .point_iterations = kReturns * iterations,
          .cells = kReturns * 188,
          .changed_cells = kReturns * 94,
          .obstacles = kReturns * kPainted,
          .tiles = 128};
}

/// With a search near the prediction and a wide one: the candidates of each are refined, too. The
/// searches themselves are background work, bounded by the frame.
inline SweepWork worst_searched_sweep(const LocaliserConfig& config) {
  SweepWork work = worst_sweep(config);
  work.iterations += 2.0 * config.search.correlative.max_candidates * config.fine.max_iterations;
  work.point_iterations = kReturns * work.iterations;
  return work;
}

/// Budgets by row of the table.
inline std::map<std::string, double> declared_budgets(const UnitCosts& unit,
                                                      const ControllerConfig& config) {
  const WorkBounds& work = config.work;
  const LocaliserConfig& localiser = config.localiser;
  const double iterations = std::max(1.0, std::floor(work.max_point_iterations / kReturns));
  const double match = iterations * (kReturns * unit.point_iteration + unit.iteration) +
                       conclusion_of(unit, kReturns);
  // A frame's map work is either hits, or rays of 128 cells' work each, or tiles.
  const double hits = work.max_rays * (unit.ray / 3.0 + kPainted * unit.obstacle);
  const double rays = work.max_rays * (unit.ray + 1.25 * 128.0 * unit.cell);
  const double tiles = 2.0 * localiser.max_repair_tiles * unit.tile;
  const double slices = work.max_search_slices;
  // The match begins in the frame of the last returns, or in one of its own.
  const double returns = std::min<double>(work.max_returns, kReturns) * unit.returned;
  const double begin = kReturns * unit.surface + unit.sweep;
  const double undistort = work.one_stage_a_frame ? std::max(returns, begin) : returns + begin;
  const double search =
      slices * static_cast<double>(localiser.search.lookups_per_step) * unit.lookup + unit.plane;
  const double anywhere = slices * (localiser.relocalise.nodes_per_step + 3.0) * unit.node;
  const double searches = std::max(search, anywhere);
  // By turns, or both in one frame.
  const double background =
      work.one_stage_a_frame ? std::max(searches, unit.calibration) : searches + unit.calibration;
  return {{"can", kMargin * (kCanFrames * unit.can_frame + unit.command)},
          {"serial", kMargin * (kSerialBytes * unit.serial_byte + unit.calibrated)},
          {"odometry", kMargin * unit.cycle},
          {"report", kMargin * unit.report},
          {"undistort", kMargin * undistort},
          {"match", kMargin * match},
          {"map", kMargin * std::max({hits, rays, tiles})},
          {"search", kMargin * search},
          {"relocalisation", kMargin * anywhere},
          {"background", kMargin * background},
          {"calibration", kMargin * unit.calibration},
          {"scan", cost_of(unit, worst_sweep(localiser))},
          {"scan-with-search", cost_of(unit, worst_searched_sweep(localiser))}};
}

}  // namespace picolo::target
