// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The CAN protocol's table as others want it: a DBC file for tools, tables for people.
#pragma once

#include <cstdint>
#include <string>

namespace picolo::host {

/// docs/picolo.dbc for base identifier 0x110.
[[nodiscard]] std::string can_dbc(std::uint16_t base_id);
/// The tables of docs/can_protocol.md, Markdown.
[[nodiscard]] std::string can_tables(std::uint16_t base_id);

}  // namespace picolo::host
