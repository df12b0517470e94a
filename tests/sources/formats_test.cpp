// SPDX-License-Identifier: Apache-2.0
// Which reader is chosen for a file, and the error if there is none.
#include "kinalign/sources/formats.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

std::string numbers(int count, char between) {
  std::string text = "1.5";
  for (int i = 1; i < count; ++i) text += between + std::to_string(i);
  return text + "\n";
}

struct Outcome {
  std::string name, error;
  std::vector<std::string> further;
};

Outcome found(const std::string& path, const std::string& layout = "") {
  PosixFiles files;
  StreamOptions options;
  options.layout = layout;
  const std::string text = bytes_in(path);
  const auto format = find_format(files, options, {path, ""}, text);
  if (!format) return {"", to_string(format.error()), {}};
  return {format->name, "", format->further_files};
}

}  // namespace

TEST_CASE(
    "UI-PRMD's file of positions leads to its angles: by name, in a sibling folder or the same "
    "one") {
  const FreshFolder folder;
  const std::string row = numbers(66, ',');
  const std::string apart = folder.write("positions/Positions/m1_positions.txt", row);
  const std::string angles = folder.write("positions/Angles/m1_angles.txt", row);
  CHECK(found(apart).name == "ui_prmd_kinect");
  CHECK(found(apart).further == std::vector{angles});
  const std::string sibling = folder.write("Positions/positions.d/m2_positions.txt", row);
  CHECK(found(sibling).error == (folder / "Positions/positions.d/m2_angles.txt") +
                                    ": expected a readable file, found No such file or directory");
  const std::string here = folder.write("Positions/positions.d/m2_angles.txt", row);
  CHECK(found(sibling).further == std::vector{here});
  const std::string only = folder.write("Positions/m3.txt", row);
  const std::string there = folder.write("Angles/m3.txt", row);
  CHECK(found(only).further == std::vector{there});
}

TEST_CASE("UI-PRMD's file of angles has to stay as it was when it was found") {
  const FreshFolder folder;
  const std::string row = numbers(66, ',');
  const std::string positions = folder.write("m_positions.txt", row);
  folder.write("m_angles.txt", row);
  PosixFiles files;
  const auto format = find_format(files, {}, {positions, ""}, row);
  REQUIRE(format);
  CHECK(format->make());
  const std::string angles = folder.write("m_angles.txt", row + row);
  const auto again = format->make();
  REQUIRE_FALSE(again);
  CHECK(to_string(again.error()) ==
        angles + ": expected a file that does not change while it is read, found a changed file");
}

TEST_CASE("numbers that could be UI-PRMD's are not, where no other file holds the angles") {
  const FreshFolder folder;
  const std::string lone = folder.write("sixtysix.txt", numbers(66, ','));
  CHECK(found(lone).error.find("write a layout (docs/formats/layouts.md: ") != std::string::npos);
  CHECK(found(lone, "ui_prmd_kinect").error ==
        lone +
            ": expected UI-PRMD's file of positions, ..._positions.txt; the file of angles is "
            "found by its name, "
            "found another name");
}

TEST_CASE("UI-PRMD's file of angles by itself is refused, the Kinect's and the optical one") {
  const FreshFolder folder;
  for (const int cells : {66, 117}) {
    CAPTURE(cells);
    const std::string angles = folder.write("m1_angles.txt", numbers(cells, ','));
    CHECK(found(angles).error == angles +
                                     ": expected UI-PRMD's file of positions, ..._positions.txt; "
                                     "the file of angles is found by its name, "
                                     "found the file of angles");
  }
  CHECK(found(folder.write("m1_positions.txt", numbers(117, ','))).name == "ui_prmd_vicon");
}

