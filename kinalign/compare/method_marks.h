// SPDX-License-Identifier: Apache-2.0
// The error measures ("marks") of several methods on the same people (or folds), and paired tests
// between methods.
#pragma once

#include "kinalign/evaluate/sequence.h"
#include "kinalign/evaluate/uncertainty.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The error measures of one method and variant for each person. `marks` and `radii` are sums, to
/// which further seeds, folds or takes can be added.
struct MethodMarks {
  std::string method;   // "gated"
  std::string variant;  // "both", "kinect"; may be empty
  /// By measure ("position_cm") and person. Several values of one person, from different seeds or
  /// folds, are averaged.
  std::map<std::string, std::map<std::string, Mean>> marks{};
  /// The error radii that the method states, by part of the body ("arms"); empty: it states none.
  std::map<std::string, RadiusMarks> radii{};

  /// Returns the values of a measure, in the order of people's names; empty: there are none.
  std::vector<double> values(const std::string& mark) const;
  /// Returns the name of the table row: "gated, both".
  std::string label() const;
};

/// The comparison of two methods by one measure, over the people for whom both have values.
struct PairedTest {
  std::size_t first = 0, second = 0;  // indices of the methods
  std::size_t people = 0;             // people with values of both methods
  double difference = 0.0;            // mean of the first method's value minus the second's
  double p = 1.0;                     // two-sided, Wilcoxon's signed-rank test
  double corrected = 1.0;             // by Holm's method, over all tests of this measure
};

/// Tests all pairs of methods with the same variant, and all pairs of variants of the same method,
/// for one measure. Pairs with fewer than two common people are omitted.
std::vector<PairedTest> paired_tests(const std::vector<MethodMarks>& methods,
                                     const std::string& mark);

}  // namespace kinalign
