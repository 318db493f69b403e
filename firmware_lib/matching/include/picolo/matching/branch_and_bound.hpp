// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Branch and bound over any tree whose nodes know an upper bound of their leaves (Land and Doig
/// 1960; for scan matching Hess, Kohler, Rapp, Andor 2016, algorithm 3), depth first, one node a
/// step.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace picolo::inline v0 {

/// In which order siblings are visited.
enum class ChildOrder : std::uint8_t {
  index,       ///< as the problem lists them
  best_first,  ///< highest bound first, equal ones by index: finds good leaves early, prunes more
};

/// A node carries `bound`: no leaf below it scores higher; a leaf's bound is its score.
template <typename P>
concept BranchProblem = requires(P& problem, const typename P::Node& node,
                                 std::span<typename P::Node> children) {
  { node.bound } -> std::convertible_to<std::int32_t>;
  { problem.is_leaf(node) } -> std::same_as<bool>;
  { problem.expand(node, children) } -> std::same_as<std::size_t>;  // how many children it wrote
  { P::kMaxChildren } -> std::convertible_to<std::size_t>;
};

/// Stack of fixed capacity: the deepest level of a tree needs (kMaxChildren - 1) * depth + roots.
/// Context: cycle only.
template <BranchProblem Problem, std::size_t Capacity>
class BranchAndBound {
 public:
  using Node = typename Problem::Node;

  /// Only leaves above `floor` count. Forgets everything else.
  void begin(ChildOrder order, std::int32_t floor) {
    order_ = order;
    best_ = floor;
    found_ = false;
    size_ = 0;
    pruned_ = 0;
  }

  /// Adds siblings (roots). False when the stack is full: nothing was added.
  /// Cost: O(siblings^2) at worst.
  [[nodiscard]] bool push(std::span<const Node> siblings) {
    if (siblings.size() > Capacity - size_) { return false; }
    std::copy(siblings.begin(), siblings.end(), room().begin());
    push_written(siblings.size());
    return true;
  }
  /// Where siblings may be written for `push_written`: saves a second array of them.
  [[nodiscard]] std::span<Node> room() { return std::span{stack_}.subspan(size_); }
  /// As `push`, for the first `count` nodes of `room`. Precondition: count <= room().size().
  void push_written(std::size_t count) {
    const std::span<Node> siblings = room().first(count);
    if (order_ == ChildOrder::best_first) { sort_by_bound(siblings); }
    std::reverse(siblings.begin(), siblings.end());  // the first lies on top
    size_ += count;
  }

  /// Takes one node: prunes it when not above the best leaf so far, keeps it when it is a leaf,
  /// expands it otherwise. False when nothing is left. Precondition: the stack has room for the
  /// children.
  bool step(Problem& problem) {
    if (size_ == 0) { return false; }
    --size_;
    const Node node = stack_[size_];
    if (node.bound <= best_) {
      ++pruned_;
    } else if (problem.is_leaf(node)) {
      best_ = node.bound;
      best_node_ = node;
      found_ = true;
    } else {
      const std::size_t count = problem.expand(node, children_);
      static_cast<void>(push({children_.data(), std::min(count, children_.size())}));
    }
    return size_ > 0;
  }

  [[nodiscard]] bool found() const { return found_; }
  [[nodiscard]] const Node& best_node() const { return best_node_; }  ///< precondition: found()
  [[nodiscard]] std::int32_t best() const { return best_; }  ///< score, or the floor before
  [[nodiscard]] std::uint32_t pruned() const { return pruned_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// No leaf that is still reachable scores higher. Cost: O(stack).
  [[nodiscard]] std::int32_t bound_left() const {
    std::int32_t bound = best_;
    for (std::size_t i = 0; i < size_; ++i) {
      bound = std::max(bound, static_cast<std::int32_t>(stack_[i].bound));
    }
    return bound;
  }

 private:
  // Insertion: stable, in place, and siblings are few.
  static void sort_by_bound(std::span<Node> nodes) {
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const Node node = nodes[i];
      std::size_t at = i;
      for (; at > 0 && nodes[at - 1].bound < node.bound; --at) { nodes[at] = nodes[at - 1]; }
      nodes[at] = node;
    }
  }

  std::array<Node, Capacity> stack_{};
  std::array<Node, Problem::kMaxChildren> children_{};
  Node best_node_{};
  std::size_t size_ = 0;
  std::int32_t best_ = 0;
  std::uint32_t pruned_ = 0;
  ChildOrder order_ = ChildOrder::best_first;
  bool found_ = false;
};

}  // namespace picolo::inline v0
