// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/zcu102/acceptance.hpp"
#include "zcu102_bench.hpp"

namespace picolo {
namespace {

using conformance::Checker;
using zcu102::CanMode;

std::uint32_t drain(CanBus& bus) {
  std::uint32_t frames = 0;
  while (bus.receive()) { ++frames; }
  return frames;
}

/// CAN1 sends one frame of each identifier; how many CAN0 lets pass.
std::uint32_t passing(Zcu102Bench& bench, std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t id = first; id <= last; ++id) {
    static_cast<void>(bench.can1.transmit({.id = id}));
  }
  return drain(bench.can0);
}

void check_filters(Zcu102Bench& bench, Checker& checker) {
  const CanFilter narrow[] = {{.id = 0x180, .mask = 0x7F0}};
  checker.expect(is_ok(bench.can0.open(narrow)) && passing(bench, 0x178, 0x197) == 16,
                 "a filter of 0x180/0x7F0 lets 16 of 32 identifiers pass",
                 "set AFMR and AFIR while their bit of AFR is 0");
  static_cast<void>(bench.can1.transmit({.id = 0x180, .remote = true}));
  static_cast<void>(bench.can1.transmit({.id = 0x180, .extended = true}));
  checker.expect(drain(bench.can0) == 0, "a filter lets data frames of its kind pass only",
                 "compare IDE and RTR, too");
  const CanFilter wide[] = {{.id = 0x1ABC'0000, .mask = 0x1FFF'0000, .extended = true}};
  static_cast<void>(bench.can0.open(wide));
  static_cast<void>(bench.can1.transmit({.id = 0x1ABC'1234, .extended = true}));
  static_cast<void>(bench.can1.transmit({.id = 0x1ABD'1234, .extended = true}));
  const Result<CanFrame> frame = bench.can0.receive();
  checker.expect(frame && frame->id == 0x1ABC'1234 && drain(bench.can0) == 0,
                 "filters know 29-bit identifiers", "split them at bit 18");

  // What a controller with two CANopen nodes listens to: SYNC, emergencies, TPDOs, heartbeats.
  const CanFilter nodes[] = {{.id = 0x080}, {.id = 0x081}, {.id = 0x082}, {.id = 0x181},
                             {.id = 0x182}, {.id = 0x701}, {.id = 0x702}};
  zcu102::HardwareFilters merged;
  const bool fits = is_ok(zcu102::merge_filters(nodes, merged));
  bool wanted_pass = fits && is_ok(bench.can0.open(nodes));
  for (const CanFilter& filter : nodes) {
    wanted_pass = wanted_pass && passing(bench, filter.id, filter.id) == 1;
  }
  checker.expect(wanted_pass, "more filters than the controller has are merged, and none is lost",
                 "the covering mask has the bits in which all agree");
  checker.expect(passing(bench, 0x000, 0x7FF) <= 16, "merged filters still keep the others out",
                 "merge those first that differ in the fewest bits");
  const CanFilter many[33] = {};
  checker.expect(bench.can0.open(many) == Status::out_of_range, "33 filters are refused",
                 "see merge_filters");
  static_cast<void>(bench.can0.open());
}

void check_overflow(Zcu102Bench& bench, Checker& checker) {
  const std::uint32_t lost = bench.can0.status().rx_lost;
  bench.interrupts.disable(zcu102::kCan0Interrupt);
  for (std::uint32_t i = 0; i < 80; ++i) { static_cast<void>(bench.can1.transmit({.id = i})); }
  bench.interrupts.enable(zcu102::kCan0Interrupt);
  bench.wait(1ms);
  bool oldest = true;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const Result<CanFrame> frame = bench.can0.receive();
    oldest = oldest && frame && frame->id == i;
  }
  checker.expect(oldest && drain(bench.can0) == 0,
                 "of 80 frames without interrupt the controller keeps the oldest 64",
                 "do not clear the FIFO at an overflow");
  checker.expect(bench.can0.status().rx_lost == lost + 1,
                 "an overflow of the controller's FIFO is counted", "read RXOFLW, clear it");
  for (std::uint32_t i = 0; i < 200; ++i) { static_cast<void>(bench.can1.transmit({.id = i})); }
  checker.expect(drain(bench.can0) == 128 && bench.can0.status().rx_lost == lost + 73,
                 "200 frames that nobody takes fill the ring of 128, and 72 are counted",
                 "count what the ring refuses");
}

void check_modes(Zcu102Bench& bench, Checker& checker) {
  zcu102::XilinxCanBus& can = bench.can0;
  drain(bench.can1);
  can.set_mode(CanMode::loop_back);
  const bool looped = is_ok(can.transmit({.id = 0x123, .length = 3, .data = {1, 2, 3}}));
  const Result<CanFrame> own = can.receive();
  checker.expect(can.mode() == CanMode::loop_back && looped && own && own->id == 0x123 &&
                     own->data[2] == 3 && drain(bench.can1) == 0,
                 "in loop-back a controller hears itself and nobody else does", "LBACK of MSR");
  can.set_mode(CanMode::listen_only);
  static_cast<void>(can.transmit({.id = 0x124}));
  const bool silent = drain(bench.can1) == 0;
  static_cast<void>(bench.can1.transmit({.id = 0x125}));
  checker.expect(can.mode() == CanMode::listen_only && silent && drain(can) == 1,
                 "a controller that listens only receives and sends nothing", "SNOOP of MSR");
  can.set_mode(CanMode::normal);
  checker.expect(drain(bench.can1) == 1, "what waited leaves when the controller may send", "");
  can.set_mode(CanMode::sleep);
  const bool slept = can.mode() == CanMode::sleep;
  static_cast<void>(bench.can1.transmit({.id = 0x126}));
  checker.expect(slept && can.mode() == CanMode::normal && drain(can) == 1,
                 "a frame wakes a sleeping controller and is received", "SLEEP of MSR");
  can.set_mode(CanMode::off);
  static_cast<void>(bench.can1.transmit({.id = 0x127}));
  checker.expect(can.mode() == CanMode::off && can.status().state == CanState::absent &&
                     can.receive().status() == Status::disconnected,
                 "a controller that is off is absent", "CEN of SRR");
  can.set_mode(CanMode::normal);
  checker.expect(
      can.mode() == CanMode::normal && drain(can) == 0 && can.status().state == CanState::active,
      "and comes back without what it missed", "CEN of SRR");
}

/// Both ends are of one make, so that their mistakes would cancel: a block of memory shows what
/// goes into the registers. The figures are those of UG1085.
void check_register_words(Zcu102Bench& bench, Checker& checker) {
  alignas(8) volatile std::uint32_t registers[0x84 / 4] = {};
  zcu102::XilinxCanBus can{bench.generic_clock,
                           {.base = reinterpret_cast<std::uintptr_t>(&registers[0])}};
  const CanFilter filter[] = {{.id = 0x180, .mask = 0x7F0}};
  static_cast<void>(can.open(filter));
  checker.expect(registers[0x08 / 4] == 19 && registers[0x0C / 4] == 0x16,
                 "500 kbit/s of 100 MHz are 20 clocks a quantum, 10 quanta, sampled after 8",
                 "BRPR, BTR: each is written less one");
  checker.expect(registers[0x60 / 4] == 1 && registers[0x64 / 4] == 0xFE18'0000 &&
                     registers[0x68 / 4] == 0x3000'0000,
                 "the filter 0x180/0x7F0 is in AFMR1 and AFIR1", "IDH begins at bit 21");
  static_cast<void>(can.transmit({.id = 0x123, .length = 3, .data = {1, 2, 3}}));
  checker.expect(registers[0x30 / 4] == 0x2460'0000 && registers[0x34 / 4] == 0x3000'0000 &&
                     registers[0x38 / 4] == 0x0102'0300 && registers[0x3C / 4] == 0,
                 "a frame lies in the send FIFO as the manual says",
                 "the first byte is the highest");
  static_cast<void>(can.transmit({.id = 0x1ABC'DEF0, .extended = true, .remote = true}));
  checker.expect(registers[0x30 / 4] == 0xD5F9'BDE1,
                 "a 29-bit identifier is parted as the manual says", "SRR is set, RTR is bit 0");

  zcu102::CadenceSerialPort uart{bench.generic_clock,
                                 {.base = reinterpret_cast<std::uintptr_t>(&registers[0])}};
  static_cast<void>(uart.open());
  const std::uint32_t clocks = registers[0x18 / 4] * (registers[0x34 / 4] + 1);
  checker.expect(clocks >= 860 && clocks <= 876 && registers[0x04 / 4] == 0x20,
                 "115200 baud of 100 MHz are 868 clocks a bit, within 1 %, 8N1",
                 "CD of BRGR, BDIV, PAR of MR");
}

/// The emulated bus knows no errors either.
void check_bus_off(Zcu102Bench& bench, Checker& checker) {
  constexpr std::uint32_t kEnabled = 2;
  alignas(8) volatile std::uint32_t registers[0x84 / 4] = {};
  zcu102::XilinxCanBus can{
      bench.generic_clock,
      {.base = reinterpret_cast<std::uintptr_t>(&registers[0]), .restart_delay = 5ms}};
  static_cast<void>(can.open());
  registers[0x18 / 4] = (3U << 7) | (1U << 6);  // ESTAT, ERRWRN
  checker.expect(can.status().state == CanState::passive, "an error-passive controller says so",
                 "ESTAT of SR");
  registers[0x18 / 4] = (1U << 7) | (1U << 6);
  checker.expect(can.status().state == CanState::warning, "a warned controller says so",
                 "ERRWRN of SR");
  registers[0x1C / 4] = (1U << 9) | (1U << 8);  // BSOFF, ERROR
  can.on_interrupt();
  registers[0x1C / 4] = 0;
  const CanStatus status = can.status();
  checker.expect(status.state == CanState::bus_off && status.error_frames == 1 &&
                     can.transmit({.id = 1}) == Status::full && registers[0] == 0,
                 "bus-off stops the controller, and sending is refused", "BSOFF of ISR");
  static_cast<void>(can.receive());
  const bool waits = can.status().state == CanState::bus_off;
  bench.wait(6ms);
  static_cast<void>(can.receive());
  checker.expect(waits && can.status().restarts == 1 && registers[0] == kEnabled &&
                     is_ok(can.transmit({.id = 1})),
                 "the controller is started again after the delay, and that is counted",
                 "restart it from receive");
  zcu102::XilinxCanBus odd{bench.generic_clock, {.bit_rate = 499'999}};
  checker.expect(odd.open() == Status::invalid_argument,
                 "a bit rate that the clock does not divide into is refused", "see bit_timing");
}

}  // namespace

void check_can_registers(Zcu102Bench& bench, Checker& checker) {
  check_register_words(bench, checker);
  check_filters(bench, checker);
  check_overflow(bench, checker);
  check_modes(bench, checker);
  check_bus_off(bench, checker);
}

void check_uart_registers(Zcu102Bench& bench, Checker& checker) {
  zcu102::CadenceSerialPort port{bench.generic_clock, {.base = zcu102::kUart1, .loop_back = true}};
  const std::uint8_t bytes[40] = {1, 2, 3};
  std::uint8_t back[64] = {};
  const bool opened = is_ok(port.open()) && port.write(bytes);
  for (int i = 0; i < 4; ++i) { port.on_interrupt(); }
  const Result<SerialRead> read = port.read(back);
  checker.expect(opened && read && read->size == 40 && back[2] == 3 && port.lost() == 0,
                 "in loop-back every byte comes back", "send no more than the FIFO holds");
  // Past the driver: 20 bytes into a FIFO of 16.
  for (int i = 0; i < 20; ++i) {
    *reinterpret_cast<volatile std::uint32_t*>(zcu102::kUart1 + 0x30) = 7;
  }
  port.on_interrupt();
  checker.expect(port.lost() == 1 && port.read(back)->size == 16,
                 "an overrun of the FIFO is counted and the oldest bytes are kept", "ROVR of ISR");
  zcu102::CadenceSerialPort fast{bench.generic_clock, {.base = zcu102::kUart1, .baud = 60'000'000}};
  checker.expect(fast.open() == Status::invalid_argument,
                 "a rate that the clock cannot give is refused", "see dividers_for");
  static_cast<void>(bench.uart1.open());
}

void check_cycle_timer(Zcu102Bench& bench, Checker& checker) {
  const Timestamp begin = bench.now();
  const std::uint32_t before = bench.timer.wake_ups();
  bool early = false;
  for (int frame = 1; frame <= 20; ++frame) {
    bench.timer.sleep_until(begin + frame * 5ms);
    early = early || bench.now() < begin + frame * 5ms;
  }
  checker.expect(!early, "no frame of 5 ms is released early", "round the compare value up");
  // A machine without time to spare may pass several instants at once.
  const std::uint32_t wake_ups = bench.timer.wake_ups() - before;
  checker.expect(wake_ups >= 1 && wake_ups <= 20, "the timer's interrupt wakes the processor",
                 "unmask it, and attach its handler");
}

}  // namespace picolo
