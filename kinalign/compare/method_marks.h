// SPDX-License-Identifier: Apache-2.0
// Marks of several methods on the same people (or folds), and paired tests between the methods.
#pragma once

#include "kinalign/evaluate/sequence.h"
#include "kinalign/evaluate/uncertainty.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

struct MethodMarks {
  std::string method;   // "gated"
  std::string variant;  // of its answers: "both", "kinect"; may be empty
  /// By mark ("position_cm") and person. What is added for the same person is averaged: several
  /// seeds, or several folds.
  std::map<std::string, std::map<std::string, Mean>> marks{};
  /// The radii that the method states, by part of the body ("arms"); empty where it states none.
  std::map<std::string, RadiusMarks> radii{};

  /// The values of a mark, in the order of the people's names; empty where there is none.
  std::vector<double> values(const std::string& mark) const;
  /// "gated, both".
  std::string label() const;
};

struct PairedTest {
  std::size_t first = 0, second = 0;  // of the methods
  std::size_t people = 0;             // who have the mark of both
  double difference = 0.0;            // mean of first minus second
  double p = 1.0;                     // two-sided, Wilcoxon's signed ranks
  double corrected = 1.0;             // by Holm, over the tests of this mark
};

/// Every two methods of the same variant, and every two variants of the same method, for one mark.
/// Pairs without two common people are left out.
std::vector<PairedTest> paired_tests(const std::vector<MethodMarks>& methods,
                                     const std::string& mark);

}  // namespace kinalign
