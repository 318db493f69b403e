// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// An empty port: copy the folder, rename it, and fill in the twelve functions of its .cpp file. It
/// compiles as it is, and the conformance suite says which function comes next and what it lacks
/// (`picolo_template_conformance`; docs/porting.md).
#pragma once

#include "picolo/hal/byte_store.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo::inline v0::template_port {

class TemplateClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() override;
};

class TemplateCycleCounter final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t cycles() override;
  [[nodiscard]] std::uint32_t cycles_per_us() const override;
};

class TemplateCanBus final : public CanBus {
 public:
  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override { return status_; }

 private:
  CanStatus status_{.state = CanState::absent};
};

class TemplateSerialPort final : public SerialPort {
 public:
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return 115'200; }
  [[nodiscard]] std::uint32_t lost() const override { return lost_; }

 private:
  std::uint32_t lost_ = 0;
};

class TemplateByteStore final : public ByteStore {
 public:
  [[nodiscard]] ByteStoreGeometry geometry() const override;
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override;
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override;
  Status erase(std::size_t address) override;
};

class TemplateWatchdog final : public Watchdog {
 public:
  void stroke() override;
};

}  // namespace picolo::inline v0::template_port
