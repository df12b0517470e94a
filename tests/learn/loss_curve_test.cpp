// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/loss_curve.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t out = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++out;
  }
  return out;
}

}  // namespace

TEST_CASE("loss curve: a line for the loss, and one for the judgements where there are any") {
  std::vector<TrainingPoint> points;
  for (int k = 1; k <= 5; ++k) {
    TrainingPoint one;
    one.step = 20 * k;
    one.loss = 1.0 / k;
    points.push_back(one);
  }
  const std::string alone = loss_curve(points, "refine");
  CHECK(count_of(alone, "<polyline") == 1);
  CHECK(count_of(alone, "refine") == 1);
  CHECK(alone.find(">100</text>") != std::string::npos);
  CHECK(alone.find(">0.2</text>") != std::string::npos);
  points.back().judgement = 3.5;
  CHECK(count_of(loss_curve(points, "refine"), "<polyline") == 2);
}

TEST_CASE("loss curve: no points, one point and a title with signs give a whole picture") {
  for (const std::vector<TrainingPoint>& points :
       {std::vector<TrainingPoint>{}, std::vector<TrainingPoint>{{1, 2.0, 0.0, 0.0, {}}}}) {
    const std::string picture = loss_curve(points, "a < b & c");
    CHECK(picture.starts_with("<svg "));
    CHECK(picture.ends_with("</svg>\n"));
    CHECK(picture.find("a &lt; b &amp; c") != std::string::npos);
    CHECK(picture.find("nan") == std::string::npos);
    CHECK(picture.find("inf") == std::string::npos);
  }
}
