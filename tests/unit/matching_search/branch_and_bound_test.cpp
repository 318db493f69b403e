// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Branch and bound on trees whose answer is known: the worked example of the course, and random
// trees against brute force.

#include "picolo/matching/branch_and_bound.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

/// Two levels: coarse cells with a bound, each with leaves.
struct CoarseCells {
  struct Node {
    std::int32_t bound = 0;
    int cell = 0;
    bool leaf = false;
  };
  static constexpr std::size_t kMaxChildren = 4;

  std::vector<std::vector<int>> leaves;
  std::vector<int> visited;  // cells in the order of their expansion, from 1

  [[nodiscard]] bool is_leaf(const Node& node) const { return node.leaf; }
  std::size_t expand(const Node& node, std::span<Node> children) {
    visited.push_back(node.cell);
    const auto& scores = leaves[static_cast<std::size_t>(node.cell - 1)];
    for (std::size_t i = 0; i < scores.size(); ++i) { children[i] = {scores[i], node.cell, true}; }
    return scores.size();
  }
};

class WorkedExample : public ::testing::Test {
 protected:
  // Coarse scores 99, 85, 98, 96; the best leaf of cell 1 is 87, of cell 3 is 95, cell 4 stays
  // below 95.
  CoarseCells cells_{
      .leaves = {{80, 87, 75, 60}, {85, 84, 83, 82}, {90, 95, 94, 70}, {94, 93, 92, 91}},
      .visited = {}};
  std::vector<CoarseCells::Node> roots_{
      {99, 1, false}, {85, 2, false}, {98, 3, false}, {96, 4, false}};
  BranchAndBound<CoarseCells, 16> search_;
};

TEST_F(WorkedExample, GivenIndexOrderThenCell1GivesEightySevenTwoIsPrunedThreeGivesTheAnswer) {
  search_.begin(ChildOrder::index, -1);
  ASSERT_TRUE(search_.push(roots_));
  EXPECT_EQ(search_.bound_left(), 99);

  ASSERT_TRUE(search_.step(cells_));  // expands cell 1
  while (search_.bound_left() == 98 && cells_.visited.size() < 2) {
    if (search_.best() == 87) { EXPECT_THAT(cells_.visited, ::testing::ElementsAre(1)); }
    ASSERT_TRUE(search_.step(cells_));
  }
  EXPECT_EQ(search_.best(), 87);  // what cell 1 had; cell 2 (85) was pruned without a visit
  while (search_.step(cells_)) {}
  EXPECT_EQ(search_.best(), 95);
  EXPECT_EQ(search_.best_node().cell, 3);
  EXPECT_THAT(cells_.visited, ::testing::ElementsAre(1, 3, 4));
  EXPECT_EQ(search_.bound_left(), 95);
}

TEST_F(WorkedExample, GivenBestFirstThenOneThreeFourAreVisitedAndTwoIsPrunedLast) {
  search_.begin(ChildOrder::best_first, -1);
  ASSERT_TRUE(search_.push(roots_));
  std::uint32_t pruned_before_last = 0;
  while (!search_.empty()) {
    pruned_before_last = search_.pruned();
    static_cast<void>(search_.step(cells_));
  }
  EXPECT_EQ(search_.best(), 95);
  EXPECT_EQ(search_.best_node().cell, 3);
  EXPECT_THAT(cells_.visited, ::testing::ElementsAre(1, 3, 4));
  EXPECT_EQ(search_.pruned(), pruned_before_last + 1);  // the very last node taken is cell 2
}

TEST_F(WorkedExample, GivenAFloorAboveEveryLeafThenNothingIsFound) {
  search_.begin(ChildOrder::best_first, 95);
  ASSERT_TRUE(search_.push(roots_));
  while (search_.step(cells_)) {}
  EXPECT_FALSE(search_.found());
  EXPECT_EQ(search_.best(), 95);
  EXPECT_THAT(cells_.visited, ::testing::ElementsAre(1, 3, 4));
}

