// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "support/paths.hpp"

namespace picolo::test {

std::filesystem::path source_dir() {
  return PICOLO_SOURCE_DIR;
}

std::filesystem::path data_dir() {
  return PICOLO_TEST_DATA;
}

}  // namespace picolo::test
