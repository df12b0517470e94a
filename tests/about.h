// SPDX-License-Identifier: Apache-2.0
// A comparison like doctest's Approx, but relative. Approx allows `epsilon` of the sum of one and
// the value, which is a tenth of a second if a millisecond is compared with a tolerance of a tenth.
// This one allows a share of the value itself, and nothing for 0.
#pragma once

#include <doctest/doctest.h>

namespace kinalign {

inline doctest::Approx about(double value, double share = 1e-9) {
  return doctest::Approx(value).epsilon(share).scale(1e-100);
}

}  // namespace kinalign
