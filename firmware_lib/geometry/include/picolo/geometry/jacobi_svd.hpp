// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Singular values by one-sided Jacobi (Hestenes 1958): pairs of columns are rotated until all are
/// orthogonal. Slow, small, no libm, and the most accurate of the three classical ways to least
/// squares.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// A = U S V^T of a rows x columns matrix with rows >= columns, column-major in `a`. Afterwards `a`
/// holds the columns of U S, `v` the columns x columns matrix V (column-major), `singular_values`
/// the diagonal of S, descending (equal ones keep their order). Cost: O(rows * columns^2) a sweep,
/// at most 30 sweeps, usually 5 to 9. Context: any; nothing is allocated. `invalid_argument`: sizes
/// disagree. `degenerate`: not orthogonal to 1e-15 after 30 sweeps (never seen).
Status jacobi_svd(std::span<double> a, std::size_t rows, std::size_t columns, std::span<double> v,
                  std::span<double> singular_values);

}  // namespace picolo::inline v0
