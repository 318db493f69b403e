// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A board in QEMU beside the test, with the other ends of its UARTs in the test's hands.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "picolo/linux/file_descriptor.hpp"
#include "platforms.hpp"

namespace picolo::target {

class QemuBoard {
 public:
  static constexpr std::size_t kUarts = 4;

  /// Starts the image; returns when QEMU has opened all UARTs, or could not.
  QemuBoard(const Platform& platform, const std::string& image_name,
            const std::vector<std::string>& words, const std::string& options);
  QemuBoard(const QemuBoard&) = delete;
  QemuBoard& operator=(const QemuBoard&) = delete;
  ~QemuBoard();

  [[nodiscard]] bool started() const { return uarts_.back().is_open(); }
  /// What an UART has sent; waits up to a second for the first byte of any of `uarts`. False: the
  /// machine is gone.
  bool wait_for(std::span<const std::size_t> uarts);
  std::size_t receive(std::size_t uart, std::span<std::uint8_t> buffer);
  /// Bytes that QEMU's buffer has no room for are lost and counted.
  void send(std::size_t uart, std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::size_t not_sent() const { return not_sent_; }
  /// Waits for the end of the machine, 10 s at most.
  Outcome finish();

 private:
  std::filesystem::path folder_;
  std::array<FileDescriptor, kUarts> uarts_;
  pid_t pid_ = -1;
  std::size_t not_sent_ = 0;
};

}  // namespace picolo::target
