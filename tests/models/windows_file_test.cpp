// SPDX-License-Identifier: Apache-2.0
// A file that numpy.savez wrote (tests/data/models/windows_numpy.py) and one by the writer of
// `dataset windows`; damaged files, too.
#include "kinalign/models/windows_file.h"

#include "tests/folder.h"

#include "kinalign/formats/take/take_npz.h"
#include "kinalign/models/pairs.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstring>

using namespace kinalign;

namespace {

std::string numpy_file() {
  return bytes_in(KINALIGN_SOURCE_DIR "/tests/data/models/windows_numpy.npz");
}

Windows windows_of(const std::string& bytes) {
  auto out = read_windows(bytes, "w.npz");
  REQUIRE(out);
  return *std::move(out);
}

std::string refusal(const std::string& bytes) {
  const auto windows = read_windows(bytes, "w.npz");
  return windows ? "no error" : to_string(windows.error());
}

/// The arrays of NumPy's file, to be changed by tests.
struct Arrays {
  struct One {
    NpzArray about;
    std::string bytes;
  };
  std::map<std::string, One> all;

  Arrays() {
    const std::string file = numpy_file();
    const auto stored = stored_arrays(file, "w.npz");
    REQUIRE(stored);
    for (const auto& [name, array] : *stored) {
      const NpyHeader& header = array.header;
      const std::size_t size = header.value_bytes;
      const std::string type = std::string(1, size == 1 ? '|' : '<') + header.kind +
                               std::to_string(header.kind == 'U' ? size / 4 : size);
      all[name] = {{name, type, size, header.shape}, std::string(array.bytes)};
    }
  }

  /// The file in the form in which `dataset windows` writes it.
  std::string written() const {
    const FreshFolder folder;
    PosixFiles files;
    std::vector<NpzArray> about;
    for (const auto& [name, one] : all) about.push_back(one.about);
    auto writer = NpzWriter::create(files, folder / "w.npz", Overwrite::no, about);
    REQUIRE(writer);
    std::size_t i = 0;
    for (const auto& [name, one] : all) REQUIRE(writer->append(i++, one.bytes));
    REQUIRE(writer->finish());
    return folder.read("w.npz");
  }

  template <class Value>
  void put(const std::string& name, std::size_t at, Value value) {
    std::memcpy(&all.at(name).bytes[at * sizeof value], &value, sizeof value);
  }
  void put_manifest(const std::string& text) {
    NpzTexts texts = npz_texts("manifest", {text});
    texts.array.shape = {};
    all["manifest"] = {texts.array, texts.bytes};
  }
};

}  // namespace

TEST_CASE("windows file: windows that overlap or follow become one stretch") {
  const Windows windows = windows_of(numpy_file());
  REQUIRE(windows.stretches.size() == 3);
  CHECK(windows.stretches[0].rows == 6);  // rows 0-3 and 2-5 of the take
  CHECK(windows.stretches[1].rows == 3);  // rows 10-12: a fourth row is beyond the take
  CHECK(windows.stretches[2].rows == 4);
  CHECK(windows.stretches[0].take == 0);
  CHECK(windows.stretches[1].take == 0);
  CHECK(windows.stretches[2].take == 1);
  CHECK(windows.stretches[2].part == 1);
  const auto& kinect = windows.stretches[0].streams.at("kinect").arrays.at("positions");
  const auto& mocap = windows.stretches[0].streams.at("mocap").arrays.at("positions");
  REQUIRE(kinect.size() == 6 * 9);
  for (std::size_t i = 0; i < kinect.size(); ++i) {
    const float wanted = static_cast<float>(i / 9) + (static_cast<float>(i % 9) / 16.0F);
    CHECK(kinect[i] == wanted);
    CHECK(mocap[i] == wanted + 100.0F);
  }
  CHECK(windows.stretches[1].streams.at("kinect").arrays.at("positions")[9] == 11.0F);
  const std::vector<float> state{2, 2, 2, 2, 2, 0, 2, 2, 2, 2, 1, 2, 2, 2, 2, 2, 2, 2};
  CHECK(windows.stretches[0].streams.at("kinect").arrays.at("state") == state);
  CHECK(windows.rest_offsets.at("mocap").size() == 18);
  CHECK(windows.rest_offsets.at("mocap")[17] == 17.0F);
}

TEST_CASE("windows file: what the manifest says") {
  const Windows windows = windows_of(numpy_file());
  CHECK(windows.facts.dataset == "wal\xf0\x9d\x84\x9eks \xc3\xa9");
  CHECK(windows.facts.licence == "CC0-1.0");
  CHECK(windows.facts.citation == "nobody, 2026");
  CHECK(windows.facts.rate_hz == 30.0);
  CHECK(windows.facts.parts == std::vector<std::string>{"train", "validation"});
  CHECK(windows.facts.takes[1].subject == "S02");
  REQUIRE(windows.facts.find("mocap"));
  CHECK(windows.facts.find("mocap")->parents == std::vector<int>{-1, 0, 0});
  CHECK(windows.facts.find("kinect")->names[2] == "HipRight");
  CHECK_FALSE(windows.facts.find("imu"));
}

