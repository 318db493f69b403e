// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The library's map as a picture of free, occupied and unknown.
#pragma once

#include <cstdint>

#include "picolo/host/map_file.hpp"
#include "picolo/map/rolling_map.hpp"

namespace picolo::host {

/// Occupied from the map's own threshold on, free below 0.
[[nodiscard]] MapCell cell_of(std::int8_t log_odds, const MapConfig& config);

/// The whole window, in the map frame.
[[nodiscard]] OccupancyImage image_of(const RollingMapCore& map);

}  // namespace picolo::host
