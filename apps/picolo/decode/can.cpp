// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <istream>
#include <map>
#include <string>

#include "decode/protocols.hpp"
#include "decode/table.hpp"
#include "picolo/devices/candump.hpp"
#include "picolo/devices/dbc_file.hpp"
#include "picolo/drivers/canopen/messages.hpp"
#include "picolo/drivers/canopen/pdo_mapping.hpp"
#include "picolo/drivers/canopen/sdo_client.hpp"
#include "picolo/drivers/common/wire_float.hpp"
#include "picolo/drivers/odrive/odrive_messages.hpp"
#include "picolo/drivers/vesc/vesc_messages.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

/// All CAN protocols print the same columns, one line a value.
class CanTable {
 public:
  explicit CanTable(TableFormat format)
      : table_({"stamp_s", "id", "node", "message", "signal", "value"}, format) {}

  void row(const CanFrame& frame, unsigned node, const std::string& message,
           const std::string& signal, const host::Json& value) {
    const double stamp_s = to_seconds_f64(frame.stamp.time_since_epoch());
    table_.row({stamp_s,
                frame.extended ? fmt::format("{:08X}", frame.id) : fmt::format("{:03X}", frame.id),
                node, message, signal, value});
  }
  [[nodiscard]] std::size_t rows() const { return table_.rows(); }

 private:
  SampleTable table_;
};

ByteView data_of(const CanFrame& frame) {
  return ByteView{frame.data}.first(frame.length);
}

template <typename Decoder>
DecodeResult decode_log(std::istream& log, const DecodeOptions& options, Decoder&& decode) {
  CanTable table{options.format};
  DecodeResult result;
  for (std::string line; std::getline(log, line);) {
    const std::optional<CanFrame> frame = devices::parse_candump(line);
    if (!frame) {
      if (line.find_first_not_of(" \t\r") != std::string::npos) { ++result.bad_lines; }
      continue;
    }
    ++result.frames;
    if (!frame->remote) { decode(*frame, table); }
  }
  result.samples = table.rows();
  return result;
}

host::Json float_value(std::uint32_t bits) {
  const Result<float> value = float_from_bits(bits);
  if (!value) { return nullptr; }
  return host::Json::parse(fmt::format("{}", *value + 0.0F), nullptr, false);
}

// ---- CANopen --------------------------------------------------------------------------------

const char* name_of(canopen::NmtState state) {
  switch (state) {
    case canopen::NmtState::boot_up: return "boot_up";
    case canopen::NmtState::stopped: return "stopped";
    case canopen::NmtState::operational: return "operational";
    case canopen::NmtState::pre_operational: return "pre_operational";
  }
  return "unknown";
}

const char* name_of_command(unsigned command) {
  switch (command) {
    case 0x01: return "start";
    case 0x02: return "stop";
    case 0x80: return "enter_pre_operational";
    case 0x81: return "reset_node";
    case 0x82: return "reset_communication";
    default: return "unknown";
  }
}

std::string object_name(unsigned index, unsigned subindex) {
  return fmt::format("{:04X}:{:02X}", index, subindex);
}

/// Learns from the service data on the bus which objects a TPDO carries.
class CanopenListener {
 public:
  void operator()(const CanFrame& frame, CanTable& table) {
    if (frame.extended) { return; }
    const unsigned node = frame.id & 0x7FU;
    const ByteView data = data_of(frame);
    switch (frame.id & 0x780U) {
      case 0x000:
        if (node == 0 && data.size() >= 2) {
          table.row(frame, data[1], "nmt", "command", name_of_command(data[0]));
        }
        return;
      case 0x080:
        if (node == 0) {
          table.row(frame, 0, "sync", "counter", data.empty() ? host::Json{} : host::Json(data[0]));
        } else {
          emergency(frame, node, table);
        }
        return;
      case 0x600: request(frame, node, table); return;
      case 0x580: answer(frame, node, table); return;
      case 0x700: heartbeat(frame, node, table); return;
      case 0x180:
      case 0x280:
      case 0x380:
      case 0x480: process_data(frame, node, static_cast<int>(frame.id >> 8U), table); return;
      default: table.row(frame, node, "rpdo", "data", hex(data)); return;
    }
  }

 private:
  static std::string hex(ByteView data) {
    std::string text;
    for (const std::uint8_t byte : data) { text += fmt::format("{:02X}", byte); }
    return text;
  }

  static void heartbeat(const CanFrame& frame, unsigned node, CanTable& table) {
    const auto state = canopen::decode_heartbeat(data_of(frame));
    table.row(frame, node, "heartbeat", "state", state ? name_of(*state) : "unknown");
  }

  static void emergency(const CanFrame& frame, unsigned node, CanTable& table) {
    const auto emergency = canopen::decode_emergency(data_of(frame));
    if (!emergency) { return; }
    table.row(frame, node, "emergency", "code", emergency->code);
    table.row(frame, node, "emergency", "register", emergency->error_register);
    table.row(frame, node, "emergency", "vendor", hex(emergency->vendor));
  }

