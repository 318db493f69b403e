// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Order statistics for reports.
#pragma once

#include <vector>

namespace picolo::host {

/// The smallest value that at least `share` of all values do not exceed (nearest rank); 0 when
/// there are none. Example: quantile({1, 2, 3, 4}, 0.5) == 2.
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace picolo::host
