// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an application listens to, brought down to the filters that the controller has.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/status.hpp"
#include "picolo/hal/can_filter.hpp"

namespace picolo::inline v0::zcu102 {

inline constexpr std::size_t kHardwareFilters = 4;
using HardwareFilters = FixedVector<CanFilter, kHardwareFilters>;

/// The narrowest filter that accepts all that `a` and `b` accept. Precondition: a.extended ==
/// b.extended.
[[nodiscard]] CanFilter covering(const CanFilter& a, const CanFilter& b);

/// At most four filters that accept whatever one of `wanted` accepts, and as little else as pairing
/// the nearest ones gives. `out_of_range`: more than 32 wanted. Cost: O(wanted^3), at start-up.
[[nodiscard]] Status merge_filters(std::span<const CanFilter> wanted, HardwareFilters& merged);

}  // namespace picolo::inline v0::zcu102
