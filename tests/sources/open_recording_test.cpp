// SPDX-License-Identifier: Apache-2.0
// Which files a recording consists of, and the names by which a take refers to them.
#include "kinalign/sources/open_recording.h"

#include "tests/folder.h"

#include "kinalign/documents/parameters_json.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

const std::string layout_text =
    "name = \"lab\"\nheader = false\nrate_hz = 10\n[joints]\nnames = [\"a\"]\n"
    "fields = [\"x\", \"y\", \"z\"]\n";

StreamOptions stream(const std::string& name, const std::string& path) {
  StreamOptions out;
  out.name = name;
  out.files = {{path, ""}};
  out.layout = "lab.toml";
  return out;
}

std::vector<std::string> names_of(const RecordedStream& stream) {
  std::vector<std::string> out;
  for (const InputFacts& facts : stream.files) out.push_back(facts.name);
  return out;
}

std::string error_of(const Result<Recording>& recording) {
  return recording ? "none" : to_string(recording.error());
}

}  // namespace

TEST_CASE("a user's layout is one of a stream's files, with its hash") {
  const FreshFolder folder;
  folder.write("lab.toml", layout_text);
  folder.write("p.csv", "1,2,3\n");
  Manifest manifest;
  manifest.streams = {stream("points", "p.csv")};
  PosixFiles files;
  const auto first = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(first, error_of(first));
  REQUIRE(names_of(first->streams[0]) == std::vector<std::string>{"p.csv", "lab.toml"});
  CHECK(first->streams[0].files[1].bytes == layout_text.size());
  folder.write("lab.toml", layout_text + "metres_per_unit = 0.5\n");
  const auto second = open_recording(files, manifest, folder.path() + "/");
  CHECK(error_of(second) != "none");  // the key comes after [joints]
  folder.write("lab.toml", "metres_per_unit = 0.5\n" + layout_text);
  const auto third = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(third, error_of(third));
  CHECK(third->streams[0].files[1].sha256 != first->streams[0].files[1].sha256);
}

TEST_CASE("a user's layout has to stay as it was when it was read") {
  const FreshFolder folder;
  const std::string layout = folder.write("lab.toml", layout_text);
  folder.write("p.csv", "1,2,3\n");
  Manifest manifest;
  manifest.streams = {stream("points", "p.csv")};
  PosixFiles files;
  const auto recording = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  const auto& passes = std::get<PointInput>(recording->streams[0].data).passes;
  CHECK(passes());
  folder.write("lab.toml", "metres_per_unit = 0.5\n" + layout_text);
  const auto again = passes();
  REQUIRE_FALSE(again);
  CHECK(to_string(again.error()) ==
        layout + ": expected a file that does not change while it is read, found a changed file");
}

TEST_CASE("a stream says what it was read as, and whether its stamps are counted") {
  const FreshFolder folder;
  folder.write("lab.toml", layout_text);
  folder.write("counted.csv", "1,2,3\n4,5,6\n");
  folder.write("stamped.csv", "time_ns,qw,qx,qy,qz\n0,1,0,0,0\n10,1,0,0,0\n");
  folder.write("stuck.csv", "time_ns,qw,qx,qy,qz\n0,1,0,0,0\n0,1,0,0,0\n0,1,0,0,0\n");
  Manifest manifest;
  manifest.streams = {stream("points", "counted.csv"), stream("imu", "stamped.csv"),
                      stream("stuck", "stuck.csv")};
  manifest.streams[1].layout = manifest.streams[2].layout = "";
  manifest.streams[2].rate_hz = 15.0;
  PosixFiles files;
  const auto recording = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  CHECK(recording->streams[0].format == "lab");
  CHECK(recording->streams[0].counted);
  CHECK(recording->streams[1].format == "imu");
  CHECK_FALSE(recording->streams[1].counted);
  CHECK(recording->streams[2].counted);
}

TEST_CASE("files of one stream share an axis: start_ns is the earliest sample's of all") {
  const FreshFolder folder;
  folder.write("waist.csv", "time_ns,qw,qx,qy,qz\n50,1,0,0,0\n60,1,0,0,0\n");
  folder.write("wrist.csv", "time_ns,qw,qx,qy,qz\n40,1,0,0,0\n70,1,0,0,0\n");
  Manifest manifest;
  manifest.streams = {stream("imu", "waist.csv")};
  manifest.streams[0].files = {{"waist.csv", "waist"}, {"wrist.csv", "wrist"}};
  manifest.streams[0].layout = "";
  manifest.streams[0].start_ns = 1000;
  manifest.streams[0].offset_ms = 0.001;
  PosixFiles files;
  auto recording = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  const auto start = [&](std::size_t i) {
    return to_ns(take_time(recording->streams[i].clock, recording->streams[i].survey.first));
  };
  CHECK(start(0) == 2010);
  CHECK(start(1) == 2000);
  manifest.streams[0].start_ns = 3'999'999'999'999'999'999;
  CHECK(error_of(open_recording(files, manifest, folder.path() + "/"))
            .find("expected a stamp inside +-4e18 ns, found 60 ns, to be moved by") !=
        std::string::npos);
}

TEST_CASE("a layout that the program carries is no file") {
  const FreshFolder folder;
  folder.write("k.csv", "time_ns,qw,qx,qy,qz\n1,1,0,0,0\n2,1,0,0,0\n");
  Manifest manifest;
  manifest.streams = {stream("imu", "k.csv")};
  manifest.streams[0].layout = "imu";
  PosixFiles files;
  const auto recording = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  CHECK(names_of(recording->streams[0]) == std::vector<std::string>{"k.csv"});
}

