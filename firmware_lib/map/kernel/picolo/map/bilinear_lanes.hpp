// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// `sample` for eight points at once. The plain loop is the definition; with PICOLO_AVX2, which the
/// build sets together with -mavx2, vector instructions do the same operations in the same order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/map/bilinear.hpp"

#ifdef PICOLO_AVX2
#include <immintrin.h>
#endif

namespace picolo::inline v0 {

inline constexpr std::size_t kLanes = 8;
using Lanes = std::array<float, kLanes>;

struct FieldLanes {
  Lanes value;
  Lanes slope_x_per_m;
  Lanes slope_y_per_m;
  Lanes inside;
};

template <typename Field>
inline void sample_lanes(const Field& field, const Lanes& x_m, const Lanes& y_m, FieldLanes& at) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const FieldSample one = sample(field, x_m[l], y_m[l]);
    at.value[l] = one.value;
    at.slope_x_per_m[l] = one.slope_x_per_m;
    at.slope_y_per_m[l] = one.slope_y_per_m;
    at.inside[l] = one.inside;
  }
}

#ifdef PICOLO_AVX2
/// The 32-bit words that begin at byte `offset` of the cells.
inline __m256i gather_words(const std::uint8_t* cells, __m256i offset) {
  const void* const bytes = cells;
  return _mm256_i32gather_epi32(static_cast<const int*>(bytes), offset, 1);
}
inline __m256 byte_of(__m256i words, int byte) {
  return _mm256_cvtepi32_ps(
      _mm256_and_si256(_mm256_srli_epi32(words, 8 * byte), _mm256_set1_epi32(0xFF)));
}

inline void sample_lanes(const DistanceFieldView& field, const Lanes& x_m, const Lanes& y_m,
                         FieldLanes& at) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256 half = _mm256_set1_ps(0.5F);
  const __m256 scale = _mm256_set1_ps(field.cells_per_m);
  const __m256 u = _mm256_sub_ps(_mm256_mul_ps(_mm256_loadu_ps(x_m.data()), scale), half);
  const __m256 v = _mm256_sub_ps(_mm256_mul_ps(_mm256_loadu_ps(y_m.data()), scale), half);
  const __m256 last_u = _mm256_set1_ps(static_cast<float>(field.width - 1));
  const __m256 last_v = _mm256_set1_ps(static_cast<float>(field.height - 1));
  const __m256 inside = _mm256_and_ps(
      _mm256_and_ps(_mm256_cmp_ps(u, zero, _CMP_GE_OQ), _mm256_cmp_ps(v, zero, _CMP_GE_OQ)),
      _mm256_and_ps(_mm256_cmp_ps(u, last_u, _CMP_LT_OQ), _mm256_cmp_ps(v, last_v, _CMP_LT_OQ)));
  const __m256 u_in = _mm256_and_ps(u, inside);
  const __m256 v_in = _mm256_and_ps(v, inside);
  const __m256i column = _mm256_cvttps_epi32(u_in);
  const __m256i row = _mm256_cvttps_epi32(v_in);
  const __m256 fx = _mm256_sub_ps(u_in, _mm256_cvtepi32_ps(column));
  const __m256 fy = _mm256_sub_ps(v_in, _mm256_cvtepi32_ps(row));

  const __m256i width = _mm256_set1_epi32(field.width);
  const __m256i low = _mm256_add_epi32(_mm256_mullo_epi32(row, width), column);
  // The words of the upper row begin two cells earlier: those of the last cells stay inside.
  const __m256i high = _mm256_add_epi32(low, _mm256_set1_epi32(field.width - 2));
  const __m256i low_words = gather_words(field.cells, low);
  const __m256i high_words = gather_words(field.cells, high);
  const __m256 s1 = byte_of(low_words, 0);
  const __m256 s2 = byte_of(low_words, 1);
  const __m256 s4 = byte_of(high_words, 2);
  const __m256 s3 = byte_of(high_words, 3);

  const __m256 low_step = _mm256_sub_ps(s2, s1);
  const __m256 high_step = _mm256_sub_ps(s3, s4);
  const __m256 bottom = _mm256_add_ps(s1, _mm256_mul_ps(fx, low_step));
  const __m256 top = _mm256_add_ps(s4, _mm256_mul_ps(fx, high_step));
  const __m256 rise = _mm256_sub_ps(top, bottom);
  const __m256 distance = _mm256_add_ps(bottom, _mm256_mul_ps(fy, rise));
  const __m256 along_x =
      _mm256_add_ps(low_step, _mm256_mul_ps(fy, _mm256_sub_ps(high_step, low_step)));

  constexpr float kPerUnit = 1.0F / 255.0F;
  const __m256 mask = _mm256_and_ps(one, inside);
  const __m256 slope_scale = _mm256_mul_ps(mask, _mm256_set1_ps(-kPerUnit * field.cells_per_m));
  const __m256 nearness = _mm256_sub_ps(one, _mm256_mul_ps(_mm256_set1_ps(kPerUnit), distance));
  _mm256_storeu_ps(at.value.data(), _mm256_mul_ps(mask, nearness));
  _mm256_storeu_ps(at.slope_x_per_m.data(), _mm256_mul_ps(slope_scale, along_x));
  _mm256_storeu_ps(at.slope_y_per_m.data(), _mm256_mul_ps(slope_scale, rise));
  _mm256_storeu_ps(at.inside.data(), mask);
}
#endif

}  // namespace picolo::inline v0
