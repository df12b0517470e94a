// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/parameters_json.h"

#include "kinalign/documents/report_json.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

using namespace kinalign;

namespace {

using Random = std::mt19937_64;

std::string any_text(Random& random) {
  const std::string letters = "abc \"\\/{}[]:,\n\t#.=\xc3\xa4";
  std::string out;
  for (std::uint64_t n = random() % 12; n > 0; --n) {
    const char c = letters[random() % (letters.size() - 2)];
    out += c;
    if (random() % 8 == 0) out += "\xc3\xa4";
  }
  return out;
}

std::map<std::string, std::string> any_map(Random& random) {
  std::map<std::string, std::string> out;
  for (std::uint64_t n = random() % 4; n > 0; --n) out[any_text(random)] = any_text(random);
  return out;
}

std::vector<double> any_numbers(std::size_t count, Random& random) {
  std::vector<double> out(count);
  for (double& x : out) x = std::ldexp(static_cast<double>(random()), -70);
  return out;
}

std::vector<double> any_rotation(Random& random) {
  auto out = any_numbers(4, random);  // each below 1/64
  out[random() % 4] += random() % 2 == 0 ? 1.0 : -1.0;
  return out;
}

/// Sets every described option to a random allowed value.
void fill(const Fields& fields, Random& random) {
  for (const Field& field : fields) {
    std::uniform_real_distribution<double> range(std::max(field.least, -1e9),
                                                 std::min(field.most, 1e9));
    std::visit(
        [&](auto* to) {
          using Value = std::remove_pointer_t<decltype(to)>;
          if constexpr (std::is_same_v<Value, bool>) *to = random() % 2 == 0;
          if constexpr (std::is_same_v<Value, double>) *to = range(random);
          if constexpr (std::is_same_v<Value, std::optional<double>>) {
            if (random() % 2 == 0) *to = range(random);
          }
          if constexpr (std::is_same_v<Value, std::optional<std::int64_t>>) {
            if (random() % 2 == 0) *to = static_cast<std::int64_t>(random() >> 3);
          }
          if constexpr (std::is_same_v<Value, std::string>) {
            *to = field.choices.empty() ? any_text(random)
                                        : field.choices[random() % field.choices.size()];
          }
        },
        field.value);
  }
}

Manifest any_manifest(std::uint64_t seed) {
  Random random(seed);
  Manifest out;
  out.subject = any_text(random);
  out.action = any_text(random);
  fill(describe(out.align), random);
  for (std::uint64_t n = random() % 4; n > 0; --n) {
    StreamOptions& stream = out.streams.emplace_back();
    stream.name = any_text(random);
    stream.select = any_map(random);
    for (const auto& [node, unused] : any_map(random)) stream.mounting[node] = any_rotation(random);
    fill(describe(stream), random);
    for (std::uint64_t f = random() % 3; f > 0; --f) {
      stream.files.push_back({any_text(random), any_text(random)});
    }
  }
  for (std::uint64_t n = random() % 3; n > 0; --n) {
    SpaceOptions& space = out.spaces[any_text(random)];
    fill(describe(space), random);
    if (random() % 2 == 0) space.rotation = any_rotation(random);
    if (random() % 2 == 0) space.translation = any_numbers(3, random);
    space.joints = any_map(random);
  }
  return out;
}

std::string error_of(const std::string& json) {
  const auto manifest = parse_parameters_json(json);
  return manifest ? "none" : to_string(manifest.error());
}

std::string with_schema(const std::string& rest) {
  return R"({"schema": "kinalign.parameters/1", )" + rest + "}";
}

}  // namespace

