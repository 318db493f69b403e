// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The version of the library as constants; the numbers stand in version.h, which C reads as well.
#pragma once

#include "picolo/core/version.h"

namespace picolo::inline v0 {

inline constexpr int kVersionMajor = PICOLO_VERSION_MAJOR;
inline constexpr int kVersionMinor = PICOLO_VERSION_MINOR;
inline constexpr int kVersionPatch = PICOLO_VERSION_PATCH;

}  // namespace picolo::inline v0
