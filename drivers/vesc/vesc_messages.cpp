// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/vesc/vesc_messages.hpp"

namespace picolo::inline v0 {
namespace {

std::int16_t load_i16_be(ByteView data, std::size_t at) {
  return static_cast<std::int16_t>(load_u16_be(data, at));
}

}  // namespace

Result<VescStatus> decode_vesc_status(ByteView data) {
  if (data.size() < 8) { return Status::corrupt; }
  return VescStatus{load_i32_be(data, 0), load_i16_be(data, 4), load_i16_be(data, 6)};
}

Result<VescTotals> decode_vesc_totals(ByteView data) {
  if (data.size() < 8) { return Status::corrupt; }
  return VescTotals{load_i32_be(data, 0), load_i32_be(data, 4)};
}

Result<VescStatus4> decode_vesc_status_4(ByteView data) {
  if (data.size() < 8) { return Status::corrupt; }
  return VescStatus4{load_i16_be(data, 0), load_i16_be(data, 2), load_i16_be(data, 4),
                     load_i16_be(data, 6)};
}

Result<VescStatus5> decode_vesc_status_5(ByteView data) {
  if (data.size() < 6) { return Status::corrupt; }
  return VescStatus5{load_i32_be(data, 0), load_i16_be(data, 4)};
}

Result<VescStatus6> decode_vesc_status_6(ByteView data) {
  if (data.size() < 8) { return Status::corrupt; }
  return VescStatus6{{load_i16_be(data, 0), load_i16_be(data, 2), load_i16_be(data, 4)},
                     load_i16_be(data, 6)};
}

}  // namespace picolo::inline v0
