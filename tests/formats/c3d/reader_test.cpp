// SPDX-License-Identifier: Apache-2.0
// C3D files of the independent writer in tests/witness/c3d_files.py; and damaged ones.
#include "tests/folder.h"
#include "tests/formats/any_points.h"
#include "tests/formats/reading.h"
#include "tests/witness.h"

#include "kinalign/formats/c3d/c3d.h"

#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

Read<PointReader> read_c3d(std::string_view bytes, const StreamOptions& options = {}) {
  return read_all(make_c3d_reader(options, "walk.c3d"), bytes);
}

/// The files that the script c3d_files.py writes.
struct Files {
  FreshFolder folder;
  Files() { REQUIRE(run_witness("c3d_files.py", folder.path()) == 0); }

  std::string bytes(const std::string& name) const { return folder.read(name + ".c3d"); }
  std::vector<double> positions(const std::string& name) const {
    const std::string bytes = folder.read(name + ".f8");
    std::vector<double> out(bytes.size() / sizeof(double));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  std::vector<Tracking> states(const std::string& name) const {
    std::vector<Tracking> out;
    for (const char c : folder.read(name + ".u1")) out.push_back(static_cast<Tracking>(c));
    return out;
  }
};

/// A small whole file that our writer made: two points, three frames at 100 Hz.
std::string small_file() {
  std::string bytes;
  auto writer =
      C3dWriter::begin({{"LASI", "RASI"}, 100.0, 3}, [&](std::string_view more) -> Result<void> {
        bytes += more;
        return {};
      });
  PointFrames frames;
  for (int t = 0; t < 3; ++t) {
    frames.stamps.push_back(utc_time(t * 10'000'000));
    frames.positions.insert(frames.positions.end(), {1.0 * t, 2, 3, 4, 5, 6});
    frames.state.insert(frames.state.end(), {Tracking::tracked, Tracking::tracked});
  }
  REQUIRE(writer);
  REQUIRE(writer->append(frames));
  REQUIRE(writer->finish());
  return bytes;
}

/// The file with its bytes from `at` on replaced by `bytes`.
std::string patched(std::string file, std::size_t at, std::string_view bytes) {
  return file.replace(at, bytes.size(), bytes);
}

/// The offset in the file at which the values of a parameter begin. `dimensions`: the number of
/// its dimensions.
std::size_t values_of(const std::string& file, const std::string& name,
                      std::size_t dimensions = 0) {
  const std::size_t at = file.find(name);
  REQUIRE(at != std::string::npos);
  return at + name.size() + 2 + 2 + dimensions;
}

std::string f32(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return {reinterpret_cast<const char*>(&bits), 4};
}

std::vector<std::string> found_in(const std::string& bytes) {
  const auto read = read_c3d(bytes);
  CHECK(read.error == "");
  std::vector<std::string> out;
  for (const Finding& finding : read.findings) out.push_back(text_of(finding));
  return out;
}

}  // namespace