TEST_CASE("a file of no known kind: what it is, and what to do with a table") {
  const FreshFolder folder;
  const auto error_of_bytes = [&](std::string_view bytes) {
    return found(folder.write("f", bytes)).error;
  };
  const std::string known =
      (folder / "f") +
      ":1: expected a format that kinalign knows (docs/formats); for a table of another kind write "
      "a layout (docs/formats/layouts.md: layout = in a manifest, --layout with one file), found ";
  CHECK(error_of_bytes("unix_ms,acc_x\n1,2\n") == known + "'unix_ms,acc_x'");
  CHECK(error_of_bytes("\xff\xfe\x80 \x1b[31m\n") == known + "bytes that are no plain text");
  CHECK(error_of_bytes("\x1f\x8b\x08") == known + "a gzip archive: unpack it first");
  CHECK(error_of_bytes("PK\x03\x04 an .npz") == known + "a ZIP archive, such as .npz");
  CHECK(error_of_bytes(std::string(300, 'x')) == known + "'" + std::string(40, 'x') + "...'");
  CHECK(error_of_bytes("") ==
        (folder / "f") + ": expected a recording's file, found an empty file");
}

TEST_CASE("a choice of rows that a format does not know is refused, not ignored") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string trc = folder.write("walk.trc", "PathFileType\t4\t(X/Y/Z)\twalk.trc\n");
  const std::string ntu = folder.write("a.skeleton", "1\n0\n");
  const auto refusal = [&](const std::string& path, const std::string& layout,
                           const std::string& column) {
    StreamOptions options;
    options.layout = layout;
    options.select = {{column, "2"}};
    const auto format = find_format(files, options, {path, ""}, bytes_in(path));
    return format ? "" : to_string(format.error());
  };
  CHECK(refusal(trc, "", "subject") ==
        trc + ": expected no select for a file of format trc, found subject = 2");
  CHECK(refusal(ntu, "ntu", "person") == ntu + ": expected select by body, found person = 2");
  CHECK(refusal(ntu, "ntu", "body").empty());
}

TEST_CASE("a file's kind is decided by its first bytes, whatever its name is") {
  const FreshFolder folder;
  PosixFiles files;
  const auto kind = [&](const std::string& name, const std::string& bytes) {
    return kind_of_file(files, folder.write(name, bytes)).value();
  };
  const std::string mcap = "\x89MCAP0\r\n", hdf5 = "\x89HDF\r\n\x1a\n";
  const std::string model("\x20\x03\0\0\0\0\0\0{\"__metadata__\"", 22);
  for (const std::string name : {"a.mcap", "a.h5", "a.toml", "a"}) {
    CAPTURE(name);
    CHECK(kind(name, mcap) == FileKind::recording);
    CHECK(kind(name, mcap + "and more") == FileKind::recording);
    CHECK(kind(name, "XDF:") == FileKind::xdf);
    CHECK(kind(name, hdf5) == FileKind::take);
    CHECK(kind(name, model) == FileKind::model);
  }
  CHECK(kind("walk.bvh", "HIERARCHY\nROOT Hips\n") == FileKind::stream);
  CHECK(kind("walk.mcap", "HIERARCHY\nROOT Hips\n") == FileKind::stream);
  CHECK(kind("k.trc", "PathFileType\t4\t(X/Y/Z)\tk.trc\n") == FileKind::stream);
}

TEST_CASE("a manifest is known by its ending, even if it is empty") {
  const FreshFolder folder;
  PosixFiles files;
  CHECK(kind_of_file(files, folder.write("a.toml", "")).value() == FileKind::manifest);
  const std::string text = "[stream.mocap]\nfile = \"walk.bvh\"\n";
  CHECK(kind_of_file(files, folder.write("recording.toml", text)).value() == FileKind::manifest);
  CHECK(kind_of_file(files, folder.write("recording.txt", text)).value() == FileKind::unknown);
}

TEST_CASE("a table is a stream if a built-in layout knows its columns") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string known = "time_ns,qw,qx,qy,qz\n1790000000000000000,1,0,0,0\n";
  CHECK(kind_of_file(files, folder.write("a.csv", known)).value() == FileKind::stream);
  CHECK(kind_of_file(files, folder.write("b.csv", "a,b,c\n1,2,3\n")).value() == FileKind::unknown);
}