TEST_F(WorkedExample, GivenAFullStackWhenPushedThenItSaysSoAndKeepsWhatItHad) {
  BranchAndBound<CoarseCells, 5> small;
  small.begin(ChildOrder::index, -1);
  ASSERT_TRUE(small.push(roots_));
  EXPECT_FALSE(small.push(roots_));
  EXPECT_EQ(small.bound_left(), 99);
}

TEST_F(WorkedExample, GivenEqualBoundsWhenBestFirstThenTheFirstIsTaken) {
  cells_.leaves = {{50, 50}, {50}, {50}, {50}};
  roots_ = {{60, 1, false}, {70, 2, false}, {70, 3, false}, {60, 4, false}};
  search_.begin(ChildOrder::best_first, -1);
  ASSERT_TRUE(search_.push(roots_));
  while (search_.step(cells_)) {}
  EXPECT_THAT(cells_.visited, ::testing::ElementsAre(2, 3, 1, 4));
  EXPECT_EQ(search_.best_node().cell, 2);
}

/// A complete tree of random leaf scores; bounds are the maxima below plus slack.
struct RandomTree {
  struct Node {
    std::int32_t bound = 0;
    int level = 0;
    int index = 0;
  };
  static constexpr std::size_t kMaxChildren = 3;
  static constexpr int kDepth = 5;

  std::vector<std::vector<int>> bounds;  // by level; the last level holds the leaves
  int expanded = 0;

  RandomTree(std::uint64_t seed, int slack) : bounds(kDepth + 1) {
    Random random{seed};
    int count = 1;
    for (int level = 0; level <= kDepth; ++level) {
      bounds[static_cast<std::size_t>(level)].resize(static_cast<std::size_t>(count));
      count *= 3;
    }
    for (int& leaf : bounds[kDepth]) { leaf = static_cast<int>(random.below(1000)); }
    for (std::size_t level = kDepth; level > 0; --level) {
      for (std::size_t i = 0; i < bounds[level - 1].size(); ++i) {
        const auto& below = bounds[level];
        bounds[level - 1][i] = std::max({below[3 * i], below[3 * i + 1], below[3 * i + 2]}) +
                               static_cast<int>(random.below(static_cast<std::uint32_t>(slack)));
      }
    }
  }

  [[nodiscard]] bool is_leaf(const Node& node) const { return node.level == kDepth; }
  std::size_t expand(const Node& node, std::span<Node> children) {
    ++expanded;
    for (int i = 0; i < 3; ++i) {
      const int index = 3 * node.index + i;
      const int bound =
          bounds[static_cast<std::size_t>(node.level + 1)][static_cast<std::size_t>(index)];
      children[static_cast<std::size_t>(i)] = {bound, node.level + 1, index};
    }
    return 3;
  }
};

TEST(BranchAndBound,
     GivenRandomTreesThenBothOrdersFindTheBruteForceMaximumAndBestFirstExpandsLess) {
  int expanded_by_index = 0;
  int expanded_best_first = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    for (const ChildOrder order : {ChildOrder::index, ChildOrder::best_first}) {
      RandomTree tree{seed, 40};
      const int expected = *std::max_element(tree.bounds.back().begin(), tree.bounds.back().end());
      BranchAndBound<RandomTree, 1 + 2 * RandomTree::kDepth + 1> search;
      search.begin(order, -1);
      std::array<RandomTree::Node, 1> root{{{tree.bounds[0][0], 0, 0}}};
      ASSERT_TRUE(search.push(root));
      std::int32_t bound = search.bound_left();
      while (search.step(tree)) {
        ASSERT_LE(search.bound_left(), bound) << "the bound that is left never grows";
        bound = search.bound_left();
        ASSERT_GE(bound, expected);
      }
      ASSERT_EQ(search.best(), expected);
      (order == ChildOrder::index ? expanded_by_index : expanded_best_first) += tree.expanded;
    }
  }
  EXPECT_LT(expanded_best_first, expanded_by_index);
}

}  // namespace
}  // namespace picolo
