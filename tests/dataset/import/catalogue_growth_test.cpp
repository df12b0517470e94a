// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/catalogue_growth.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

const CatalogueNeeds needs{{"01", "02"},
                           {{"s", "sports"}, {"unused", "never"}},
                           {{"golf", "s", "a \"long\" swing"}, {"run", "s", ""}}};

}  // namespace

TEST_CASE("missing entries are appended, and the user's text is kept") {
  const std::string own = "name = \"x\"  # mine\n[subject.02]\nsex = \"f\"";
  const auto grown = grown_catalogue(own, "dataset.toml", needs);
  REQUIRE(grown);
  CHECK(*grown ==
        own +
            "\n\n[subject.01]\n\n[class.s]\nname = \"sports\"\n\n[action.golf]\nclass = "
            "\"s\"\nname = \"a \\\"long\\\" swing\"\n\n[action.run]\nclass = \"s\"\nname = "
            "\"\"\n");
  CHECK(grown_catalogue(*grown, "dataset.toml", needs) == *grown);
}

TEST_CASE("a text that can't grow at its end is an error, and so is one that can't be read") {
  const auto grown = grown_catalogue("subject = { 05 = { } }\n", "dataset.toml", needs);
  REQUIRE_FALSE(grown);
  CHECK(
      to_string(grown.error()).starts_with("dataset.toml: expected a file to which [subject.ID]"));
  CHECK_FALSE(grown_catalogue("subjects = 1\n", "dataset.toml", needs));
}
