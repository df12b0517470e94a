// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/models_html.h"

#include <doctest/doctest.h>

namespace kinalign {

namespace {

bool holds(const std::string& text, const std::string& piece) {
  return text.find(piece) != std::string::npos;
}

ModelsPage small_models_page() {
  ModelsPage page;
  page.name = "twin <1>";
  page.software = "kinalign";
  page.headline = "refine is nearest";
  page.marks.columns = {{"method", "method"}, {"position_cm", "position, cm", 2}};
  page.marks.rows = {{std::string("raw"), 6.871}};
  page.errors.curves = {{"raw", {2.0F, 4.0F}}, {"cnn", {1.0F, 1.0F}}};
  PosePictures absent;
  absent.id = "figure-9";
  absent.title = "Figure 9: the head";
  absent.absent = "no model with a node on the head was given";
  page.figures = {absent};
  return page;
}

}  // namespace

TEST_CASE("a page without moving bodies loads nothing and runs nothing") {
  const std::string html = models_html(small_models_page());
  CHECK(holds(html, "default-src 'none'"));
  CHECK_FALSE(holds(html, "<script"));
  CHECK_FALSE(holds(html, "http://"));
  CHECK_FALSE(holds(html, "https://"));
  CHECK_FALSE(holds(html, "{{"));
}

TEST_CASE("names are shown as text, and numbers as the table has them") {
  const std::string html = models_html(small_models_page());
  CHECK(holds(html, "<h1>twin &lt;1&gt;</h1>"));
  CHECK(holds(html, "<td>6.87</td>"));
  CHECK(holds(html, "<a href=\"#figure-9\">Figure 9</a>"));
}

TEST_CASE("a figure that could not be made says why") {
  CHECK(holds(models_html(small_models_page()), "no model with a node on the head was given"));
}

TEST_CASE("an error of 4 cm stands at the top of an axis that ends at 4 cm") {
  // Each value is drawn in the middle of its half second: at 0.25 s and 0.75 s of 1 s.
  CHECK(holds(models_html(small_models_page()),
              "<path class=\"c0\" d=\"M251.0 135.0L661.0 10.0\"/>"));
}

}  // namespace kinalign
