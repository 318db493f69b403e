// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A map to localise in, from a YAML file of map_server or from a byte store.
#pragma once

#include <filesystem>
#include <optional>

#include "picolo/geometry/pose2.hpp"
#include "picolo/host/map_file.hpp"
#include "picolo/map/rolling_map.hpp"

namespace picolo::tool {

class GivenMap {
 public:
  /// By content: a byte store as `save_map` writes it, otherwise YAML and PGM. Throws UserError
  /// (input).
  explicit GivenMap(const std::filesystem::path& path);

  /// Restores the map into the window, centred; the field is not computed. Returns map_T_grid: the
  /// given map's frame in which the library's cells stand at whole multiples of their size, less
  /// than half a cell from it. Throws UserError (refused) when it does not fit: `profile` is for
  /// the message.
  [[nodiscard]] Pose2d restore(RollingMapCore& map, const char* profile) const;

 private:
  [[nodiscard]] Pose2d restore_image(RollingMapCore& map, const char* profile) const;
  [[nodiscard]] Pose2d restore_store(RollingMapCore& map, const char* profile) const;

  std::filesystem::path path_;
  std::optional<host::OccupancyImage> image_;  // none: a byte store
};

/// The map as a byte store in a file of its own, replaced as a whole. Throws UserError (usage,
/// device).
void save_map(const RollingMapCore& map, const std::filesystem::path& path);

}  // namespace picolo::tool
