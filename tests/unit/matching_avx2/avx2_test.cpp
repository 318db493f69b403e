// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The same bits with vector instructions, for points anywhere: inside, on edges and corners of the
// window, outside, at infinity, no numbers at all.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "kernels.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/random.hpp"

/// What the renamed kernels call of the library itself.
namespace picolo::with_avx2 {
float logarithm(float x);
float logarithm(float x) {
  return picolo::v0::logarithm(x);
}
}  // namespace picolo::with_avx2

namespace picolo {
namespace {

class Avx2 : public ::testing::Test {
 protected:
  void SetUp() override {
    if (__builtin_cpu_supports("avx2") == 0) { GTEST_SKIP() << "this processor has no AVX2"; }
  }
};

struct Case {
  std::unique_ptr<std::uint8_t[]> cells;  // exactly the window: reading beyond it would be seen
  std::vector<float> x_m;
  std::vector<float> y_m;
  std::vector<std::int8_t> along_x;
  std::vector<std::int8_t> along_y;
  kernels::Input input{};
};

Case random_case(Random& random, int width, int height, std::size_t points) {
  Case made;
  made.cells = std::make_unique<std::uint8_t[]>(static_cast<std::size_t>(width * height));
  for (int k = 0; k < width * height; ++k) {
    made.cells[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(random.next_u32());
  }
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random.next_u32() % 1'000'003) / 1'000'003.0F;
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::array<float, 8> odd{
      kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(),    0.0F,
      -0.0F,     0.025F,     (static_cast<float>(width) - 0.5F) * 0.05F, 3e9F};
  const float wide_m = static_cast<float>(width) * 0.05F;
  const float high_m = static_cast<float>(height) * 0.05F;
  for (std::size_t k = 0; k < points; ++k) {
    const bool strange = random.next_u32() % 9 == 0;
    made.x_m.push_back(strange ? odd[random.next_u32() % odd.size()]
                               : uniform(-0.7F * wide_m, 0.7F * wide_m));
    made.y_m.push_back(strange ? odd[random.next_u32() % odd.size()]
                               : uniform(-0.7F * high_m, 0.7F * high_m));
  }
  const bool surfaces = random.next_u32() % 2 == 0;
  for (std::size_t k = 0; k < points; ++k) {
    const float direction = uniform(-3.2F, 3.2F);
    const float length = random.next_u32() % 4 == 0 ? 0.0F : 127.0F;
    made.along_x.push_back(static_cast<std::int8_t>(length * std::cos(direction)));
    made.along_y.push_back(static_cast<std::int8_t>(length * std::sin(direction)));
  }
  const float yaw = uniform(-3.0F, 3.0F);
  made.input = {made.cells.get(),
                width,
                height,
                made.x_m.data(),
                made.y_m.data(),
                surfaces ? made.along_x.data() : nullptr,
                surfaces ? made.along_y.data() : nullptr,
                points,
                0.5F * wide_m,
                0.5F * high_m,
                std::sin(yaw),
                std::cos(yaw),
                random.next_u32() % 3 == 0 ? 0.0F : 11.0F};
  if (random.next_u32() % 4 == 0) {  // points exactly on cells
    made.input.sine = 0.0F;
    made.input.cosine = 1.0F;
    made.input.pose_x_m = 0.025F;
    made.input.pose_y_m = 0.025F;
  }
  return made;
}

TEST_F(Avx2, GivesTheSameBitsAsThePlainLoops) {
  Random random{20'261};
  double inside = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const int width = 16 * (1 + static_cast<int>(random.next_u32() % 4));
    const int height = 16 * (1 + static_cast<int>(random.next_u32() % 4));
    const Case made = random_case(random, width, height, random.next_u32() % 70);
    const kernels::Output plain = kernels::plain(made.input);
    const kernels::Output fast = kernels::with_avx2(made.input);
    for (std::size_t i = 0; i < plain.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(plain[i]), std::bit_cast<std::uint32_t>(fast[i]))
          << "case " << k << " sum " << i << ": " << plain[i] << " and " << fast[i];
    }
    inside += static_cast<double>(plain[11]);
  }
  EXPECT_GT(inside, 40'000.0);
}

}  // namespace
}  // namespace picolo