  void request(const CanFrame& frame, unsigned node, CanTable& table) {
    const ByteView data = data_of(frame);
    if (data.size() < 4) { return; }
    const unsigned index = load_u16_le(data, 1);
    const unsigned subindex = data[3];
    if (data[0] == 0x40) {
      table.row(frame, node, "sdo_read", object_name(index, subindex), nullptr);
      return;
    }
    if ((data[0] & 0xE3U) == 0x23U && data.size() >= 8) {
      const unsigned size = 4U - ((data[0] >> 2U) & 3U);
      const std::uint32_t mask = size == 4 ? 0xFFFFFFFFU : (1U << (8U * size)) - 1U;
      const std::uint32_t value = load_u32_le(data, 4) & mask;
      table.row(frame, node, "sdo_write", object_name(index, subindex), value);
      learn(node, index, subindex, value);
      return;
    }
    table.row(frame, node, "sdo_request", "data", hex(data));
  }

  static void answer(const CanFrame& frame, unsigned node, CanTable& table) {
    const auto answer = canopen::decode_sdo_answer(data_of(frame));
    if (!answer) {
      table.row(frame, node, "sdo_segment", "data", hex(data_of(frame)));
      return;
    }
    const std::string object = object_name(answer->index, answer->subindex);
    switch (answer->kind) {
      case canopen::SdoAnswer::Kind::value:
        table.row(frame, node, "sdo_value", object, answer->value);
        break;
      case canopen::SdoAnswer::Kind::written:
        table.row(frame, node, "sdo_written", object, nullptr);
        break;
      case canopen::SdoAnswer::Kind::segmented:
        table.row(frame, node, "sdo_segmented", object, answer->value);
        break;
      case canopen::SdoAnswer::Kind::aborted:
        table.row(frame, node, "sdo_abort", object, fmt::format("{:08X}", answer->value));
        break;
    }
  }

  void learn(unsigned node, unsigned index, unsigned subindex, std::uint32_t value) {
    if (index >= 0x1800 && index <= 0x1803 && subindex == 1 && (value >> 31U) == 0) {
      pdo_by_id_[value & 0x7FFU] = {node, index - 0x1800};
    }
    if (index < 0x1A00 || index > 0x1A03) { return; }
    canopen::PdoMapping& mapping = mappings_[{node, index - 0x1A00}];
    if (subindex == 0 && value == 0) { mapping = {}; }
    if (subindex >= 1 && subindex <= mapping.size()) {
      mapping.at(subindex - 1) = canopen::mapped_object(value);
    }
  }

  void process_data(const CanFrame& frame, unsigned node, int number, CanTable& table) {
    const auto by_id = pdo_by_id_.find(frame.id);
    const auto key = by_id != pdo_by_id_.end() ? by_id->second
                                               : std::pair{node, static_cast<unsigned>(number - 1)};
    const auto mapping = mappings_.find(key);
    const std::string message = fmt::format("tpdo{}", key.second + 1);
    const ByteView data = data_of(frame);
    if (mapping == mappings_.end() || canopen::total_bytes(mapping->second) > data.size() ||
        canopen::total_bits(mapping->second) == 0) {
      table.row(frame, key.first, message, "data", hex(data));
      return;
    }
    for (const canopen::MappedObject& object : mapping->second) {
      const auto field = canopen::find_field(mapping->second, object.index, object.subindex);
      if (object.bits == 0 || !field) { break; }
      table.row(frame, key.first, message, object_name(object.index, object.subindex),
                canopen::extract_signed(data, *field));
    }
  }

  std::map<std::pair<unsigned, unsigned>, canopen::PdoMapping> mappings_;
  std::map<std::uint32_t, std::pair<unsigned, unsigned>> pdo_by_id_;
};

// ---- ODrive and VESC ------------------------------------------------------------------------

void odrive_floats(const CanFrame& frame, unsigned node, const char* message, const char* first,
                   const char* second, CanTable& table) {
  const auto floats = decode_odrive_floats(data_of(frame));
  if (!floats) { return; }
  table.row(frame, node, message, first, float_value(floats->first_bits));
  table.row(frame, node, message, second, float_value(floats->second_bits));
}

