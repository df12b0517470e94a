// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/shown_file.h"

#include "tests/folder.h"
#include "tests/formats/xdf/xdf_cases.h"
#include "tests/mcap/mcap_files.h"
#include "tests/take/recorded.h"

#include "kinalign/view/show_recording.h"
#include "kinalign/view/show_xdf.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

constexpr std::uint32_t most_channels = 65'535;

/// An XDF file of `n` streams with one sample each.
std::string xdf_of(std::uint32_t n) {
  std::string bytes = xdf_begin;
  for (std::uint32_t id = 1; id <= n; ++id) {
    bytes += xdf_header(id, "int8", 1) + xdf_samples(id, 1, xdf_sample(1.0, "a"));
  }
  return bytes;
}

/// A file of JSON channels with a message on each: one for every channel number of MCAP.
std::string mcap_of_all_channels() {
  MemoryFile file;
  McapWriter writer(file.store());
  REQUIRE(writer.begin({"", "test"}));
  McapChunkContent chunk;
  chunk.add(McapSchema{1, "note", "jsonschema", "{}"});
  for (std::uint32_t id = 0; id <= most_channels; ++id) {
    const auto channel = static_cast<std::uint16_t>(id);
    chunk.add(McapChannel{channel, 1, "/" + std::to_string(id), "json", {}});
    chunk.add(McapMessage{channel, 0, 1000 + id, 1000 + id, "{}"});
  }
  REQUIRE(writer.write(store(chunk, McapCompression::none)));
  REQUIRE(writer.finish());
  return file.bytes;
}

}  // namespace

TEST_CASE("a file to look at has as many channels as MCAP has numbers, and no more") {
  const FreshFolder folder;
  PosixFiles files;
  OutputFile out = *OutputFile::create(files, folder / "shown.mcap", Overwrite::no);
  ShownFile shown(out);
  REQUIRE(shown.begin());
  for (std::uint32_t n = 1; n <= most_channels; ++n) {
    const auto id = shown.add_channel("/" + std::to_string(n), {0, "note", "jsonschema", "{}"});
    REQUIRE(id);
    REQUIRE(*id == n);
  }
  const auto further = shown.add_channel("/more", {0, "note", "jsonschema", "{}"});
  REQUIRE(!further);
  CHECK(to_string(further.error()) ==
        folder / "shown.mcap" + ": expected at most 65535 channels, found more");
}

TEST_CASE("schemas of one name are written once") {
  const FreshFolder folder;
  PosixFiles files;
  OutputFile out = *OutputFile::create(files, folder / "shown.mcap", Overwrite::no);
  ShownFile shown(out);
  REQUIRE(shown.begin());
  for (const char* schema : {"a", "b", "a"}) {
    const auto id = shown.add_channel("/topic", {0, schema, "jsonschema", "{}"});
    REQUIRE(id);
    REQUIRE(shown.add(*id, utc_time(1), utc_time(1), "{}"));
  }
  REQUIRE(shown.finish());
  REQUIRE(out.commit());
  std::vector<std::uint16_t> schemas;
  for (const McapRecord& record : read_mcap(folder.read("shown.mcap")).records) {
    if (const auto* channel = std::get_if<McapChannel>(&record)) {
      if (schemas.size() < 3) schemas.push_back(channel->schema_id);
    }
  }
  CHECK(schemas == std::vector<std::uint16_t>{1, 2, 1});
}

TEST_CASE("an XDF of more streams than MCAP has channels is refused, and leaves nothing behind") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder.write("many.xdf", xdf_of(most_channels + 1));
  const auto shown = show_xdf(files, path, folder / "many.mcap", Overwrite::no);
  REQUIRE(!shown);
  CHECK(to_string(shown.error()) ==
        folder / "many.mcap" + ": expected at most 65535 channels, found more");
  CHECK(folder.names() == std::vector<std::string>{"many.xdf"});
}

TEST_CASE("so is a recording of as many JSON channels") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder.write("many_in.mcap", mcap_of_all_channels());
  const auto source = RecordingSource::open(files, path, RecordingSource::Devices::surveyed);
  REQUIRE(source);
  const ShowFiles paths{source->get(), folder / "many.mcap", Overwrite::no};
  const auto shown = show_recording(files, {}, paths);
  REQUIRE(!shown);
  CHECK(shown.error().expected == "at most 65535 channels");
  CHECK(folder.names() == std::vector<std::string>{"many_in.mcap"});
}

TEST_CASE("streams of an XDF with the same name are distinguished by their ids") {
  const FreshFolder folder;
  PosixFiles files;
  const auto named = [](std::uint32_t id, const std::string& name) {
    std::string header = xdf_header(id, "int8", 1);
    const std::string own = "<name>N" + std::to_string(id) + "</name>";
    return header.replace(header.find(own), own.size(), "<name>" + name + "</name>");
  };
  std::string bytes = xdf_begin + named(1, "ab") + named(2, "cd") + named(3, "ab");
  for (const std::uint32_t id : {1U, 2U, 3U}) {
    bytes += xdf_samples(id, 1, xdf_sample(1.0, "a"));
  }
  const std::string path = folder.write("rec.xdf", bytes);
  REQUIRE(show_xdf(files, path, folder / "rec.mcap", Overwrite::no));
  std::vector<std::string> topics;
  for (const McapRecord& record : read_mcap(folder.read("rec.mcap")).records) {
    if (const auto* channel = std::get_if<McapChannel>(&record)) {
      if (topics.size() < 3) topics.push_back(channel->topic);
    }
  }
  CHECK(topics == std::vector<std::string>{"/ab/1", "/cd", "/ab/3"});
}

TEST_CASE("samples before 1970 are left out with a warning") {
  const FreshFolder folder;
  PosixFiles files;
  PointStream points;
  points.joint_names = {"Hip"};
  for (const std::int64_t ns : {-2'000'000'000, -1'000'000'000, 0}) {
    points.frames.stamps.push_back(utc_time(ns));
    points.frames.positions.insert(points.frames.positions.end(), {0.0, 1.0, 0.0});
    points.frames.state.push_back(Tracking::tracked);
  }
  Recording recording;
  recording.streams.push_back(recorded("kinect", std::move(points)));
  const auto found = show_recording(files, recording, {nullptr, folder / "a.mcap", Overwrite::no});
  REQUIRE(found);
  REQUIRE(found->size() == 1);
  CHECK(to_string(found->front().what) == folder / "a.mcap" +
                                              ": expected stamps from 1970 on, "
                                              "found 4 messages with earlier stamps");
}
