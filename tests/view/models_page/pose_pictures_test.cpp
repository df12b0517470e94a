// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/pose_pictures.h"

#include <doctest/doctest.h>

#include <limits>

namespace kinalign {

namespace {

/// A bone of a metre upwards, and one of half a metre to the person's left at its end.
StickFigure bent_stick(FigureColour colour) {
  return {colour, false, {0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.5F, 1.0F, 0.0F}, {-1, 0, 1}, {}};
}

PosePictures one_picture(StickFigure figure) {
  PosePictures out;
  out.columns = {{"standing", "take, 1 s"}};
  out.rows = {{"truth", {PosePicture{{std::move(figure)}, "0.0 cm"}}}};
  return out;
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("a picture shows a metre of height as 99 units, seen from 8 degrees above") {
  const std::string html = pictures_html(one_picture(bent_stick(FigureColour::truth)));
  // cos 8 deg = 0.990. The 0.5 m to the left are seen from 25 degrees beside: 0.5 cos 25 deg =
  // 0.453 wide, and 0.5 sin 25 deg nearer, which is drawn 0.029 lower.
  CHECK(html.find("<path class=\"mocap\" d=\"M0 99L0 0M0 0L45 3\"/>") != std::string::npos);
}

TEST_CASE("bones with a missing end are left out, those with an inferred end are dashed") {
  StickFigure figure = bent_stick(FigureColour::kinect);
  figure.states = {2, 2, 1};
  CHECK(pictures_html(one_picture(figure)).find("class=\"kinect dashed\"") != std::string::npos);
  figure.states = {2, 2, 0};
  const std::string html = pictures_html(one_picture(figure));
  CHECK(html.find("dashed") == std::string::npos);
  CHECK(html.find("d=\"M0 99L0 0\"") != std::string::npos);
}

TEST_CASE("all pictures of a table have one scale") {
  PosePictures pictures = one_picture(bent_stick(FigureColour::truth));
  StickFigure small = bent_stick(FigureColour::method);
  for (float& value : small.positions) value *= 0.5F;
  pictures.columns.emplace_back("waving", "take, 2 s");
  pictures.rows[0].second.push_back({{small}, "1.0 cm"});
  const std::string html = pictures_html(pictures);
  CHECK(count_of(html, "viewBox=\"-8 -8 61 115\"") == 2);
}

TEST_CASE("a joint that is no number is not drawn, and words can't leave their cell") {
  StickFigure figure = bent_stick(FigureColour::method);
  figure.positions[6] = std::numeric_limits<float>::quiet_NaN();
  PosePictures pictures = one_picture(figure);
  pictures.rows[0].first = "<script>";
  const std::string html = pictures_html(pictures);
  CHECK(html.find("nan") == std::string::npos);
  CHECK(html.find("<script>") == std::string::npos);
}

TEST_CASE("no rows give no text") { CHECK(pictures_html({}).empty()); }

}  // namespace kinalign
