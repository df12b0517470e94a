// SPDX-License-Identifier: Apache-2.0
// The marks of several methods on the same people (or folds), and paired tests between the methods.
#pragma once

#include "kinalign/evaluate/sequence.h"
#include "kinalign/evaluate/uncertainty.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The marks of one method and variant over people. `marks` and `radii` are sums that more seeds,
/// folds or takes may be added to.
struct MethodMarks {
  std::string method;   // "gated"
  std::string variant;  // "both", "kinect"; may be empty
  /// By mark ("position_cm") and person. Values of one person, from several seeds or folds, are
  /// averaged.
  std::map<std::string, std::map<std::string, Mean>> marks{};
  /// The radii that the method states, by part of the body ("arms"); empty if it states none.
  std::map<std::string, RadiusMarks> radii{};

  /// The values of a mark, in the order of people's names; empty if there are none.
  std::vector<double> values(const std::string& mark) const;
  /// The name of the row: "gated, both".
  std::string label() const;
};

/// One comparison of two methods by one mark, over the people that both have.
struct PairedTest {
  std::size_t first = 0, second = 0;  // indices of the methods
  std::size_t people = 0;             // with the mark of both
  double difference = 0.0;            // mean of first minus second
  double p = 1.0;                     // two-sided, Wilcoxon's signed ranks
  double corrected = 1.0;             // by Holm's method, over the tests of this mark
};

/// Tests every two methods of one variant, and every two variants of one method, for one mark.
/// Pairs without two common people are left out.
std::vector<PairedTest> paired_tests(const std::vector<MethodMarks>& methods,
                                     const std::string& mark);

}  // namespace kinalign