void odrive_frame(const CanFrame& frame, CanTable& table) {
  if (frame.extended) { return; }
  const unsigned node = frame.id >> 5U;
  switch (static_cast<OdriveCommand>(frame.id & 0x1FU)) {
    case OdriveCommand::heartbeat: {
      const auto beat = decode_odrive_heartbeat(data_of(frame), OdriveFirmware::from_0_5_4);
      if (!beat) { return; }
      table.row(frame, node, "heartbeat", "axis_error", beat->axis_error);
      table.row(frame, node, "heartbeat", "axis_state", beat->axis_state);
      table.row(frame, node, "heartbeat", "motor_error", beat->motor_error ? 1 : 0);
      table.row(frame, node, "heartbeat", "encoder_error", beat->encoder_error ? 1 : 0);
      table.row(frame, node, "heartbeat", "controller_error", beat->controller_error ? 1 : 0);
      table.row(frame, node, "heartbeat", "trajectory_done", beat->trajectory_done ? 1 : 0);
      return;
    }
    case OdriveCommand::encoder_estimates:
      return odrive_floats(frame, node, "encoder_estimates", "position_rev", "velocity_revps",
                           table);
    case OdriveCommand::iq:
      return odrive_floats(frame, node, "iq", "setpoint_a", "measured_a", table);
    case OdriveCommand::bus:
      return odrive_floats(frame, node, "bus", "voltage_v", "current_a", table);
    case OdriveCommand::encoder_count: {
      const auto counts = decode_odrive_counts(data_of(frame));
      if (!counts) { return; }
      table.row(frame, node, "encoder_count", "shadow_count", counts->shadow_count);
      table.row(frame, node, "encoder_count", "count_in_cpr", counts->count_in_cpr);
      return;
    }
    case OdriveCommand::motor_error:
    case OdriveCommand::encoder_error:
    case OdriveCommand::controller_error:
      if (frame.length < 4) { return; }
      table.row(frame, node, "error", fmt::format("command_{:02X}", frame.id & 0x1FU),
                load_u32_le(frame.data, 0));
      return;
  }
}

void vesc_frame(const CanFrame& frame, CanTable& table) {
  if (!frame.extended) { return; }
  const unsigned node = frame.id & 0xFFU;
  const ByteView data = data_of(frame);
  const auto command = static_cast<VescCommand>(frame.id >> 8U);
  if ((frame.id >> 8U) > 0xFFU) { return; }
  switch (command) {
    case VescCommand::set_current:
      if (data.size() < 4) { return; }
      table.row(frame, node, "set_current", "current_a", load_i32_be(data, 0) / 1000.0);
      return;
    case VescCommand::status:
      if (const auto status = decode_vesc_status(data)) {
        table.row(frame, node, "status", "erpm", status->erpm);
        table.row(frame, node, "status", "current_a", status->current_da / 10.0);
        table.row(frame, node, "status", "duty", status->duty_permille / 1000.0);
      }
      return;
    case VescCommand::status_2:
    case VescCommand::status_3:
      if (const auto totals = decode_vesc_totals(data)) {
        const bool charge = command == VescCommand::status_2;
        const char* name = charge ? "status_2" : "status_3";
        table.row(frame, node, name, charge ? "used_ah" : "used_wh", totals->used / 1e4);
        table.row(frame, node, name, charge ? "charged_ah" : "charged_wh", totals->charged / 1e4);
      }
      return;
    case VescCommand::status_4:
      if (const auto status = decode_vesc_status_4(data)) {
        table.row(frame, node, "status_4", "transistor_degc", status->transistor_ddegc / 10.0);
        table.row(frame, node, "status_4", "motor_degc", status->motor_ddegc / 10.0);
        table.row(frame, node, "status_4", "input_a", status->input_da / 10.0);
        table.row(frame, node, "status_4", "position_deg", status->position_fiftieth_deg / 50.0);
      }
      return;
    case VescCommand::status_5:
      if (const auto status = decode_vesc_status_5(data)) {
        table.row(frame, node, "status_5", "tachometer", status->tachometer);
        table.row(frame, node, "status_5", "input_v", status->input_dv / 10.0);
      }
      return;
    case VescCommand::status_6:
      if (const auto status = decode_vesc_status_6(data)) {
        for (std::size_t i = 0; i < 3; ++i) {
          table.row(frame, node, "status_6", fmt::format("adc{}_v", i + 1),
                    status->adc_mv[i] / 1000.0);
        }
        table.row(frame, node, "status_6", "ppm", status->ppm_permille / 1000.0);
      }
      return;
  }
}

}  // namespace

const std::vector<CanDecoder>& can_decoders() {
  static const std::vector<CanDecoder> kDecoders{
      {"canopen",
       [](std::istream& log, const DecodeOptions& options) {
         return decode_log(log, options, CanopenListener{});
       }},
      {"odrive",
       [](std::istream& log, const DecodeOptions& options) {
         return decode_log(log, options, odrive_frame);
       }},
      {"vesc", [](std::istream& log, const DecodeOptions& options) {
         return decode_log(log, options, vesc_frame);
       }}};
  return kDecoders;
}

DecodeResult decode_dbc(const std::string& dbc_file, std::istream& log,
                        const DecodeOptions& options) {
  devices::DbcFile file;
  try {
    file = devices::read_dbc(dbc_file);
  } catch (const std::invalid_argument& error) {
    throw host::UserError{host::ExitCode::input, dbc_file, error.what(), "write dbc:FILE"};
  }
  for (const std::string& problem : file.problems) { fmt::print(stderr, "picolo: {}\n", problem); }
  return decode_log(log, options, [&file](const CanFrame& frame, CanTable& table) {
    const devices::DbcFileMessage* message = file.find(frame.id, frame.extended);
    if (message == nullptr) { return; }
    for (const devices::DbcFileSignal& signal : message->signals) {
      const Result<double> value = devices::dbc_value(*message, signal, data_of(frame));
      if (value) { table.row(frame, 0, message->name, signal.name, *value); }
    }
  });
}

}  // namespace picolo::tool
