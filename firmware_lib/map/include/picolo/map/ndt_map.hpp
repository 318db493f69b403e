// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Normal distributions of the points that fell into each cell (Biber and Strasser 2003, "The
/// normal distributions transform"), built point by point, in a window that follows the vehicle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/map/grid_window.hpp"

namespace picolo::inline v0 {

/// Four grids, each shifted by half a cell against its neighbours in x, y or both: a point always
/// lies well inside of at least one cell (section III of the paper).
inline constexpr int kNdtGrids = 4;

/// Mean and covariance of one cell; offsets from the cell's lower left corner. 48 bytes.
///
/// Where a wall crosses a cell, the cell's border and not the world ends it: along its long
/// direction a cell pulls towards its mean for no reason. `stiff` is the inverse covariance with
/// the eigenvalue of that direction reduced by the square of the ratio of the eigenvalues: what the
/// cell is worth as information.
struct NdtCell {
  std::uint32_t count = 0;
  float mean_x_m = 0.0F;
  float mean_y_m = 0.0F;
  float xx = 0.0F;  ///< sums of squared deviations from the mean, m^2
  float xy = 0.0F;
  float yy = 0.0F;
  float inverse_xx = 0.0F;  ///< inverse of the regularised covariance, 1/m^2; 0: too few points
  float inverse_xy = 0.0F;
  float inverse_yy = 0.0F;
  float stiff_xx = 0.0F;
  float stiff_xy = 0.0F;
  float stiff_yy = 0.0F;
};

struct NdtMapConfig {
  float cell_m = 0.5F;
  std::uint32_t min_points = 5;        ///< below, a cell says nothing
  std::uint32_t max_points = 500;      ///< from here on old points fade out
  float min_eigenvalue_ratio = 1e-3F;  ///< of the covariance: the paper's guard against singularity
  float min_sigma_m = 0.03F;           ///< no wall is thinner than this
  [[nodiscard]] constexpr bool valid() const {
    return cell_m > 0.0F && min_points >= 3 && max_points > min_points &&
           min_eigenvalue_ratio >= 0.0F && min_sigma_m > 0.0F;
  }
};
static_assert(NdtMapConfig{}.valid());

/// Grid g holds `width` x `height` cells, row-major; its cell (i, j) begins at
/// ((i - (g & 1) / 2) cell_m, (j - (g >> 1) / 2) cell_m) of the window.
struct NdtView {
  std::array<const NdtCell*, kNdtGrids> grids{};
  int width = 0;
  int height = 0;
  float cell_m = 0.5F;
  float cells_per_m = 2.0F;
};

/// Context: cycle only.
class NdtMapCore {
 public:
  /// Precondition: config.valid(), each grid of width * height cells.
  NdtMapCore(const NdtMapConfig& config, int width, int height,
             const std::array<std::span<NdtCell>, kNdtGrids>& grids);

  void reset(double centre_x_m, double centre_y_m);
  /// Moves the window by whole cells when the point is further from its centre than a quarter of
  /// its size; what leaves is lost. True when it moved. Cost: O(1), or one copy of the grids.
  bool follow(double x_m, double y_m);
  /// Adds a point to the one cell of each grid that it lies in; outside of the window it has no
  /// effect. Cost: about 4 * 80 instructions.
  void add(Point2f window_p);

  [[nodiscard]] const GridWindow& window() const { return window_; }
  [[nodiscard]] NdtView view() const;

 private:
  void add_to(NdtCell& cell, float x_m, float y_m) const;

  NdtMapConfig config_;
  GridWindow window_;
  std::array<std::span<NdtCell>, kNdtGrids> grids_;
};

/// Storage: 192 bytes a cell of `cell_m`; 32 x 32 cells of 0.5 m take 192 KiB.
template <int Width, int Height>
class NdtMap {
 public:
  explicit NdtMap(const NdtMapConfig& config = {})
      : core_(config, Width, Height, {grids_[0], grids_[1], grids_[2], grids_[3]}) {}
  NdtMap(const NdtMap&) = delete;
  NdtMap& operator=(const NdtMap&) = delete;
  ~NdtMap() = default;

  [[nodiscard]] NdtMapCore& core() { return core_; }
  [[nodiscard]] const NdtMapCore& core() const { return core_; }

 private:
  std::array<std::array<NdtCell, static_cast<std::size_t>(Width) * Height>, kNdtGrids> grids_{};
  NdtMapCore core_;
};

}  // namespace picolo::inline v0
