// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One piece of memory for the two searches of the localiser, of which at most one is under way.
#pragma once

#include <memory>
#include <type_traits>

#include "picolo/matching/correlative.hpp"
#include "picolo/matching/pose_search.hpp"

namespace picolo::inline v0 {

/// Begins as the near search. `use_...` forgets what the other has found; a call for what is in use
/// already does nothing. Cost of a change: about 1000 instructions.
class SearchMemory {
  static_assert(std::is_trivially_destructible_v<CorrelativeSearch> &&
                std::is_trivially_destructible_v<PoseSearch>);

 public:
  explicit SearchMemory(const CorrelativeConfig& config) : near_(config) {}
  SearchMemory(const SearchMemory&) = delete;
  SearchMemory& operator=(const SearchMemory&) = delete;
  ~SearchMemory() = default;

  void use_near(const CorrelativeConfig& config) {
    if (is_near_) { return; }
    std::construct_at(&near_, config);
    is_near_ = true;
  }
  void use_anywhere(const PoseSearchConfig& config) {
    if (!is_near_) { return; }
    std::construct_at(&anywhere_, config);
    is_near_ = false;
  }
  /// Precondition: the last one asked for.
  [[nodiscard]] CorrelativeSearch& near() { return near_; }
  [[nodiscard]] PoseSearch& anywhere() { return anywhere_; }

 private:
  union {
    CorrelativeSearch near_;
    PoseSearch anywhere_;
  };
  bool is_near_ = true;
};

}  // namespace picolo::inline v0
