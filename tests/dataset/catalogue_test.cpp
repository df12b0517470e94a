// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/catalogue.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

std::string fault_of(const std::string& toml) {
  const auto read = read_catalogue(toml, "dataset.toml");
  return read ? "" : to_string(read.error());
}

}  // namespace

TEST_CASE("the template of HFUT-MMD has the paper's people, classes and number of actions") {
  const auto text = catalogue_template("hfut-mmd", "a \"b\" \\ c");
  REQUIRE(text);
  const auto made = read_catalogue(*text, "dataset.toml");
  if (!made) FAIL(to_string(made.error()));
  CHECK(made->name == "a \"b\" \\ c");
  CHECK(made->subjects.size() == 12);
  CHECK(std::count_if(made->subjects.begin(), made->subjects.end(),
                      [](const Subject& s) { return s.sex == "f"; }) == 4);
  CHECK(find_subject(*made, "09")->height_cm == 155.0);
  CHECK(made->classes.size() == 6);
  CHECK(made->actions.size() == 34);
  CHECK(find_action(*made, "S2A08")->class_id == "S2");
}

TEST_CASE("the empty template reads, and an unknown one is named") {
  CHECK(read_catalogue(*catalogue_template("empty", "x"), "dataset.toml"));
  CHECK_FALSE(catalogue_template("hfut", "x"));
}

TEST_CASE("facts about people and devices are read with their units") {
  const auto made = read_catalogue(
      "name = \"x\"\n[subject.01]\nsex = \"f\"\nheight_cm = 165.5\nhandedness = \"left\"\n"
      "consent = \"form 12\"\nsegments_m = { upper_arm_left = 0.31 }\n"
      "[device.kinect]\nmodel = \"v2\"\n[align]\ngap_ms = 50\n",
      "dataset.toml");
  REQUIRE(made);
  const Subject& person = made->subjects.front();
  CHECK(person.height_cm == 165.5);
  CHECK_FALSE(person.weight_kg);
  CHECK(person.segments_m.at("upper_arm_left") == 0.31);
  CHECK(made->devices.front().texts.at("model") == "v2");
  CHECK(made->align.gap_ms == 50.0);
}

TEST_CASE("a fault in dataset.toml is reported with its line and the nearest key") {
  CHECK(fault_of("name = \"x\"\nlicense = \"MIT\"\n").find("dataset.toml:2: ") == 0);
  CHECK(fault_of("license = \"MIT\"\n").find("licence") != std::string::npos);
  CHECK(fault_of("[subject.01]\nheigth_cm = 3\n").find("height_cm") != std::string::npos);
  CHECK(fault_of("[subject.01]\nheight_cm = 1.65\n").find("dataset.toml:2") == 0);
  CHECK(fault_of("[subject.\"a b\"]\nsex = \"f\"\n").find("letters and digits") !=
        std::string::npos);
  CHECK(fault_of("[class.S1]\n[action.S1A01]\nclass = \"S9\"\n").find("dataset.toml:2") == 0);
  CHECK(fault_of("[action.S1A01]\nname = \"walk\"\n").find("class in [action.S1A01]") !=
        std::string::npos);
}