TEST_CASE("points of Intel, DEC and MIPS are read as an independent writer meant them") {
  const Files files;
  for (const char* name : {"intel_floats", "intel_integers", "dec_floats", "dec_integers",
                           "mips_floats", "mips_integers", "zeros_in_front"}) {
    CAPTURE(name);
    const std::string bytes = files.bytes(name);
    CHECK(looks_like_c3d(std::string_view(bytes).substr(0, 262'144)));
    const auto read = read_in_pieces(make_c3d_reader({}, "walk.c3d"), bytes, 1000);
    CHECK(read.error == "");
    CHECK(read.rows.state == files.states(name));
    CHECK(largest_difference(read.rows.positions, files.positions(name)) <= 1e-12);
    CHECK(read.header.joint_names.front() == "M0");
    CHECK(read.header.joint_names.back() ==
          "M" + std::to_string(read.header.joint_names.size() - 1));
    CHECK(read.rows.stamps[1] - read.rows.stamps[0] == Duration{8'341'675});  // 1 / 119.88 Hz
    REQUIRE(read.findings.size() == 1);
    CHECK(read.findings[0].severity == Severity::note);
    CHECK(text_of(read.findings[0]) ==
          "walk.c3d: expected only points, found 3 analog channels: Fx, Fy, EMG 1");
  }
}

TEST_CASE("more than 65,535 frames are read, as TRIAL states them") {
  const Files files;
  const auto read = read_in_pieces(make_c3d_reader({}, "long.c3d"), files.bytes("long"), 65'536);
  CHECK(read.rows.size() == 70'001);
  CHECK(read.rows.state == files.states("long"));
  CHECK(largest_difference(read.rows.positions, files.positions("long")) <= 1e-12);
  CHECK(read.findings.size() == 1);  // the analog channels
}

TEST_CASE(
    "a file that only says 65,535 frames or more is read to its end, without the last block's "
    "zeros") {
  const Files files;
  const auto read = read_in_pieces(make_c3d_reader({}, "u.c3d"), files.bytes("uncounted"), 7);
  CHECK(read.error == "");
  CHECK(read.rows.size() == 5);
  CHECK(read.rows.state == files.states("uncounted"));
}

TEST_CASE("rows of a C3D do not depend on where it is cut into pieces") {
  const std::string file = small_file();
  for (const std::string& bytes :
       {file, file.substr(0, 1500), file.substr(0, 1560), std::string(5, '\0') + file}) {
    const auto whole = read_c3d(bytes);
    for (std::size_t piece = 1; piece < bytes.size(); piece += 1 + piece / 8) {
      CAPTURE(piece);
      const auto cut = read_in_pieces(make_c3d_reader({}, "walk.c3d"), bytes, piece);
      CHECK(same_rows(cut.rows, whole.rows));
      CHECK(cut.error == whole.error);
      CHECK(cut.findings.size() == whole.findings.size());
    }
  }
}

TEST_CASE("unit, up, rate and start are the user's if they are given") {
  const std::string file = small_file();
  StreamOptions options;
  options.metres_per_unit = 1.0;
  options.up = "y";
  options.rate_hz = 50.0;
  options.start_ns = 7;
  const auto read = read_c3d(file, options);
  CHECK(read.rows.stamps ==
        std::vector<Time>{utc_time(7), utc_time(20'000'007), utc_time(40'000'007)});
  CHECK(std::vector<double>(read.rows.positions.begin(), read.rows.positions.begin() + 3) ==
        std::vector<double>{0, -3000, 2000});
  const std::string furlongs = patched(file, values_of(file, "UNITS", 1), "fu");
  CHECK(read_c3d(furlongs).error ==
        "walk.c3d: expected POINT:UNITS mm, cm, m or in; otherwise set metres_per_unit, found fu");
  CHECK(read_c3d(furlongs, options).error == "");
}

TEST_CASE("what Y_SCREEN names points up") {
  const std::string file = small_file();
  const auto first = [&](const char* up) {
    const auto read = read_c3d(patched(file, values_of(file, "Y_SCREEN", 1), up));
    CHECK(read.findings.size() == (std::string(up) == "-Q" ? 1 : 0));
    return std::vector<double>(read.rows.positions.begin() + 9, read.rows.positions.begin() + 12);
  };
  // The file holds (4, -6, 5).
  CHECK(first("+Z") == std::vector<double>{4, 5, 6});
  CHECK(first("+Y") == std::vector<double>{4, -6, 5});
  CHECK(first("+X") == std::vector<double>{6, 4, 5});
  CHECK(first("-Q") == std::vector<double>{4, 5, 6});
}

TEST_CASE("a C3D that is cut, or longer than it states, gives its frames with a finding") {
  const std::string file = small_file();
  CHECK(found_in(file).empty());
  CHECK(found_in(file.substr(0, file.size() - 512 + 2 * 32 + 5)) ==
        std::vector<std::string>{"walk.c3d: expected 3 frames, found 2"});
  CHECK(found_in(file + std::string(512, 'x')) ==
        std::vector<std::string>{
            "walk.c3d: expected the end of the file after 3 frames, found 928 more bytes"});
  CHECK(found_in(patched(file, 8, std::string("\x02\0", 2))) ==
        std::vector<std::string>{
            "walk.c3d: expected 2 frames as in the header, found 3 in the parameters"});
  CHECK(found_in(patched(file, 20, f32(200.0F))) ==
        std::vector<std::string>{"walk.c3d: expected POINT:RATE 200 as in the header, found 100"});
}

TEST_CASE("a repeated name never gets the name of another point") {
  std::string bytes;
  auto writer =
      C3dWriter::begin({{"A", "A", "A#2"}, 100.0, 0}, [&](std::string_view more) -> Result<void> {
        bytes += more;
        return {};
      });
  REQUIRE(writer);
  REQUIRE(writer->finish());
  CHECK(read_c3d(bytes).header.joint_names == std::vector<std::string>{"A", "A#3", "A#2"});
}

TEST_CASE("missing and repeated names are reported") {
  const std::string file = small_file();
  const std::size_t at = values_of(file, "LABELS", 2);
  const auto repeated = read_c3d(patched(file, at, "LASILASI"));
  CHECK(repeated.header.joint_names == std::vector<std::string>{"LASI", "LASI#2"});
  REQUIRE(repeated.findings.size() == 1);
  CHECK(text_of(repeated.findings[0]) ==
        "walk.c3d: expected different names in POINT:LABELS, found 1 repeated");
  const auto missing = read_c3d(patched(file, at, "LASI    "));
  CHECK(missing.header.joint_names == std::vector<std::string>{"LASI", "point2"});
  const auto nameless = read_c3d(patched(file, file.find("LABELS"), "LABELZ"));
  CHECK(nameless.header.joint_names == std::vector<std::string>{"point1", "point2"});
  REQUIRE(nameless.findings.size() == 1);
  CHECK(text_of(nameless.findings[0]) == "walk.c3d: expected 2 names in POINT:LABELS, found 0");
}

TEST_CASE("a coordinate that is no number makes its point missing, with a finding") {
  const std::string file = small_file();
  const auto read =
      read_c3d(patched(file, file.size() - 512, f32(std::bit_cast<float>(0x7fc00000U))));
  CHECK(read.rows.state.front() == Tracking::missing);
  CHECK(read.rows.positions.front() == 0.0);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "walk.c3d: expected coordinates below 1e15, found 1 points with other values");
}

TEST_CASE("a head of a C3D that can't be understood is an error with its byte") {
  const std::string file = small_file();
  const auto error_of = [](const std::string& bytes) { return read_c3d(bytes).error; };
  CHECK(error_of("") ==
        "walk.c3d: expected a C3D header and its parameters, found the end of the file at byte 0");
  CHECK(
      error_of(file.substr(0, 700)) ==
      "walk.c3d: expected a C3D header and its parameters, found the end of the file at byte 700");
  CHECK(error_of(patched(file, 1, "x")) ==
        "walk.c3d: expected a C3D header, found another beginning");
  CHECK(error_of(std::string(5000, '\0') + file) ==
        "walk.c3d: expected a C3D header, found 5000 zero bytes");
  CHECK(error_of(patched(file, 515, "x")) ==
        "walk.c3d: expected processor 84, 85 or 86, found 120 at byte 515");
  CHECK(error_of(patched(file, values_of(file, "USED"), "\x03")) ==
        "walk.c3d: expected POINT:USED 2 as in the header, found 3");
  CHECK(error_of(patched(patched(file, 2, std::string(2, '\0')), values_of(file, "USED"),
                         std::string(2, '\0'))) ==
        "walk.c3d: expected points, found a C3D file without any");
  CHECK(error_of(patched(file, 4, "\x03")) ==
        "walk.c3d: expected 3 analog values in a frame as in the header, found 0 channels of 1 "
        "samples");
  CHECK(error_of(patched(file, values_of(file, "SCALE"), f32(0.0F))) ==
        "walk.c3d: expected a scale of points other than 0, found 0");
  CHECK(error_of(patched(file, values_of(file, "SCALE"), f32(0.5F))) ==
        "walk.c3d: expected POINT:SCALE of the sign of the header's -1, found 0.5");
  CHECK(error_of(patched(file, values_of(file, "RATE"), f32(-1.0F))) ==
        "walk.c3d: expected a rate of 0.001 to 1,000,000 Hz in POINT:RATE, or rate_hz, found -1");
  const std::size_t labels = file.find("LABELS");
  CHECK(error_of(patched(file, labels + 6, "\xff\xff")) ==
        "walk.c3d: expected C3D parameters inside their section, found another at byte " +
            std::to_string(labels - 2));
  CHECK(error_of(patched(file, labels + 10, "\xff\xff")) ==
        "walk.c3d: expected the values of parameter LABELS inside the section, found another at "
        "byte " +
            std::to_string(labels - 2));
}

TEST_CASE("text is not taken for a C3D") {
  CHECK(!looks_like_c3d(""));
  CHECK(!looks_like_c3d("UP " + std::string(60'000, 'x')));
  CHECK(!looks_like_c3d(std::string(4096, '\0')));
  CHECK(looks_like_c3d(small_file()));
}
