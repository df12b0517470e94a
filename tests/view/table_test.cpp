// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/table.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace kinalign;

namespace {

Table heights() {
  Table table;
  table.caption = "People";
  table.columns = {{"id", "person"}, {"height_cm", "height, cm", 1}, {"frames", "frames"}};
  table.rows = {{std::string("09"), 155.0, std::int64_t{132'948}},
                {std::string("a|b,\"c\"_&"), {}, std::int64_t{-1'234'567}}};
  return table;
}

}  // namespace

TEST_CASE("a table as text has columns of one width, numbers at the right, thousands grouped") {
  CHECK(written(heights(), TableFormat::text) ==
        "People\n"
        "person     height, cm      frames\n"
        "09              155.0     132,948\n"
        "a|b,\"c\"_&           –  -1,234,567\n");
}

TEST_CASE("a table in Markdown and LaTeX shows its cells, whatever letters they have") {
  CHECK(written(heights(), TableFormat::markdown) ==
        "People\n\n"
        "| person | height, cm | frames |\n"
        "| --- | ---: | ---: |\n"
        "| 09 | 155.0 | 132,948 |\n"
        "| a\\|b,\"c\"\\_& | – | -1,234,567 |\n");
  const std::string latex = written(heights(), TableFormat::latex);
  CHECK(latex.find("\\begin{tabular}{lrr}") != std::string::npos);
  CHECK(latex.find("a|b,\"c\"\\_\\& & – & -1,234,567 \\\\") != std::string::npos);
}

TEST_CASE("a table in CSV and JSON has its keys and every digit") {
  CHECK(written(heights(), TableFormat::csv) ==
        "id,height_cm,frames\n09,155,132948\n\"a|b,\"\"c\"\"_&\",,-1234567\n");
  const auto json = nlohmann::json::parse(written(heights(), TableFormat::json));
  REQUIRE(json.size() == 2);
  CHECK(json[0] == nlohmann::json{{"id", "09"}, {"height_cm", 155.0}, {"frames", 132'948}});
  CHECK(json[1]["height_cm"].is_null());
}

TEST_CASE("a sum stands below a line in LaTeX") {
  Table table = heights();
  table.has_sum = true;
  const std::string latex = written(table, TableFormat::latex);
  CHECK(latex.find("132,948 \\\\\n\\hline\na|b") != std::string::npos);
}
