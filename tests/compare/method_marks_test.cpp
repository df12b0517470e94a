// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/method_marks.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// One value of the mark "cm" for each of the people "0", "1", ...
MethodMarks marked(const std::string& method, const std::string& variant,
                   const std::vector<double>& values) {
  MethodMarks out{method, variant};
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.marks["cm"][std::to_string(i)].add(values[i]);
  }
  return out;
}

}  // namespace

TEST_CASE("several seeds of one person are one value") {
  MethodMarks marks = marked("dip", "", {1.0, 5.0});
  marks.marks["cm"]["0"].add(2.0);
  CHECK(marks.values("cm") == std::vector<double>{1.5, 5.0});
  CHECK(marks.values("deg").empty());
}

TEST_CASE("paired tests agree with SciPy and are corrected over all pairs of a mark") {
  // SciPy 1.10.1: wilcoxon(a, b).pvalue and so on; Holm by hand.
  const std::vector<MethodMarks> methods{marked("a", "", {10.1, 12.3, 9.8, 11.0, 13.2, 10.7}),
                                         marked("b", "", {10.6, 13.0, 10.0, 11.9, 14.3, 11.1}),
                                         marked("c", "", {10.4, 12.35, 10.4, 10.8, 12.7, 10.8})};
  const auto tests = paired_tests(methods, "cm");
  REQUIRE(tests.size() == 3);
  CHECK((tests[0].first == 0 && tests[0].second == 1 && tests[0].people == 6));
  CHECK(tests[0].difference == doctest::Approx(-0.6333333).epsilon(1e-6));
  CHECK(tests[0].p == doctest::Approx(0.03125).epsilon(1e-9));
  CHECK(tests[1].p == doctest::Approx(0.6875).epsilon(1e-9));
  CHECK(tests[2].p == doctest::Approx(0.15625).epsilon(1e-9));
  CHECK(tests[0].corrected == doctest::Approx(0.09375).epsilon(1e-9));
  CHECK(tests[1].corrected == doctest::Approx(0.6875).epsilon(1e-9));
  CHECK(tests[2].corrected == doctest::Approx(0.3125).epsilon(1e-9));
}

TEST_CASE("only methods of one variant, and variants of one method, are tested") {
  const std::vector<double> values{1.0, 2.0, 3.0};
  const std::vector<MethodMarks> methods{
      marked("gated", "both", values), marked("gated", "kinect", values),
      marked("bilstm", "both", values), marked("bilstm", "kinect", values)};
  const auto tests = paired_tests(methods, "cm");
  REQUIRE(tests.size() == 4);
  for (const PairedTest& test : tests) {
    CHECK_FALSE((test.first == 0 && test.second == 3));
    CHECK_FALSE((test.first == 1 && test.second == 2));
    CHECK(test.p == 1.0);
  }
}

TEST_CASE("a mark that one method lacks, or only one person has, is not tested") {
  CHECK(paired_tests({marked("a", "", {1.0, 2.0}), MethodMarks{"b", ""}}, "cm").empty());
  CHECK(paired_tests({marked("a", "", {1.0, 2.0}), marked("b", "", {1.0})}, "cm").empty());
}
