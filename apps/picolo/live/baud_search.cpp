// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/baud_search.hpp"

namespace picolo::tool {
namespace {

constexpr std::uint64_t kEnough = 3;
constexpr Duration kPatience = 2s;

}  // namespace

std::optional<std::uint32_t> BaudSearch::update(Timestamp now, bool present,
                                                const devices::Counters& counters) {
  if (over_ || bauds_.size() < 2) { return std::nullopt; }
  const Tally all{devices::value_of(counters, "frames"),
                  devices::value_of(counters, "bad_checksums")};
  const Tally here{all.sound - before_.sound, all.damaged - before_.damaged};
  if (here.sound >= kEnough && here.sound > here.damaged) {
    over_ = true;
    return std::nullopt;
  }
  if (!present) {
    patience_from_.reset();
    return std::nullopt;
  }
  const bool begins = !patience_from_;
  const bool goes_on = here.sound > last_sound_ && here.sound > here.damaged;
  last_sound_ = here.sound;
  if (begins || goes_on) { patience_from_ = now; }
  if (now - *patience_from_ < kPatience) { return std::nullopt; }
  at_ = (at_ + 1) % bauds_.size();
  before_ = all;
  last_sound_ = 0;
  patience_from_ = now;
  return baud();
}

bool BaudSearch::found_another() {
  const bool tell = over_ && at_ > 0 && !told_;
  told_ = told_ || tell;
  return tell;
}

}  // namespace picolo::tool
