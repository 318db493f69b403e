// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Least squares through the singular values: the slowest and most accurate of the three classical
/// ways, and the one that shows what the data do not determine.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// Minimum-norm least squares through `jacobi_svd`; destroys `a`. Singular values up to `tolerance`
/// times the largest count as zero. `b`: rows, `x`: columns, `v`: columns^2 of work. Status as
/// above.
Status svd_least_squares(std::span<double> a, std::size_t rows, std::span<const double> b,
                         std::span<double> x, std::span<double> v, double tolerance = 1e-14);

}  // namespace picolo::inline v0
