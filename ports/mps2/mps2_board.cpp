// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/mps2/mps2_board.hpp"

#include "registers.hpp"

extern "C" {
void systick_handler();
void interrupt_handler();
}

namespace picolo::inline v0::mps2 {
namespace {

[[gnu::section(".store")]] alignas(8) std::uint8_t g_store[kStoreBytes];

constinit Mps2Board* g_board = nullptr;

}  // namespace

Mps2Board::Mps2Board(const BoardConfig& config)
    : clock(config.first_count),
      can(kUarts[0], clock, config.can_baud),
      lidar(kUarts[1], clock, config.lidar_baud),
      imu(kUarts[2], clock, config.imu_baud),
      pace(clock),
      store(g_store, kStoreSector) {
  g_board = this;
}

void Mps2Board::start(Duration minor_frame) {
  enable_interrupt(kUartOverrunInterrupt);
  for (CmsdkUart* uart : {&can, &lidar, &imu}) { uart->start(); }
  frame_timer.start(minor_frame);
}

std::uint32_t Mps2Board::bytes_arrived() const {
  return can.arrived() + lidar.arrived() + imu.arrived();
}

void Mps2Board::on_interrupt(unsigned number) {
  if (number == HostPace::kTimerInterrupt) { pace.on_timer(); }
  if (number == HostPace::kAnswerInterrupt) { pace.on_answer(); }
  for (CmsdkUart* uart : {&can, &lidar, &imu}) {
    if (number == uart->place().receive_interrupt) { uart->on_receive(); }
    if (number == uart->place().receive_interrupt + 1) { uart->on_sent(); }
    if (number == kUartOverrunInterrupt) { uart->on_overrun(); }
  }
}

}  // namespace picolo::inline v0::mps2

void systick_handler() {
  picolo::mps2::g_board->frame_timer.tick();
}

void interrupt_handler() {
  std::uint32_t exception = 0;
  __asm__ volatile("mrs %0, ipsr" : "=r"(exception));
  picolo::mps2::g_board->on_interrupt(exception - 16);
}
