// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/template/template_port.hpp"

// Vendor headers belong here, never in the port's own headers. Twelve functions, in the order in
// which the conformance suite asks for them.

namespace picolo::inline v0::template_port {

// 1. A hardware timer in microseconds, extended to 64 bits: on wrap of the low word count the high
// word up, in the timer's interrupt.
Timestamp TemplateClock::now() {
  return Timestamp{};
}

// 2. Pop a ring that the receive interrupt fills (core/ring_buffer.hpp), stamped in the interrupt;
// last_byte_stamp is when it took the last byte.
Result<SerialRead> TemplateSerialPort::read(std::span<std::uint8_t> buffer) {
  static_cast<void>(buffer);
  return Status::not_ready;
}

// 3. Push into a ring that the transmit interrupt empties.
Result<std::size_t> TemplateSerialPort::write(std::span<const std::uint8_t> bytes) {
  static_cast<void>(bytes);
  return Status::unsupported;
}

// 4. Like 2, with frames; fill status_ here and in the interrupt.
Result<CanFrame> TemplateCanBus::receive() {
  return Status::not_ready;
}

// 5. Test the frame, write it to the controller's send FIFO if that has room, count.
Status TemplateCanBus::transmit(const CanFrame& frame) {
  static_cast<void>(frame);
  return Status::unsupported;
}

// 6. Two or more erasable sectors that hold neither code nor anything else.
ByteStoreGeometry TemplateByteStore::geometry() const {
  return {};
}

// 7. One sector.
Status TemplateByteStore::erase(std::size_t address) {
  static_cast<void>(address);
  return Status::unsupported;
}

// 8. A copy from where the flash is seen in memory.
Status TemplateByteStore::read(std::size_t address, std::span<std::uint8_t> bytes) {
  static_cast<void>(address);
  static_cast<void>(bytes);
  return Status::unsupported;
}

// 9. Whole granules.
Status TemplateByteStore::program(std::size_t address, std::span<const std::uint8_t> bytes) {
  static_cast<void>(address);
  static_cast<void>(bytes);
  return Status::unsupported;
}

// 10. The rate of 11 in MHz.
std::uint32_t TemplateCycleCounter::cycles_per_us() const {
  return 0;
}

// 11. DWT->CYCCNT on Cortex-M3 and up; any free-running timer otherwise.
std::uint32_t TemplateCycleCounter::cycles() {
  return 0;
}

// 12. Write the reload word of the hardware watchdog.
void TemplateWatchdog::stroke() {}

}  // namespace picolo::inline v0::template_port
