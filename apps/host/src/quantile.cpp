// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace picolo::host {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) { return 0.0; }
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto index = static_cast<std::ptrdiff_t>(
      std::clamp(rank - 1.0, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

}  // namespace picolo::host
