// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recorded folder back through drivers, executive and controller.
#pragma once

#include <string>

#include "drive_result.hpp"
#include "live/drive_journal.hpp"
#include "live/record_folder.hpp"
#include "picolo/host/diagnostics.hpp"

namespace picolo::tool {

struct FolderReplay {
  DriveJournal journal{Timestamp{}};
  DriveResult drive;
  bool has_cycles = false;
  bool has_result = false;      ///< the folder says what the recorded drive gave
  bool same = false;            ///< and this is the same, every cycle and every sent frame
  std::size_t differences = 0;  ///< calls that were answered or asked differently
};

/// `config`: a configuration file instead of the folder's own; empty: that one.
/// Throws UserError (input, usage, refused).
[[nodiscard]] FolderReplay replay_folder(const RecordFolder& folder, const std::string& config,
                                         host::Diagnostics& diagnostics);

}  // namespace picolo::tool
