// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/method_marks.h"

#include "kinalign/evaluate/statistics.h"

#include <optional>

namespace kinalign {

namespace {

// A paired test needs at least two people.
constexpr std::size_t least_common_people = 2;

/// Tests two methods over the people for whom both have the measure. Absent if there are too few
/// people.
std::optional<PairedTest> test_of(const MethodMarks& first, const MethodMarks& second,
                                  const std::string& mark) {
  const auto ours = first.marks.find(mark), theirs = second.marks.find(mark);
  if (ours == first.marks.end() || theirs == second.marks.end()) return std::nullopt;
  std::vector<double> differences;
  // People are matched by name. A person whom only one method has is ignored.
  Mean mean;
  for (const auto& [person, value] : ours->second) {
    const auto other = theirs->second.find(person);
    if (other == theirs->second.end()) continue;
    differences.push_back(value.value_or(0.0) - other->second.value_or(0.0));
    mean.add(differences.back());
  }
  if (differences.size() < least_common_people) return std::nullopt;
  PairedTest out;
  out.people = differences.size();
  out.difference = mean.value_or(0.0);
  out.p = wilcoxon_signed_rank(differences).p;
  return out;
}

}  // namespace

std::vector<double> MethodMarks::values(const std::string& mark) const {
  std::vector<double> out;
  const auto found = marks.find(mark);
  if (found == marks.end()) return out;
  for (const auto& [person, mean] : found->second) out.push_back(mean.value_or(0.0));
  return out;
}

std::string MethodMarks::label() const {
  return variant.empty() ? method : method + ", " + variant;
}

std::vector<PairedTest> paired_tests(const std::vector<MethodMarks>& methods,
                                     const std::string& mark) {
  std::vector<PairedTest> out;
  std::vector<double> p;
  // If method and variant both differ, the cause of a difference is unknown, so the pair is
  // omitted.
  for (std::size_t a = 0; a < methods.size(); ++a) {
    for (std::size_t b = a + 1; b < methods.size(); ++b) {
      const bool comparable =
          methods[a].variant == methods[b].variant || methods[a].method == methods[b].method;
      auto test = comparable ? test_of(methods[a], methods[b], mark) : std::nullopt;
      if (!test) continue;
      test->first = a;
      test->second = b;
      p.push_back(test->p);
      out.push_back(*test);
    }
  }
  // Holm's correction needs all tests of the measure, so it follows the loop.
  const std::vector<double> corrected = holm(p);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].corrected = corrected[i];
  return out;
}

}  // namespace kinalign
