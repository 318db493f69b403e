// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The whole controller, one packet a minor frame: IN OUT, two files (pipes), and `log` where the
// packets are a recorded log's. Each reply is what
// LockstepController::reply says, then how long each task took and how deep the stack was. The
// image `calibrating` is the same with the calibration routine, ready for its command.

#include <new>
#include <string_view>

#include "picolo/simulated/board_config.hpp"
#include "picolo/simulated/lockstep_controller.hpp"
#include "picolo/simulated/log_config.hpp"
#include "platform.hpp"

namespace picolo {
namespace {

using Robot = LockstepController<RoomProfile>;

constexpr ControllerConfig kInstalled = board_config(kSoftwareDoubles);

class Ticks final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t cycles() override { return platform::ticks(); }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 25; }
};

alignas(64) constinit std::byte g_robot[sizeof(Robot)];
#ifdef PICOLO_CALIBRATES
alignas(64) constinit std::byte g_calibration[sizeof(BoardCalibration)];
#endif
alignas(8) constinit std::uint8_t g_packet[lockstep::kMaxPacket];
constinit std::uint8_t g_reply[Robot::kMaxReply];

#ifdef PICOLO_TIMER_BASE
// Below the stack of run(), to find how deep a frame uses it. A host's stack is its own business.
constexpr std::size_t kPainted = 4096;
constexpr std::uint32_t kPaint = 0xA5C31E78U;

volatile std::uint32_t* painted_from(void* frame_address) {
  __asm__ volatile("" : "+r"(frame_address));  // what lies below a frame is nobody's object
  return static_cast<volatile std::uint32_t*>(frame_address) - kPainted;
}

[[gnu::noinline]] void paint_stack(void* frame_address) {
  volatile std::uint32_t* const words = painted_from(frame_address);
  for (std::size_t i = 0; i + 64 < kPainted; ++i) { words[i] = kPaint; }
}

/// Bytes below `frame_address` that were used since.
[[gnu::noinline]] std::uint32_t painted_over(void* frame_address) {
  volatile std::uint32_t* const words = painted_from(frame_address);
  std::size_t clean = 0;
  while (clean + 64 < kPainted && words[clean] == kPaint) { ++clean; }
  return static_cast<std::uint32_t>((kPainted - clean) * sizeof(std::uint32_t));
}
#endif

// The C library's strcmp alone is 700 bytes of flash.
bool is(const char* text, std::string_view word) {
  for (const char letter : word) {
    if (*text++ != letter) { return false; }
  }
  return *text == '\0';
}

bool read_packet(int file, std::size_t& size) {
  if (platform::read_file(file, {g_packet, 2}) != 2) { return false; }
  size = load_u16_le({g_packet, 2}, 0);
  if (size < 2 || size > sizeof g_packet) { return false; }
  return platform::read_file(file, {g_packet + 2, size - 2}) == size - 2;
}

[[gnu::noinline]] Status frame(Robot& robot, TaskTicks& ticks) {
  return robot.run_frame(ticks);
}

template <Profile P>
void tell_size() {
  using Type = typename LockstepController<P>::Type;
  platform::write(P::kName);
  platform::write(" ");
  platform::write_decimal(sizeof(Type) + sizeof(CanopenWheels) + sizeof(Ld06) + sizeof(WitMotion) +
                          sizeof(EventRing));
  platform::write("\n");
}

int run() {
  char in[160];
  char out[160];
  platform::argument(0, in);
  platform::argument(1, out);
  if (is(in, "sizes")) {
    tell_size<RoomProfile>();
    tell_size<HallProfile>();
    tell_size<SiteProfile>();
    return 0;
  }
  const int packets = platform::open_file(in);
  const int replies = platform::open_output(out);
  if (packets < 0 || replies < 0) { return 1; }
  Ticks counter;
  char drive[8];
  platform::argument(2, drive);
  ControllerConfig config = kInstalled;
  if (is(drive, "log")) { config = on_a_log(config); }
  ControllerServices services;
#ifdef PICOLO_CALIBRATES
  auto& calibration =
      *new (g_calibration) BoardCalibration(board_calibration(config, kSoftwareDoubles));
  services.calibration = &calibration.core();
#endif
  Robot& robot = *new (g_robot) Robot(counter, config, services);
  std::size_t size = 0;
  while (read_packet(packets, size)) {
    TaskTicks ticks;
    Status status = robot.take({g_packet, size});
#ifdef PICOLO_TIMER_BASE
    paint_stack(__builtin_frame_address(0));
#endif
    if (is_ok(status)) { status = frame(robot, ticks); }
#ifdef PICOLO_TIMER_BASE
    const std::uint32_t deep = painted_over(__builtin_frame_address(0));
#else
    const std::uint32_t deep = 0;
#endif
    std::size_t at = 2 + robot.reply(status, std::span{g_reply}.subspan(2));
    for (const std::uint32_t spent : ticks.ticks) {
      store_u32_le(g_reply, at, spent);
      at += 4;
    }
    store_u32_le(g_reply, at, deep);
    at += 4;
    store_u16_le(g_reply, 0, static_cast<std::uint16_t>(at));
    if (!platform::write_file(replies, {g_reply, at})) { return 1; }
  }
  return 0;
}

}  // namespace
}  // namespace picolo

int main() {
  picolo::platform::leave(picolo::run());
}