TEST_CASE("any manifest comes back from its JSON, every number exactly") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    const Manifest manifest = without_folders(any_manifest(seed));
    const std::string json = parameters_json(manifest);
    const auto back = parse_parameters_json(json);
    REQUIRE_MESSAGE(back, (back ? "" : to_string(back.error())));
    REQUIRE(parameters_json(*back) == json);
    CHECK(back->align.gap_ms == manifest.align.gap_ms);
    REQUIRE(back->streams.size() == manifest.streams.size());
    for (std::size_t i = 0; i < manifest.streams.size(); ++i) {
      CHECK(back->streams[i].name == manifest.streams[i].name);
      CHECK(back->streams[i].start_ns == manifest.streams[i].start_ns);
      CHECK(back->streams[i].interval_ms == manifest.streams[i].interval_ms);
      CHECK(back->streams[i].select == manifest.streams[i].select);
      CHECK(back->streams[i].mounting == manifest.streams[i].mounting);
    }
    for (const auto& [name, space] : manifest.spaces) {
      CHECK(back->spaces.at(name).rotation == space.rotation);
      CHECK(back->spaces.at(name).translation == space.translation);
      CHECK(back->spaces.at(name).joints == space.joints);
    }
  }
}

TEST_CASE("parameters with unknown keys, wrong types or wild values are refused") {
  CHECK(error_of("{") == "expected parameters as JSON, found {");
  CHECK(error_of("[]") == "expected parameters as a table, found a list");
  CHECK(error_of("{}") == "expected schema kinalign.parameters/1, found none");
  CHECK(error_of(std::string(100'000, '[')) ==
        "expected parameters as JSON, found too many brackets");
  CHECK(error_of(with_schema(R"("sub": "")")) ==
        "expected a known key (nearest: subject), found \"sub\"");
  CHECK(error_of(with_schema(R"("align": {"gap": 3})")) ==
        "expected a key of [align] (nearest: gap_ms), found \"gap\"");
  CHECK(error_of(with_schema(R"("align": {"gap_ms": null})")) ==
        "expected align.gap_ms as a number from 0 to 86400000, found null");
  CHECK(error_of(with_schema(R"("align": {"gap_ms": 1e300})")) ==
        "expected align.gap_ms as a number from 0 to 86400000, found 1e+300");
  CHECK(error_of(with_schema(R"("streams": [{"start_ns": 18446744073709551615}])")) ==
        "expected streams[0].start_ns as a whole number from -4e+18 to 4e+18, found "
        "1.8446744073709552e+19");
  CHECK(error_of(with_schema(R"("streams": [{"files": [{"path": 3}]}])")) ==
        "expected streams[0].files[0].path as a text, found 3");
}

TEST_CASE("each value of the parameters has its type, and the message its place") {
  const std::vector<std::array<std::string, 2>> refused{
      {R"("subject": 3)", "subject as a text, found 3"},
      {R"("streams": {})", "streams as a list, found a table"},
      {R"("streams": [[]])", "streams[0] as a table, found a list"},
      {R"("streams": [{}, {"name": null}])", "streams[1].name as a text, found null"},
      {R"("streams": [{"files": "a"}])", "streams[0].files as a list, found \"a\""},
      {R"("streams": [{"files": ["a"]}])", "streams[0].files[0] as a table, found \"a\""},
      {R"("streams": [{"files": [{"nod": "a"}]}])",
       "a key of [streams[0].files[0]] (nearest: node), found \"nod\""},
      {R"("streams": [{"select": {"id": 1.5}}])", "streams[0].select.id as a text, found 1.5"},
      {R"("streams": [{"mounting": {"w": 1}}])",
       "streams[0].mounting.w as a list of 4 numbers, found 1"},
      {R"("streams": [{"mounting": {"w": [1, 0, 0, "0"]}}])",
       "streams[0].mounting.w as a list of 4 numbers, found \"0\""},
      {R"("streams": [{"up": {}}])", "streams[0].up as one of \"\", y, z, found a table"},
      {R"("streams": [{"clock": ["shared", 3]}])",
       "streams[0].clock as one of shared, unknown, found a list"},
      {R"("spaces": [])", "spaces as a table, found a list"},
      {R"("spaces": {"k": 3})", "spaces.k as a table, found 3"},
      {R"("spaces": {"k": {"joints": []}})", "spaces.k.joints as a table, found a list"},
      {R"("spaces": {"k": {"root": null}})", "spaces.k.root as a text, found null"},
      {R"("align": "fast")", "align as a table, found \"fast\""}};
  for (const auto& [rest, message] : refused) {
    CAPTURE(rest);
    CHECK(error_of(with_schema(rest)) == "expected " + message);
  }
  CHECK(error_of("") == "expected parameters as JSON, found an empty text");
  CHECK(error_of(with_schema(R"("streams": [{"start_ns": null, "interval_ms": null}])")) == "none");
  CHECK(error_of(with_schema(R"("spaces": {"k": {"rotation": [], "translation": []}})")) == "none");
}

TEST_CASE("paths that lead out of the inputs' folder are refused: the take may be a stranger's") {
  for (const std::string path : {"/etc/hosts", "../k.csv", "a/../../k.csv"}) {
    CHECK(error_of(with_schema(R"("streams": [{"files": [{"path": ")" + path + R"("}]}])")) ==
          "expected a path below the folder of the inputs, found '" + path + "'");
  }
}

TEST_CASE("parameters whose rotations or translations are none are refused") {
  CHECK(
      error_of(with_schema(R"("streams": [{"mounting": {"waist": [0, 0, 0, 3]}}])")) ==
      "expected streams[0].mounting.waist as w,x,y,z of a length from 0.5 to 2, found a length of "
      "3");
  CHECK(error_of(with_schema(R"("streams": [{"mounting": {"waist": []}}])")) ==
        "expected streams[0].mounting.waist as a list of 4 numbers, found 0 numbers");
  CHECK(error_of(with_schema(R"("streams": [{"mounting": []}])")) ==
        "expected streams[0].mounting as a table, found a list");
  CHECK(error_of(with_schema(R"("spaces": {"k": {"rotation": [1, 0]}})")) ==
        "expected spaces.k.rotation as a list of 4 numbers, found 2 numbers");
  CHECK(error_of(with_schema(R"("spaces": {"k": {"translation": [1, 0]}})")) ==
        "expected spaces.k.translation as a list of 3 numbers, found 2 numbers");
}

TEST_CASE("of paths only what stays in the manifest's folder is kept") {
  Manifest manifest;
  manifest.streams.resize(1);
  manifest.streams[0].layout = "/opt/odd.toml";
  manifest.streams[0].files = {
      {"/home/a/walk.bvh", ""}, {"../b/k.csv", ""}, {"imu/w.csv", ""}, {"x/../../y.csv", ""}};
  const Manifest kept = without_folders(manifest);
  CHECK(kept.streams[0].layout == "odd.toml");
  CHECK(kept.streams[0].files[0].path == "walk.bvh");
  CHECK(kept.streams[0].files[1].path == "k.csv");
  CHECK(kept.streams[0].files[2].path == "imu/w.csv");
  CHECK(kept.streams[0].files[3].path == "y.csv");
}

TEST_CASE("a report's JSON has its schema, units in the names, and whole findings") {
  AlignmentReport report;
  report.frames = 2;
  report.begin = utc_time(5);
  report.reference = "mocap";
  report.spaces.push_back({});
  report.spaces[0].stream = "kinect";
  report.spaces[0].transform.translation = {1, 2, 3};
  report.findings.push_back(
      {Severity::warning, {"walk.bvh", 12, "2 frames", "1"}, "one frame is used", "none needed"});
  const std::string json = report_json(report);
  for (const char* part :
       {"\"schema\": \"kinalign.report/1\"", "\"frames\": 2", "\"begin_ns\": 5",
        "\"severity\": \"warning\"", "\"file\": \"walk.bvh\"", "\"line\": 12",
        "\"expected\": \"2 frames\"", "\"found\": \"1\"", "\"meaning\": \"one frame is used\"",
        "\"repair\": \"none needed\"", "\"translation_m\"", "\"after_m\": 0.0"}) {
    CAPTURE(part);
    CHECK(json.find(part) != std::string::npos);
  }
  CHECK(report_json(report) == json);
}
