// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Any bytes, in any pieces, with losses and refusals, on the serial line of an SLCAN adapter.
#include <algorithm>

#include "picolo/drivers/slcan/slcan_bus.hpp"
#include "targets.hpp"

namespace picolo::fuzz {
namespace {

/// What each call does is the input's choice.
class WhimsicalPort final : public SerialPort {
 public:
  explicit WhimsicalPort(Reader& reader) : reader_(reader) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    const std::uint8_t choice = reader_.byte();
    if (choice == 0xFF) { return Status::disconnected; }
    if (choice == 0xFE) { ++lost_; }
    const std::size_t size = std::min<std::size_t>(buffer.size(), choice % 80U);
    if (size == 0 || reader_.empty()) { return Status::not_ready; }
    for (std::size_t i = 0; i < size; ++i) { buffer[i] = reader_.byte(); }
    now_ += transmission_time(size, baud());
    return SerialRead{.size = size, .last_byte_stamp = now_, .source = StampSource::hardware};
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    const std::uint8_t choice = reader_.byte();
    if (choice == 0xFF) { return Status::disconnected; }
    if (choice % 4U == 3U) { return Status::full; }
    return choice % 2U == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 1 + choice % 8U);
  }
  [[nodiscard]] std::uint32_t baud() const override { return 1'000'000; }
  [[nodiscard]] std::uint32_t lost() const override { return lost_; }

 private:
  Reader& reader_;
  Timestamp now_{1s};
  std::uint32_t lost_ = 0;
};

void slcan_bus(Input input) {
  Reader reader{input};
  WhimsicalPort port{reader};
  SlcanBus bus{port};
  Timestamp last = Timestamp::min();
  std::uint32_t received = 0;
  while (!reader.empty()) {
    if (reader.byte() % 8U == 0) {
      static_cast<void>(bus.transmit({.id = reader.word(2), .length = reader.byte()}));
    }
    const Result<CanFrame> frame = bus.receive();
    if (!frame) { continue; }
    ++received;
    require(frame->length <= 8, "a frame of more than 8 bytes");
    require(frame->id <= (frame->extended ? 0x1FFF'FFFFU : 0x7FFU), "an impossible identifier");
    require(frame->stamp >= last, "stamps of frames run backwards");
    last = frame->stamp;
  }
  require(bus.status().received == received, "frames handed out are not those counted");
  require(received * 6U <= input.size(), "frames out of nothing");
}

}  // namespace

std::vector<Target> slcan_targets() {
  return {{"slcan", slcan_bus, true}};
}

}  // namespace picolo::fuzz