TEST_CASE("windows file: a file by dataset windows reads like NumPy's") {
  const Windows a = windows_of(numpy_file()), b = windows_of(Arrays().written());
  REQUIRE(a.stretches.size() == b.stretches.size());
  for (std::size_t i = 0; i < a.stretches.size(); ++i) {
    CHECK(a.stretches[i].rows == b.stretches[i].rows);
    for (const auto& [name, stream] : a.stretches[i].streams) {
      CHECK(b.stretches[i].streams.at(name).arrays == stream.arrays);
    }
  }
  CHECK(a.facts.dataset == b.facts.dataset);
  CHECK(a.rest_offsets == b.rest_offsets);
}

TEST_CASE("windows file: a window that neither overlaps nor follows begins a stretch") {
  Arrays arrays;
  arrays.put<std::int64_t>("time_ns", 1, 166'666'667);  // rows 0-3, then 5-8
  CHECK(windows_of(arrays.written()).stretches.size() == 4);
  arrays.put<std::int64_t>("time_ns", 1, 133'333'333);  // 0-3, then 4-7
  const Windows follows = windows_of(arrays.written());
  CHECK(follows.stretches.size() == 3);
  CHECK(follows.stretches[0].rows == 8);
}

TEST_CASE("windows file: what is damaged is refused") {
  CHECK(refusal("") == "w.npz: expected an NPZ (numpy.savez), found no ZIP directory at the end");
  Arrays arrays;
  arrays.all.erase("time_ns");
  CHECK(refusal(arrays.written()) == "w.npz: expected an array time_ns, found none");
  arrays = {};
  arrays.all.erase("manifest");
  CHECK(refusal(arrays.written()) ==
        "w.npz: expected a file of kinalign dataset windows, found no array manifest");
  arrays.put_manifest(R"({"schema":"kinalign.windows/2"})");
  CHECK(refusal(arrays.written()) ==
        "w.npz: expected a manifest of schema kinalign.windows/1, found another schema");
  arrays.put_manifest(R"({"schema":"kinalign.windows/1","rate_hz":"fast"})");
  CHECK(refusal(arrays.written()).starts_with("w.npz: expected a complete manifest"));
  arrays = {};
  arrays.put<std::int32_t>("rows", 2, 5);  // a window has 4
  CHECK(refusal(arrays.written()).ends_with("with a row for each, found fewer"));
  arrays.put<std::int32_t>("rows", 2, -1);
  CHECK(refusal(arrays.written()) == "w.npz: expected rows of a window, found -1");
  arrays = {};
  arrays.put<std::int64_t>("time_ns", 2, std::int64_t{1} << 62U);
  CHECK(windows_of(arrays.written()).stretches.size() == 3);  // a gap of 146 years
  arrays = {};
  arrays.all["rows"] = {{"rows", "<i0", 0, {4}}, ""};
  CHECK(refusal(arrays.written()).starts_with("w.npz: rows.npy: expected an NPY of numbers"));
  arrays.all["rows"] = {{"rows", "<f4", 4, {4}}, std::string(16, '\0')};
  CHECK(refusal(arrays.written()) ==
        "w.npz: expected rows of integers, found values of another type");
  arrays = {};
  arrays.all.at("take").about.shape = {3};
  arrays.all.at("take").bytes.resize(12);
  CHECK(refusal(arrays.written()) ==
        "w.npz: expected arrays of one length, found take, part, rows and time_ns differ");
}

TEST_CASE("windows file: compressed arrays are named") {
  std::string bytes = numpy_file();
  const std::size_t list = bytes.find("PK\x01\x02");
  REQUIRE(list != std::string::npos);
  bytes[list + 10] = 8;  // method: deflated
  CHECK(refusal(bytes) ==
        "w.npz: expected arrays that are stored (numpy.savez, kinalign dataset windows), found "
        "take.npy, which is compressed");
}

TEST_CASE(
    "windows file: each byte of the ZIP's own parts changed is refused or read, at any length") {
  const std::string bytes = numpy_file();
  const auto use = [](const std::string& altered) {
    const auto windows = read_windows(altered, "w.npz");
    if (windows) (void)pairs_of(*windows, "kinect", "mocap", 1);
  };
  for (std::size_t size = 0; size < bytes.size(); size += 5) use(bytes.substr(0, size));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const char other : {'\0', '\xff', '9'}) {
      std::string altered = bytes;
      altered[at] = other;
      use(altered);
    }
  }
}

