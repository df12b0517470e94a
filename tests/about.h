// SPDX-License-Identifier: Apache-2.0
// doctest's Approx forgives `epsilon` of one and the value together: a tenth of a second where a
// millisecond is compared to a tenth. This one forgives a share of the value itself, and of 0
// nothing.
#pragma once

#include <doctest/doctest.h>

namespace kinalign {

inline doctest::Approx about(double value, double share = 1e-9) {
  return doctest::Approx(value).epsilon(share).scale(1e-100);
}

}  // namespace kinalign