TEST_CASE("a layout that several nodes' files share is named once") {
  const FreshFolder folder;
  folder.write("lab.toml",
               "name = \"lab\"\nkind = \"imu\"\nheader = false\nrate_hz = 10\n[nodes]\n"
               "fields = [\"ax\", \"ay\", \"az\"]\n");
  folder.write("w.csv", "1,2,3\n");
  folder.write("l.csv", "1,2,4\n");
  Manifest manifest;
  manifest.streams = {stream("imu", "w.csv")};
  manifest.streams[0].files = {{"w.csv", "waist"}, {"l.csv", "left"}};
  PosixFiles files;
  const auto recording = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  REQUIRE(recording->streams.size() == 2);
  CHECK(names_of(recording->streams[0]) == std::vector<std::string>{"w.csv", "lab.toml"});
  CHECK(names_of(recording->streams[1]) == std::vector<std::string>{"l.csv"});
}

TEST_CASE("files are remembered by their paths below the manifest, else by their names alone") {
  const FreshFolder folder;
  folder.write("lab.toml", layout_text);
  folder.write("m/a/p.csv", "1,2,3\n");
  folder.write("m/b/p.csv", "4,5,6\n");
  folder.write("out/q.csv", "7,8,9\n");
  Manifest manifest;
  manifest.streams = {stream("one", "a/p.csv"), stream("two", "b/p.csv"),
                      stream("three", "../out/q.csv"), stream("four", folder / "out/q.csv"),
                      stream("five", "./b/../a/./p.csv")};
  for (StreamOptions& each : manifest.streams) each.layout = "../lab.toml";
  PosixFiles files;
  const auto recording = open_recording(files, manifest, (folder / "m") + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  const auto& streams = recording->streams;
  CHECK(names_of(streams[0]) == std::vector<std::string>{"a/p.csv", "lab.toml"});
  CHECK(names_of(streams[1]) == std::vector<std::string>{"b/p.csv", "lab.toml"});
  CHECK(names_of(streams[2]) == std::vector<std::string>{"q.csv", "lab.toml"});
  CHECK(names_of(streams[3]) == std::vector<std::string>{"q.csv", "lab.toml"});
  CHECK(names_of(streams[4]) == std::vector<std::string>{"a/p.csv", "lab.toml"});
}

TEST_CASE("files of one name that lie elsewhere are remembered with the folders that differ") {
  const FreshFolder folder;
  folder.write("m/lab.toml", layout_text);
  folder.write("a/x/p.csv", "1,2,3\n");
  folder.write("b/x/p.csv", "4,5,6\n");
  Manifest manifest;
  manifest.streams = {stream("one", "../a/x/p.csv"), stream("two", folder / "b/x/p.csv")};
  PosixFiles files;
  const auto recording = open_recording(files, manifest, (folder / "m") + "/");
  REQUIRE_MESSAGE(recording, error_of(recording));
  CHECK(names_of(recording->streams[0]) == std::vector<std::string>{"a/x/p.csv", "lab.toml"});
  CHECK(names_of(recording->streams[1]) == std::vector<std::string>{"b/x/p.csv", "lab.toml"});
  const Manifest remembered = without_folders(manifest);
  CHECK(remembered.streams[0].files[0].path == "a/x/p.csv");
  CHECK(remembered.streams[1].files[0].path == "b/x/p.csv");
}

TEST_CASE("two files that a take would call by one name are refused with both paths") {
  const FreshFolder folder;
  folder.write("m/lab.toml", layout_text);
  folder.write("p.csv", "1,2,3\n");
  folder.write("b/p.csv", "4,5,6\n");
  Manifest manifest;
  manifest.streams = {stream("one", "../p.csv"), stream("two", "../b/p.csv")};
  PosixFiles files;
  const std::string base = (folder / "m") + "/";
  CHECK(error_of(open_recording(files, manifest, base)) ==
        base +
            "../b/p.csv: expected files that a take can tell apart by name (below the manifest's "
            "folder: by their paths), so rename one or move both there, found 'p.csv' again: " +
            base + "../p.csv");
  folder.write("b/p.csv", "1,2,3\n");  // the same bytes, so either is right for `rebuild`
  CHECK(error_of(open_recording(files, manifest, base)) == "none");
}

TEST_CASE("what a user calls a subject, a stream or a node has to be UTF-8 as well") {
  const FreshFolder folder;
  folder.write("lab.toml", layout_text);
  folder.write("p.csv", "1,2,3\n");
  PosixFiles files;
  const auto opened = [&](const Manifest& manifest) {
    return error_of(open_recording(files, manifest, folder.path() + "/"));
  };
  Manifest manifest;
  manifest.streams = {stream("one", "p.csv")};
  CHECK(opened(manifest) == "none");
  for (const auto& change :
       {+[](Manifest& m) { m.subject = "\xff"; }, +[](Manifest& m) { m.action = "\xff"; },
        +[](Manifest& m) { m.streams[0].name = "\xff"; },
        +[](Manifest& m) { m.streams[0].files[0].node = "\xff"; }}) {
    Manifest wrong = manifest;
    change(wrong);
    CHECK(opened(wrong).starts_with("expected subject, action and names in UTF-8"));
  }
}

TEST_CASE("a file whose name is no UTF-8 is refused, since no take can hold it") {
  const FreshFolder folder;
  folder.write("lab.toml", layout_text);
  folder.write("M\xfcller.csv", "1,2,3\n");
  Manifest manifest;
  manifest.streams = {stream("one", "M\xfcller.csv")};
  PosixFiles files;
  const std::string error = error_of(open_recording(files, manifest, folder.path() + "/"));
  CHECK(error.find("expected a file name in UTF-8") != std::string::npos);
}