TEST_CASE("pairs: the joints of a Kinect in the input, seen as state and validity state") {
  const auto pairs = pairs_of(windows_of(numpy_file()), "kinect", "mocap", 1);
  REQUIRE(pairs);
  CHECK(pairs->inputs == std::vector<std::string>{"SpineBase", "HipLeft", "HipRight"});
  CHECK(pairs->outputs == std::vector<std::string>{"Hips", "LeftUpLeg", "RightUpLeg"});
  CHECK(pairs->rate_hz == 30.0);
  CHECK(pairs->parents == std::vector<int>{-1, 0, 0});
  REQUIRE(pairs->all.size() == 3);
  const Pair& first = pairs->all[0];
  CHECK(first.take == "S01-A1");
  CHECK(first.subject == "S01");
  CHECK(first.part == "train");
  CHECK(pairs->all[2].part == "validation");
  CHECK(first.input.frames() == 6);
  CHECK(first.truth.size() == 6 * 9);
  CHECK(first.valid == std::vector<std::uint8_t>(18, 1));
  CHECK(first.input.seen[5] == 0);
  CHECK(first.input.seen[10] == 1);
  CHECK(first.input.seen[11] == 2);
}

TEST_CASE("pairs: short stretches are left out; other streams are refused by name") {
  const Windows windows = windows_of(numpy_file());
  CHECK(pairs_of(windows, "kinect", "mocap", 4)->all.size() == 2);
  CHECK(pairs_of(windows, "kinect", "mocap", 7)->all.empty());
  const auto none = pairs_of(windows, "imu", "mocap", 1);
  REQUIRE_FALSE(none);
  CHECK(to_string(none.error()) == "expected a stream \"imu\" with names, found mocap, kinect");
}

TEST_CASE("pairs: positions must be those of all joints") {
  Arrays arrays;
  arrays.all.erase("mocap_positions");
  auto pairs = pairs_of(windows_of(arrays.written()), "kinect", "mocap", 1);
  REQUIRE_FALSE(pairs);
  CHECK(to_string(pairs.error()) ==
        "expected positions of all joints of kinect and mocap, found none");
  arrays = {};
  auto& kinect = arrays.all.at("kinect_positions");
  kinect.about.shape = {4, 4, 6};
  kinect.bytes.resize(4 * 4 * 6 * 4);
  CHECK_FALSE(pairs_of(windows_of(arrays.written()), "kinect", "mocap", 1));
}

TEST_CASE("pairs: of a Kinect's 25 joints and others the Kinect's are taken") {
  Windows windows;
  windows.facts.rate_hz = 30.0;
  windows.facts.streams = {{"kinect", "points", {}, {}}, {"mocap", "skeleton", {"Hips"}, {-1}}};
  std::vector<std::string>& names = windows.facts.streams[0].names;
  names = {"Waist",        "Tail",         "Spine",        "Chest",
           "Neck",         "HeadTip",      "UpperArmLeft", "ForearmLeft",
           "UpperLegLeft", "LowerLegLeft", "FootLeft",     "UpperLegRight"};
  Stretch stretch{0, 0, 1, {}};
  for (int i = 0; i < 36; ++i) {
    stretch.streams["kinect"].arrays["positions"].push_back(static_cast<float>(i));
  }
  stretch.streams["mocap"].arrays["positions"] = {1, 2, 3};
  windows.stretches = {stretch};
  const auto pairs = pairs_of(windows, "kinect", "mocap", 1);
  REQUIRE(pairs);
  // "Tail" and "Neck" (a joint that a Kinect lacks) are left out.
  CHECK(pairs->inputs.size() == 10);
  CHECK(pairs->inputs[1] == "SpineMid");
  CHECK(pairs->all[0].input.positions[3] == 6.0F);
  CHECK(pairs->all[0].input.seen == std::vector<std::uint8_t>(10, 2));
}

TEST_CASE(
    "pairs: for a model, joints are found by the Kinect's names and missing joints are reported") {
  const Windows windows = windows_of(numpy_file());
  const Pairs joints{{"HipRight", "Head", "SpineBase"}, {"HipLeft", "LeftLeg"}, 30.0};
  const auto pairs = pairs_for(windows, "kinect", "mocap", joints, 1);
  const auto plain = pairs_of(windows, "kinect", "mocap", 1);
  REQUIRE(pairs);
  REQUIRE(pairs->all.size() == plain->all.size());
  CHECK(pairs->inputs == joints.inputs);
  const Pair &one = pairs->all[0], &same = plain->all[0];
  for (std::size_t t = 0; t < one.input.frames(); ++t) {
    CHECK(one.input.seen[3 * t] == same.input.seen[3 * t + 2]);
    CHECK(one.input.seen[3 * t + 1] == 0);
    CHECK(one.input.seen[3 * t + 2] == same.input.seen[3 * t]);
    CHECK(one.valid[2 * t] == 1);
    CHECK(one.valid[2 * t + 1] == 0);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(one.truth[6 * t + k] == same.truth[9 * t + 3 + k]);
    }
  }
}
