// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/version.hpp"

#include <gtest/gtest.h>

#include <string>

namespace picolo {
namespace {

TEST(Version, OfTheHeaderIsThatOfTheBuild) {
  EXPECT_EQ(std::to_string(kVersionMajor) + "." + std::to_string(kVersionMinor) + "." +
                std::to_string(kVersionPatch),
            PICOLO_PROJECT_VERSION);
}

}  // namespace
}  // namespace picolo
