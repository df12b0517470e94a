// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/manifest.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <variant>

using namespace kinalign;

namespace {

/// What holds for any description: names as TOML writes them, none twice, one line each, and
/// defaults that the description itself allows.
void check_description(const Fields& fields) {
  std::set<std::string> names;
  for (const Field& field : fields) {
    CAPTURE(field.name);
    CHECK(names.insert(field.name).second);
    CHECK(field.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos);
    CHECK(!field.meaning.empty());
    CHECK(field.meaning.find('\n') == std::string::npos);
    CHECK(field.least < field.most);
    if (const auto* number = std::get_if<double*>(&field.value)) {
      CHECK(**number >= field.least);
      CHECK(**number <= field.most);
    }
    if (const auto* text = std::get_if<std::string*>(&field.value);
        text && !field.choices.empty()) {
      CHECK(std::count(field.choices.begin(), field.choices.end(), **text) == 1);
    }
  }
}

const Field& named(const Fields& fields, const std::string& name) {
  return *std::find_if(fields.begin(), fields.end(), [&](auto& f) { return f.name == name; });
}

}  // namespace

TEST_CASE("options are described with names that differ, and defaults that are allowed") {
  AlignOptions align;
  StreamOptions stream;
  SpaceOptions space;
  check_description(describe(align));
  check_description(describe(stream));
  check_description(describe(space));
}

TEST_CASE("a description leads to the option itself") {
  AlignOptions align;
  const Fields fields = describe(align);
  *std::get<double*>(named(fields, "gap_ms").value) = 250.0;
  *std::get<std::string*>(named(fields, "rotations").value) = "slerp";
  *std::get<bool*>(named(fields, "double").value) = true;
  CHECK(align.gap_ms == 250.0);
  CHECK(align.rotations == "slerp");
  CHECK(align.store_double);
}

TEST_CASE("what the paper gives are the defaults") {
  const SpaceOptions space;
  CHECK(space.rotation_y_deg == 60.0);
  CHECK(space.magnification == 1.0);
  CHECK(space.root == "SpineBase");
  CHECK(space.onto_root == "Hips");
}
