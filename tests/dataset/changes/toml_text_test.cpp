// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/toml_text.h"

#include "kinalign/documents/manifest_toml.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("an id is renamed in each head of its table, however it is spelled, and nowhere else") {
  const std::string toml =
      "name = \"03\"\ndescription = \"[subject.03] is tall\"\n[ subject . \"03\" ] # 03\nsex = "
      "\"m\"\n"
      "\t[subject.03.segments_m]\nshin = 0.4\n[subject.031]\n[class.S1]\n[action.03]\nclass = "
      "\"S1\"\n";
  const auto edited = with_id_renamed(toml, "subject", "03", "13", "dataset.toml");
  REQUIRE(edited);
  CHECK(*edited ==
        "name = \"03\"\ndescription = \"[subject.03] is tall\"\n[ subject . \"13\" ] # 03\nsex = "
        "\"m\"\n"
        "\t[subject.13.segments_m]\nshin = 0.4\n[subject.031]\n[class.S1]\n[action.03]\nclass = "
        "\"S1\"\n");
  const auto action = with_id_renamed(toml, "action", "03", "A3", "dataset.toml");
  REQUIRE(action);
  CHECK(action->find("[action.A3]") != std::string::npos);
}

TEST_CASE("an id that stands in another form, or in a text of several lines, is left to the user") {
  for (const char* toml : {"[subject]\n03 = { sex = \"m\" }\n", "subject.03.sex = \"m\"\n",
                           "description = \"\"\"\n[subject.03]\n\"\"\"\n[subject.03]\n"}) {
    const auto edited = with_id_renamed(toml, "subject", "03", "13", "dataset.toml");
    REQUIRE(!edited);
    CHECK(to_string(edited.error()) ==
          "dataset.toml: expected [subject.03] as the head of a table, so that it can become "
          "[subject.13], found another form; change the id there by hand, then run the command "
          "again");
  }
}

TEST_CASE("a manifest keeps its comments, and loses them rather than change its meaning") {
  const TakeName from{"03", "S1A01", 1}, to{"13", "S1A02", 4};
  const std::string plain =
      "subject = '03' # who\naction=\"S1A01\"\n[stream.mocap]\nfile = "
      "\"../sourcedata/sub-03/sub-03_task-S1A01_run-01/a.bvh\" # suit\nstart_ns = 3\n";
  const auto edited = manifest_of_renamed(plain, from, to, "m.toml");
  REQUIRE(edited);
  CHECK(*edited ==
        "subject = \"13\" # who\naction=\"S1A02\"\n[stream.mocap]\nfile = "
        "\"../sourcedata/sub-13/sub-13_task-S1A02_run-04/a.bvh\" # suit\nstart_ns = 3\n");
  const std::string odd = "subject = \"\"\"03\"\"\" # who\n[stream.mocap]\nfile = \"a.bvh\"\n";
  const auto anew = manifest_of_renamed(odd, from, to, "m.toml");
  REQUIRE(anew);
  const auto read = read_manifest(*anew, "m.toml");
  REQUIRE(read);
  CHECK(read->subject == "13");
  CHECK(read->action == "");
  CHECK(anew->find("# who") == std::string::npos);
}