TEST_CASE("an empty file and one that ends within a signature are of no known kind") {
  const FreshFolder folder;
  PosixFiles files;
  for (const std::string whole : {"\x89MCAP0\r\n", "\x89HDF\r\n\x1a\n", "XDF:"}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      CAPTURE(size);
      const std::string path = folder.write("cut", whole.substr(0, size));
      CHECK(kind_of_file(files, path).value() == FileKind::unknown);
    }
  }
}

TEST_CASE("a folder and a file that is not there have no kind, but an error") {
  const FreshFolder folder;
  PosixFiles files;
  const auto of_folder = kind_of_file(files, folder.path());
  REQUIRE_FALSE(of_folder);
  CHECK(of_folder.error().kind == ErrorKind::directory);
  CHECK(of_folder.error().found == "a directory");
  const auto missing = kind_of_file(files, folder / "none.mcap");
  REQUIRE_FALSE(missing);
  CHECK(missing.error().expected == "a readable file");
}

TEST_CASE("a file is opened once for its kind, and a bad disk is reported as such") {
  const FreshFolder folder;
  const std::string path = folder.write("walk.bvh", "HIERARCHY\nROOT Hips\n");
  FaultyFiles counting;
  CHECK(kind_of_file(counting, path).value() == FileKind::stream);
  CHECK(counting.calls == 4);  // open, read the signature, read the head, close
  for (const int at : {2, 3}) {
    CAPTURE(at);
    FaultyFiles files;
    files.fail_at = at;
    files.code = EIO;
    const auto kind = kind_of_file(files, path);
    REQUIRE_FALSE(kind);
    CHECK(kind.error().kind == ErrorKind::unreadable_disk);
  }
}

TEST_CASE("select takes the sensors of an MVNX file instead of its segments") {
  PosixFiles files;
  const auto made = [&files](const std::string& part) -> Result<std::size_t> {
    StreamOptions options;
    if (!part.empty()) options.select["part"] = part;
    const auto format = KA_TRY(find_format(files, options, {"a.mvnx", ""}, "<mvnx version=\"4\">"));
    return KA_TRY(format.make()).index();  // index in AnyReader: clip, points, nodes
  };
  CHECK(made("").value() == 0);
  CHECK(made("segments").value() == 0);
  CHECK(made("sensors").value() == 2);
  CHECK(to_string(made("props").error()) ==
        "a.mvnx: expected select part = segments or sensors, found props");
}

TEST_CASE("a tracking system of BIDS-Motion leads to its sidecar files, and may be read as nodes") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string stem = "sub-1/motion/sub-1_task-a_tracksys-b_";
  const std::string path = folder.write(stem + "motion.tsv", "1\t2\t3\t1\t0\t0\t0\n");
  CHECK(found(path).error == (folder / (stem + "channels.tsv")) +
                                 ": expected a readable file, found No such file or directory");
  const std::string channels =
      folder.write(stem + "channels.tsv",
                   "name\tcomponent\ttype\ttracked_"
                   "point\tunits\na\tx\tPOS\tP\tm\nb\ty\tPOS\tP\tm\nc\tz\tPOS\tP\tm\n"
                   "d\tquat_w\tORNT\tP\tn/a\ne\tquat_x\tORNT\tP\tn/a\nf\tquat_y\tORNT\tP\tn/a\n"
                   "g\tquat_z\tORNT\tP\tn/a\n");
  const std::string json = folder.write(stem + "motion.json", "{\"SamplingFrequency\": 50}");
  CHECK(found(path).name == "bids");
  CHECK(found(path).further == std::vector{channels, json});
  const std::string scans = folder.write("sub-1/sub-1_scans.tsv", "filename\n");
  CHECK(found(path).further == std::vector{channels, json, scans});
  const auto made = [&](const std::string& kind) -> Result<std::size_t> {
    StreamOptions options;
    if (!kind.empty()) options.select["kind"] = kind;
    const auto format = KA_TRY(find_format(files, options, {path, ""}, ""));
    return KA_TRY(format.make()).index();  // index in AnyReader: clip, points, nodes
  };
  CHECK(made("").value() == 1);
  CHECK(made("points").value() == 1);
  CHECK(made("nodes").value() == 2);
  CHECK(to_string(made("clip").error()) ==
        path + ": expected select kind = points or nodes, found clip");
}
