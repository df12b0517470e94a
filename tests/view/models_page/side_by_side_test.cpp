// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/side_by_side.h"

#include "kinalign/view/models_page/assets.h"
#include "kinalign/view/models_page/models_html.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

SideBySide two_bodies() {
  SideBySide out;
  out.caption = "take <1>";
  MovingBody truth{"truth", FigureColour::truth, {-1, 0}, {}, {}, {}};
  truth.positions = {0.0F, 1.0F, 0.0F, 0.0F, 1.5F, 0.0F, 0.1F, 1.0F, 0.0F, 0.1F, 1.5F, 0.0F};
  MovingBody kinect = truth;
  kinect.name = "Kinect </script>";
  kinect.colour = FigureColour::kinect;
  kinect.states = {2, 1, 2, 0};
  kinect.cm = {1.5F, 2.25F};
  out.bodies = {truth, kinect};
  return out;
}

}  // namespace

TEST_CASE("moving bodies are one JSON object that ends no script") {
  const std::string text = side_by_side_json(two_bodies());
  CHECK(text.find('<') == std::string::npos);
  const auto json = nlohmann::json::parse(text);
  const auto& kinect = json.at("bodies").at(1);
  CHECK(kinect.at("name") == "Kinect </script>");
  CHECK(kinect.at("colour") == "kinect");
  CHECK(kinect.at("positions").at("rows") == 2);
  CHECK(kinect.at("positions").at("columns") == 6);
  CHECK(kinect.at("states").at("columns") == 2);
  CHECK(kinect.at("cm").at("rows") == 2);
  CHECK_FALSE(json.at("bodies").at(0).contains("states"));
}

TEST_CASE("a page with moving bodies runs its own script alone, and loads nothing") {
  ModelsPage page;
  page.motion = two_bodies();
  const std::string html = models_html(page);
  if (models_script().empty()) {
    MESSAGE("skipped: no esbuild, so that the page has no script");
    return;
  }
  CHECK(html.find("id=\"motion-data\"") != std::string::npos);
  CHECK(html.find("take &lt;1&gt;") != std::string::npos);
  CHECK(html.find("default-src 'none'") != std::string::npos);
  CHECK(html.find("script-src 'sha256-") != std::string::npos);
  CHECK(html.find("https://") == std::string::npos);
  CHECK(models_html(ModelsPage{}).find("<script") == std::string::npos);
}

}  // namespace kinalign
