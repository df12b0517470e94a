// SPDX-License-Identifier: Apache-2.0
// A BVH as text, for tests.
#pragma once

#include "kinalign/formats/bvh/bvh.h"

#include <doctest/doctest.h>

#include <string>

namespace kinalign {

inline std::string written(const BvhFile& file) {
  std::string text;
  REQUIRE(write_bvh(file, [&text](std::string_view piece) -> Result<void> {
    text += piece;
    return {};
  }));
  return text;
}

}  // namespace kinalign
