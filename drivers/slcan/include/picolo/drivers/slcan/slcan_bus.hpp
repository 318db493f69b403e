// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A CAN bus behind an adapter on a serial line: the UART of a board without a CAN controller, or
/// a USB adapter on Linux.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/drivers/common/serial_chunk.hpp"
#include "picolo/drivers/slcan/slcan_line.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0 {

struct SlcanConfig {
  std::uint32_t bit_rate = 500'000;  ///< of the bus; one of those that the protocol names
  [[nodiscard]] constexpr bool valid() const { return command() != 0; }
  /// The digit behind S; 0: there is none.
  [[nodiscard]] constexpr char command() const {
    constexpr std::array<std::uint32_t, 9> kRates{10'000,  20'000,  50'000,  100'000,  125'000,
                                                  250'000, 500'000, 800'000, 1'000'000};
    for (std::size_t i = 0; i < kRates.size(); ++i) {
      if (kRates[i] == bit_rate) { return static_cast<char>('0' + i); }
    }
    return 0;
  }
};

/// Never reset.
struct SlcanCounters {
  std::uint32_t malformed = 0;  ///< lines that are none of the protocol
  std::uint32_t answers = 0;    ///< to commands
  std::uint32_t refused = 0;    ///< commands that the adapter did not accept
  std::uint32_t opened = 0;     ///< how often the adapter was told its rate and to begin
};

/// Tells the adapter its bit rate and to begin, again whenever the line or the adapter has come
/// back. A frame's stamp is when the first bit of its line went onto the serial line: as late as
/// the adapter is. An adapter tells neither error frames nor bus-off; frames that were lost on the
/// serial line (its bytes are missing) are counted in rx_lost. Precondition: config.valid().
/// Cost: `receive` reads at most 256 bytes, `transmit` writes at most 26. Memory: about 250 bytes.
class SlcanBus final : public CanBus {
 public:
  explicit SlcanBus(SerialPort& port, const SlcanConfig& config = {})
      : port_(port), config_(config), port_lost_(port.lost()) {}

  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override { return status_; }
  [[nodiscard]] const SlcanCounters& counters() const { return counters_; }

 private:
  Status send_rest();
  Status flush();
  void queue(ByteView bytes);
  void look_for_lost_bytes();
  void follow(Status status);
  Result<CanFrame> next_in_chunk();
  Result<CanFrame> take_line();

  SerialPort& port_;
  SlcanConfig config_;
  CanStatus status_{};
  SlcanCounters counters_{};
  slcan::LineCutter cutter_{};
  SerialChunk chunk_{};
  std::size_t next_ = 0;       // in chunk_
  std::size_t line_size_ = 0;  // bytes of the line under way
  Timestamp last_stamp_ = Timestamp::min();
  std::uint32_t port_lost_;
  std::uint32_t refusals_in_a_row_ = 0;
  bool open_ = false;
  std::array<std::uint8_t, 32> unsent_{};
  std::size_t unsent_size_ = 0;
};

}  // namespace picolo::inline v0
