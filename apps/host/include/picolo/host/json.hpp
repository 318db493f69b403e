// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// JSON for machines: plain decimals, never exponents, every digit that the double carries.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace picolo::host {

/// Keeps the order in which keys were written.
using Json = nlohmann::ordered_json;

/// One line, no line ending. A number that is not finite becomes null.
[[nodiscard]] std::string to_text(const Json& json);

/// `value` in plain decimals: the shortest digits that read back as the same double.
[[nodiscard]] std::string plain_decimal(double value);

}  // namespace picolo::host
