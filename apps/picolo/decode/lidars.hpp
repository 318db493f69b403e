// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Raw bytes of lidars to lines of samples.
#pragma once

#include "decode/protocols.hpp"

namespace picolo::tool {

[[nodiscard]] DecodeResult decode_ld06(std::span<const std::uint8_t> bytes,
                                       const DecodeOptions& options);
[[nodiscard]] DecodeResult decode_rplidar(std::span<const std::uint8_t> bytes,
                                          const DecodeOptions& options);
[[nodiscard]] DecodeResult decode_scip(std::span<const std::uint8_t> bytes,
                                       const DecodeOptions& options);
[[nodiscard]] DecodeResult decode_ydlidar(std::span<const std::uint8_t> bytes,
                                          const DecodeOptions& options);

}  // namespace picolo::tool
