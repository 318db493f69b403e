// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// QEMU: the first two serial lines connected with each other. The CAN bus is SLCAN over that line:
// what one end sends is what the other receives.

#include <optional>

#include "conformance_image.hpp"
#include "picolo/board/memory_byte_store.hpp"
#include "picolo/drivers/slcan/slcan_bus.hpp"
#include "picolo/mps2/board_clock.hpp"
#include "picolo/mps2/cmsdk_uart.hpp"
#include "picolo/mps2/cmsdk_watchdog.hpp"
#include "platform.hpp"

namespace picolo {
namespace {

constexpr std::uint32_t kBaud = 1'000'000;
constexpr std::size_t kLongestLine = 1 + 8 + 1 + 16 + 1;
constexpr Duration kWatchdogPeriod = 400ms;
constexpr Duration kPatience = 60ms;                 // with the emulated line
constexpr std::uintptr_t kClearEnable = 0xE000E180;  // NVIC, interrupts 0 to 31
constexpr std::uint32_t kSendFull = 1;               // in a UART's state

volatile std::uint32_t& word_at(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

[[gnu::section(".noinit")]] alignas(8) std::uint8_t g_flash[8 * 4096];
constinit volatile bool g_barked = false;

/// Counts what is sent, so that the bench can wait for its arrival.
class CountedPort final : public SerialPort {
 public:
  explicit CountedPort(SerialPort& port) : port_(port) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override { return port_.read(buffer); }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    const Result<std::size_t> taken = port_.write(bytes);
    if (taken) { written_ += static_cast<std::uint32_t>(*taken); }
    return taken;
  }
  [[nodiscard]] std::uint32_t baud() const override { return port_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return port_.lost(); }
  [[nodiscard]] std::uint32_t written() const { return written_; }

 private:
  SerialPort& port_;
  std::uint32_t written_ = 0;
};

struct Mps2Bench;
constinit Mps2Bench* g_bench = nullptr;

struct Mps2Bench {
  mps2::BoardClock board_clock;
  mps2::BoardCycles cycles;
  mps2::CmsdkUart near{mps2::kUarts[0], board_clock, kBaud};
  /// Without interrupts: served while the bench waits, so that it holds bytes back like a device
  /// that does not listen.
  mps2::CmsdkUart far{mps2::kUarts[1], board_clock, kBaud};
  CountedPort counted_far{far};
  SlcanBus can{near};
  SlcanBus adapter{counted_far};
  mps2::FrameTimer tick;
  volatile std::uint32_t arrived = 0;  ///< bytes, at the near end
  mps2::CmsdkWatchdog dog;
  std::optional<board::MemoryByteStore> flash;

  Mps2Bench() {
    g_bench = this;  // for the interrupts
    reopen();
    near.start();
    far.start();
    const unsigned first = far.place().receive_interrupt;
    word_at(kClearEnable) = 3U << first;
    tick.start(1ms);
  }

  Clock& clock() { return board_clock; }
  CycleCounter& cycle_counter() { return cycles; }
  SerialPort& port() { return near; }
  CanBus& bus() { return can; }
  ByteStore& store() { return *flash; }
  void reopen() { flash.emplace(g_flash, 4096); }
  Watchdog& watchdog() { return dog; }
  void start_watchdog() { dog.start(kWatchdogPeriod); }
  Duration period() { return kWatchdogPeriod; }
  bool fired() { return g_barked; }
  Timestamp now() { return board_clock.now(); }

  /// Serves the far end, then lets the emulator work until the next interrupt.
  void serve_far() {
    far.on_receive();
    if ((word_at(far.place().base + 4) & kSendFull) == 0) { far.on_sent(); }
    __asm__ volatile("wfi" ::: "memory");
  }
  /// The emulated line goes at the host's pace, not at its rate: also until all has arrived.
  void wait(Duration duration) {
    const Timestamp end = now() + duration;
    while (now() < end || (arrived != counted_far.written() && now() < end + 2s)) { serve_far(); }
  }
  bool inject(std::span<const std::uint8_t> bytes) {
    const Result<std::size_t> taken = counted_far.write(bytes);
    return taken && *taken == bytes.size();
  }
  std::size_t sent(std::span<std::uint8_t> buffer) {
    for (const Timestamp end = now() + kPatience; now() < end;) {
      serve_far();
      if (const Result<SerialRead> read = far.read(buffer)) { return read->size; }
    }
    return 0;
  }
  /// Stamps are when a line began: frames follow each other at the line's rate.
  bool inject(const CanFrame& frame) {
    wait(transmission_time(kLongestLine, kBaud));
    return is_ok(adapter.transmit(frame));
  }
  Result<CanFrame> sent() {
    for (const Timestamp end = now() + kPatience; now() < end; serve_far()) {
      if (const Result<CanFrame> frame = adapter.receive()) { return frame; }
    }
    return Status::not_ready;
  }
};

/// The emulated UART waits until its byte was taken; overruns exist only on a block of memory in
/// place of the registers.
void check_overruns(Mps2Bench& bench, conformance::Checker& checker) {
  constexpr std::uint32_t kOverrun = 1U << 3;  // in the state; writing the bit clears it
  volatile std::uint32_t words[5] = {0, 0, 0, 0, 0};
  const mps2::UartPlace place{reinterpret_cast<std::uintptr_t>(words), 30};
  mps2::CmsdkUart uart{place, bench.board_clock, kBaud};
  uart.on_overrun();
  checker.expect(uart.lost() == 0 && words[1] == 0,
                 "the interrupt that UARTs share counts no overrun of another UART",
                 "look at the overrun bit of each");
  words[1] = kOverrun | 1U;
  uart.on_overrun();
  checker.expect(uart.lost() == 1 && words[1] == kOverrun,
                 "an overrun is counted and its bit alone is cleared", "write 1 to clear");
}

}  // namespace

void check_board(conformance::Suite& suite) {
  Mps2Bench bench;
  conformance::check_port(bench, suite);
  suite.run("UART overruns",
            [&](conformance::Checker& checker) { check_overruns(bench, checker); });
}

}  // namespace picolo

extern "C" void interrupt_handler() {
  std::uint32_t exception = 0;
  __asm__ volatile("mrs %0, ipsr" : "=r"(exception));
  const unsigned number = exception - 16;
  picolo::mps2::CmsdkUart& uart = picolo::g_bench->near;
  if (number == uart.place().receive_interrupt) {
    picolo::g_bench->arrived = picolo::g_bench->arrived + 1;  // the emulated FIFO holds one byte
    uart.on_receive();
  }
  if (number == uart.place().receive_interrupt + 1) { uart.on_sent(); }
}

extern "C" void systick_handler() {
  picolo::g_bench->tick.tick();
}

/// The watchdog's first word. Stroked now, it does not reset.
extern "C" void nmi_handler() {
  picolo::g_barked = true;
  picolo::g_bench->dog.stroke();
}
