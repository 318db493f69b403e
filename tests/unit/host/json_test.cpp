// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/json.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include "support/property.hpp"

namespace picolo {
namespace {

using host::Json;

TEST(Json, NumbersArePlainDecimals) {
  EXPECT_EQ(host::plain_decimal(0.0), "0");
  EXPECT_EQ(host::plain_decimal(1e-7), "0.0000001");
  EXPECT_EQ(host::plain_decimal(-2.5e-5), "-0.000025");
  EXPECT_EQ(host::plain_decimal(1e20), "100000000000000000000");
  EXPECT_EQ(host::plain_decimal(976053557.767368), "976053557.767368");
  EXPECT_EQ(host::plain_decimal(std::numeric_limits<double>::quiet_NaN()), "null");
  EXPECT_EQ(host::plain_decimal(-std::numeric_limits<double>::infinity()), "null");
}

RC_GTEST_PROP(Json, EveryDoubleSurvivesWithoutAnExponent, (std::uint64_t bits)) {
  const double value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  const std::string text = host::plain_decimal(value);
  RC_ASSERT(text.find_first_of("eE") == std::string::npos);
  RC_ASSERT(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)) == bits);
}

TEST(Json, ObjectsKeepTheirOrderAndNestedNumbersStayPlain) {
  const Json json{{"zeta", 1},
                  {"alpha", {{"tiny", 1e-9}, {"list", {1e-6, 2, true, nullptr}}}},
                  {"text", "say \"hi\"\n"},
                  {"empty", Json::object()},
                  {"none", Json::array()}};
  const std::string text = host::to_text(json);
  EXPECT_EQ(text, R"({"zeta":1,"alpha":{"tiny":0.000000001,"list":[0.000001,2,true,null]},)"
                  R"("text":"say \"hi\"\n","empty":{},"none":[]})");
  EXPECT_EQ(Json::parse(text), json);
}

TEST(Json, TextThatIsNotUtf8StaysReadableJson) {
  const std::string text = host::to_text({{"path", "a\xFF"}});
  EXPECT_TRUE(Json::accept(text)) << text;
}

}  // namespace
}  // namespace picolo
