// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/manifest.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <variant>

using namespace kinalign;

namespace {

/// Checks the rules of any description: names that TOML can write without quotes, no name twice, a
/// meaning of one line for each, and defaults that the description itself allows.
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

/// The addresses of all described options: no address twice, and all of them within `options`.
template <class Options>
std::set<const void*> described(Options& options) {
  std::set<const void*> places;
  for (const Field& field : describe(options)) {
    CAPTURE(field.name);
    const auto* place =
        std::visit([](auto* value) { return static_cast<const void*>(value); }, field.value);
    CHECK(std::greater_equal<>()(place, static_cast<const void*>(&options)));
    CHECK(std::less<>()(place, static_cast<const void*>(&options + 1)));
    CHECK(places.insert(place).second);
  }
  return places;
}

/// The number of these members that have a description.
template <class... Members>
std::size_t described_of(const std::set<const void*>& places, const Members&... members) {
  return (places.count(&members) + ...);
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

TEST_CASE("no option without a description, but for those that are tables of their own") {
  // If a member is added or removed, these names no longer fit and this does not compile: then its
  // description must be changed, too.
  AlignOptions align;
  auto& [reference, gap, rotations, store_double] = align;
  CHECK(described_of(described(align), reference, gap, rotations, store_double) == 4);
  StreamOptions stream;
  auto& [name, files, layout, skeleton, select, unit, up, rate, start, end, latency, clock, offset,
         drift, interval, mounting, root_node, lines] = stream;
  const auto of_stream = described(stream);
  CHECK(described_of(of_stream, name, files, lines) == 0);
  CHECK(described_of(of_stream, layout, skeleton, unit, up, rate, start, end, latency, clock,
                     offset, drift, interval, root_node, select, mounting) == 15);
  SpaceOptions space;
  auto& [method, onto, turn, magnification, rotation, translation, joints, root, onto_root,
         lines_of_space] = space;
  const auto of_space = described(space);
  CHECK(described_of(of_space, lines_of_space) == 0);
  CHECK(described_of(of_space, method, onto, turn, magnification, rotation, translation, joints,
                     root, onto_root) == 9);
}

TEST_CASE("a stream may have any name but those that are no group, or another thing, in a take") {
  for (const std::string name : {"mocap", "kinect 2", "H\xc3\xa4nde", "...", "time", "TIME_NS", " ",
                                 "a\\b", "valid", "report"}) {
    CAPTURE(name);
    CHECK(check_stream_name(name));
  }
  const auto refusal = [](const std::string& name) {
    const auto result = check_stream_name(name);
    return result ? "" : to_string(result.error());
  };
  const std::string expected = "expected a stream's name that can be a group of the take, found ";
  CHECK(refusal("") == expected + "an empty name");
  for (const std::string name : {"time_ns", "seconds", "t0_ns", "report_json", "parameters_json",
                                 ".", "..", "a/b", "/", "/mocap"}) {
    CHECK(refusal(name) == expected + "\"" + name + "\"");
  }
  CHECK(refusal(std::string("a\0b", 3)) == expected + "\"a?b\"");
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
