// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/inputs.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("two files are compared byte by byte, however short the reads are") {
  const FreshFolder folder;
  std::string text(5000, 'a');
  const std::string a = folder.write("a", text), b = folder.write("b", text);
  text[4321] = 'b';
  const std::string c = folder.write("c", text), longer = folder.write("d", text + "a");
  for (const std::size_t first : {0, 1, 7}) {
    CAPTURE(first);
    FaultyFiles files;
    files.first_read = first;
    CHECK_FALSE(first_difference(files, a, b).value());
    CHECK(first_difference(files, a, c).value() == 4321);
    CHECK(first_difference(files, c, longer).value() == 5000);
    CHECK(first_difference(files, longer, c).value() == 5000);
  }
}

TEST_CASE("notes do not make an exit code of 1, warnings and errors do") {
  CHECK(code_of({}) == 0);
  CHECK(code_of({{Severity::note, {}, "", ""}}) == 0);
  CHECK(code_of({{Severity::note, {}, "", ""}, {Severity::warning, {}, "", ""}}) == 1);
  CHECK(code_of({{Severity::error, {}, "", ""}}) == 1);
}

TEST_CASE("a fault of a recording is reported under the name that the user gave") {
  RecordingSurvey survey;
  const auto refusal = [&survey] {
    const auto manifest = recorded_manifest(survey, "t/take.mcap");
    REQUIRE_FALSE(manifest);
    return to_string(manifest.error());
  };
  CHECK(refusal() ==
        "t/take.mcap: expected a recording in which a message can be read, found none");
  survey.messages = 1;
  CHECK(refusal() ==
        "t/take.mcap: expected a recording by kinalign record, found another MCAP file");
  survey.facts.emplace();
  CHECK(refusal() == "t/take.mcap: expected data of at least one device, found none");
  CHECK(recorded_manifest(survey, "t/take.mcap").error().kind == ErrorKind::no_rows_in_recording);
}

TEST_CASE("errors about unknown joints and nodes say where names are listed") {
  const std::string advice = "kinalign info FILE -v lists the names of joints and nodes";
  CHECK(name_advice({"", 0, "any words", "any", ErrorKind::no_such_joint}) == advice);
  CHECK(name_advice({"", 0, "any words", "any", ErrorKind::no_such_node}) == advice);
  CHECK(name_advice({"", 0, "a joint of 'kinect' (known: Head)", "\"Nose\""}).empty());
}

TEST_CASE("paths are cut to what lies below their common folder, however they are spelt") {
  const auto cut = [](const std::vector<std::string>& paths) {
    Manifest manifest;
    for (const std::string& path : paths) {
      manifest.streams.emplace_back();
      manifest.streams.back().files = {{path, ""}};
    }
    std::string all = cut_common_folder(manifest) + ":";
    for (const StreamOptions& stream : manifest.streams) all += " " + stream.files[0].path;
    return all;
  };
  CHECK(cut({"m.bvh"}) == ": m.bvh");
  CHECK(cut({"Mueller/m.bvh"}) == "Mueller/: m.bvh");
  CHECK(cut({"a/b/m.bvh", "a/bc/k.csv"}) == "a/: b/m.bvh bc/k.csv");
  CHECK(cut({"a/m.bvh", "b/k.csv"}) == ": a/m.bvh b/k.csv");
  CHECK(cut({"../x/m.bvh", "../x/w.csv"}) == "../x/: m.bvh w.csv");
  CHECK(cut({"/y/k.csv"}) == "/y/: k.csv");
  CHECK(cut({"/y/k.csv", "/z/k.csv"}) == ": /y/k.csv /z/k.csv");
  const FreshFolder folder;
  for (const char* name : {"a", "b"})
    std::filesystem::create_directories(folder.path() + "/" + name);
  std::filesystem::create_directory_symlink(folder.path() + "/a", folder.path() + "/link");
  const std::string at = std::filesystem::canonical(folder.path()).string() + "/";
  const std::string near = std::filesystem::path(at).lexically_relative(
      std::filesystem::canonical(std::filesystem::current_path()));
  const std::string below = ": a/m.bvh b/k.csv";
  CHECK(cut({at + "a/m.bvh", at + "b/k.csv"}) == at + below);
  CHECK(cut({at + "link/m.bvh", near + "/b/../b/k.csv"}) == at + below);
  CHECK(cut({near + "/./a/m.bvh", near + "/a/../b/k.csv"}).ends_with("/" + below));
}
