// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/template/template_port.hpp"

// Vendor headers belong here, never in the port's own headers.

namespace picolo::inline v0::template_port {

// A hardware timer, extended to 64 bits: on wrap of the low word count the high word up, in its
// interrupt.
Timestamp TemplateClock::now() {
  return Timestamp{};
}

// DWT->CYCCNT on Cortex-M3 and up; any free-running timer otherwise.
std::uint32_t TemplateCycleCounter::cycles() {
  return 0;
}

std::uint32_t TemplateCycleCounter::cycles_per_us() const {
  return 1;
}

// Pop a ring that the receive interrupt fills (core/ring_buffer.hpp), stamped in the interrupt.
Result<CanFrame> TemplateCanBus::receive() {
  return Status::not_ready;
}

Status TemplateCanBus::transmit(const CanFrame& frame) {
  static_cast<void>(frame);
  return Status::unsupported;
}

// As above; last_byte_stamp is when the interrupt took the last byte.
Result<SerialRead> TemplateSerialPort::read(std::span<std::uint8_t> buffer) {
  static_cast<void>(buffer);
  return Status::not_ready;
}

Result<std::size_t> TemplateSerialPort::write(std::span<const std::uint8_t> bytes) {
  static_cast<void>(bytes);
  return Status::unsupported;
}

// Two or more erasable sectors that hold neither code nor anything else.
ByteStoreGeometry TemplateByteStore::geometry() const {
  return {};
}

Status TemplateByteStore::read(std::size_t address, std::span<std::uint8_t> bytes) {
  static_cast<void>(address);
  static_cast<void>(bytes);
  return Status::unsupported;
}

Status TemplateByteStore::program(std::size_t address, std::span<const std::uint8_t> bytes) {
  static_cast<void>(address);
  static_cast<void>(bytes);
  return Status::unsupported;
}

Status TemplateByteStore::erase(std::size_t address) {
  static_cast<void>(address);
  return Status::unsupported;
}

void TemplateWatchdog::stroke() {
  // Write the reload word of the hardware watchdog.
}

}  // namespace picolo::inline v0::template_port
