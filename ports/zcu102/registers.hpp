// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace picolo::inline v0::zcu102 {

inline volatile std::uint32_t& reg(std::uintptr_t base, std::uintptr_t offset) {
  return *reinterpret_cast<volatile std::uint32_t*>(base + offset);
}

}  // namespace picolo::inline v0::zcu102
