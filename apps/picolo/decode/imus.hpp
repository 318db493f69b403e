// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Raw bytes of imus to lines of samples.
#pragma once

#include "decode/protocols.hpp"

namespace picolo::tool {

[[nodiscard]] DecodeResult decode_witmotion(std::span<const std::uint8_t> bytes,
                                            const DecodeOptions& options);
[[nodiscard]] DecodeResult decode_bno08x(std::span<const std::uint8_t> bytes,
                                         const DecodeOptions& options);
[[nodiscard]] DecodeResult decode_xsens(std::span<const std::uint8_t> bytes,
                                        const DecodeOptions& options);
[[nodiscard]] DecodeResult decode_vectornav(std::span<const std::uint8_t> bytes,
                                            const DecodeOptions& options);

}  // namespace picolo::tool
