// SPDX-License-Identifier: Apache-2.0
#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/formats/take/take_samples.h"
#include "tests/witness.h"

#include "kinalign/documents/parameters_json.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_layout.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <limits>
#include <thread>

using namespace kinalign;

namespace {

Result<void> write(FileSystem& files, const std::string& path, const Take& take) {
  auto writer = KA_TRY(TakeWriter::create(files, path, Overwrite::no, take.header));
  KA_TRY(writer.append(take.all));
  return writer.finish(take.report);
}

void write_or_fail(const std::string& path, const Take& take) {
  PosixFiles files;
  const auto done = write(files, path, take);
  REQUIRE_MESSAGE(done, (done ? "" : to_string(done.error())));
}

/// All arrays of all streams as bytes.
std::string contents(const TakeSlab& slab) {
  std::string out(bytes_of(std::span<const Time>(slab.stamps)));
  for (const auto& rows : slab.rows) {
    const auto use = [&](std::string_view name, const auto& values) -> Result<void> {
      out += name;
      out += bytes_of(std::span(values));
      return {};
    };
    CHECK(std::visit([&](const auto& one) { return for_each_row_array(one, use); }, rows));
  }
  return out;
}

/// Reads everything, and gives an error if there is one.
Result<std::string> read_through(const std::string& path) {
  PosixFiles files;
  const Take take = KA_TRY(read_take(files, path));
  return contents(take.all);
}

}  // namespace

TEST_CASE("the space of positions and samples of unknown time read back") {
  const FreshFolder folder;
  Take take = sample_take(5);
  take.header.groups[1].space = "kinect";
  std::get<PointRows>(take.all.rows[1]).distance.time_interval_ns[2] = -1;  // not known
  write_or_fail(folder / "t.h5", take);
  PosixFiles files;
  const auto read = read_take(files, folder / "t.h5");
  REQUIRE(read);
  CHECK(read->header.groups[0].space == "take");
  CHECK(read->header.groups[1].space == "kinect");
  CHECK(std::get<PointRows>(read->all.rows[1]).distance.time_interval_ns[2] == -1);
}

TEST_CASE("a take that was written reads the same") {
  const FreshFolder folder;
  for (const std::size_t frames : {0U, 1U, 5U, 9000U}) {
    for (const bool store_double : {false, true}) {
      CAPTURE(frames);
      Take take = sample_take(frames);
      take.header.parameters.align.store_double = store_double;
      const std::string path = folder / (std::to_string(frames) + (store_double ? "d.h5" : "s.h5"));
      write_or_fail(path, take);
      PosixFiles files;
      const auto read = read_take(files, path);
      REQUIRE_MESSAGE(read, (read ? "" : to_string(read.error())));
      CHECK(contents(read->all) == contents(take.all));
      CHECK(read->header.subject == "03");
      CHECK(read->header.action == "S1A02");
      CHECK(read->header.frames == frames);
      REQUIRE(read->header.groups.size() == 3);
      const auto& skeleton = std::get<ClipGroup>(read->header.groups[0].kind).skeleton;
      CHECK(skeleton.joint_names[2] == "H\xc3\xa4nde");
      CHECK(skeleton.parents == std::vector<int>{-1, 0, 1});
      CHECK(skeleton.rest_offsets[2].z() == 1.0 / 3);
      REQUIRE(skeleton.end_sites.size() == 1);
      CHECK(skeleton.end_sites[0].parent == 2);
      const auto& imu = std::get<ImuGroup>(read->header.groups[2].kind);
      CHECK(imu.content == ImuContent{true, true, false, true});
      CHECK(imu.root_node == "waist");
      CHECK(read->header.groups[2].files[1].name == "wl.csv");
      CHECK(read->header.groups[2].files[1].bytes == 2);
      CHECK(read->header.groups[1].interval_known);
      CHECK_FALSE(read->header.groups[2].interval_known);
    }
  }
}

TEST_CASE("a take can be written in slabs of any size") {
  const FreshFolder folder;
  const Take whole = sample_take(100);
  write_or_fail(folder / "whole.h5", whole);
  PosixFiles files;
  auto writer = TakeWriter::create(files, folder / "slabs.h5", Overwrite::no, whole.header);
  REQUIRE(writer);
  for (std::size_t first = 0; first < 100; first += 7) {
    const std::size_t count = std::min<std::size_t>(7, 100 - first);
    TakeSlab slab;
    slab.first = first;
    const auto at = [&](const auto& all, auto& part) {
      const std::size_t width = all.size() / 100;
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first * width);
      part.assign(begin, begin + static_cast<std::ptrdiff_t>(count * width));
    };
    at(whole.all.stamps, slab.stamps);
    const auto& mocap = std::get<ClipRows>(whole.all.rows[0]);
    const auto& kinect = std::get<PointRows>(whole.all.rows[1]);
    const auto& imu = std::get<ImuRows>(whole.all.rows[2]);
    ClipRows m;
    PointRows k;
    ImuRows i;
    at(mocap.positions, m.positions);
    at(mocap.local_positions, m.local_positions);
    at(mocap.local_rotations, m.local_rotations);
    at(kinect.positions, k.positions);
    at(kinect.state, k.state);
    at(kinect.valid, k.valid);
    at(kinect.distance.nearest_raw_ns, k.distance.nearest_raw_ns);
    at(kinect.distance.time_interval_ns, k.distance.time_interval_ns);
    at(imu.orientation, i.orientation);
    at(imu.acceleration, i.acceleration);
    at(imu.valid, i.valid);
    at(imu.distance.nearest_raw_ns, i.distance.nearest_raw_ns);
    slab.rows = {m, k, i};
    REQUIRE(writer->append(slab));
  }
  REQUIRE(writer->finish(whole.report));
  CHECK(folder.read("slabs.h5") == folder.read("whole.h5"));
}

TEST_CASE("the same take gives the same bytes, also a second later") {
  const FreshFolder folder;
  write_or_fail(folder / "a.h5", sample_take(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 stores times in seconds
  write_or_fail(folder / "b.h5", sample_take(50));
  CHECK(folder.read("a.h5") == folder.read("b.h5"));
}

TEST_CASE("h5py sees the names, shapes, types and values of a take") {
  const FreshFolder folder;
  write_or_fail(folder / "take.h5", sample_take(50));
  CHECK(run_witness("take_h5py.py", folder / "take.h5") == 0);
}

TEST_CASE("a take holds no path of the machine that made it") {
  const FreshFolder folder;
  write_or_fail(folder / "take.h5", sample_take(5));
  const std::string bytes = folder.read("take.h5");
  CHECK(bytes.find("someone") == std::string::npos);
  CHECK(bytes.find("walk.bvh") != std::string::npos);
}

TEST_CASE("whichever file call fails, no take is left and the error names it") {
  const Take take = sample_take(20);
  bool went_through = false;
  for (int call = 1; !went_through; ++call) {
    CAPTURE(call);
    REQUIRE(call < 500);
    const FreshFolder folder;
    FaultyFiles files;
    files.fail_at = call;
    files.code = EIO;
    const auto done = write(files, folder / "take.h5", take);
    went_through = !files.failed();
    if (done) {
      // The only call that may fail without an error here is the sync of the folder, after the take
      // has its name.
      CHECK(read_through(folder / "take.h5"));
      continue;
    }
    CHECK(done.error().file == folder / "take.h5");
    CHECK(done.error().found == "Input/output error");
    CHECK(folder.empty());
  }
}

TEST_CASE("a full disk is reported before the work, with the space needed") {
  const FreshFolder folder;
  bool seen = false;
  for (int call = 1; call < 60 && !seen; ++call) {
    FaultyFiles files;
    files.fail_at = call;
    const auto done = write(files, folder / "take.h5", sample_take(20));
    if (done) break;
    CHECK(done.error().found == "No space left on device");
    seen = done.error().expected.starts_with("room for ");
  }
  CHECK(seen);
}

TEST_CASE("a file size limit is an ordinary error") {
  const FreshFolder folder;
  const auto done = run_guarded({}, {"", 0, "a child", ""}, [&]() -> Result<std::string> {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{10'000, 10'000};
    ::setrlimit(RLIMIT_FSIZE, &small);
    PosixFiles files;
    KA_TRY(write(files, folder / "take.h5", sample_take(500)));
    return std::string("written");
  });
  REQUIRE_FALSE(done);
  CHECK(done.error().found == "File too large");
  CHECK(folder.empty());
}

TEST_CASE("a take does not overwrite another without --force") {
  const FreshFolder folder;
  write_or_fail(folder / "take.h5", sample_take(5));
  PosixFiles files;
  const auto again = write(files, folder / "take.h5", sample_take(6));
  REQUIRE_FALSE(again);
  CHECK(to_string(again.error()) ==
        folder / "take.h5" +
            ": expected no file of that name (--force overwrites), found an existing file");
}

TEST_CASE("streams that can't be told apart are refused") {
  const FreshFolder folder;
  PosixFiles files;
  Take take = sample_take(5);
  take.header.groups[1].name = "mocap";
  const auto twice = write(files, folder / "take.h5", take);
  REQUIRE_FALSE(twice);
  CHECK(to_string(twice.error()) == "expected a name for each stream, only once, found \"mocap\"");
  take.header.groups[1].name = "time_ns";
  const auto taken = write(files, folder / "take.h5", take);
  REQUIRE_FALSE(taken);
  CHECK(taken.error().found == "\"time_ns\"");
  CHECK(folder.empty());
}

TEST_CASE("a take whose skeleton is not finite is refused") {
  const FreshFolder folder;
  Take take = sample_take(2);
  auto& skeleton = std::get<ClipGroup>(take.header.groups[0].kind).skeleton;
  skeleton.rest_offsets[1][2] = std::numeric_limits<double>::infinity();
  write_or_fail(folder / "a.h5", take);
  CHECK(to_string(read_through(folder / "a.h5").error()) ==
        (folder / "a.h5") + ": expected finite numbers, found other content in rest_offsets");
  skeleton.rest_offsets[1][2] = 0.0;
  skeleton.end_sites[0].offset[0] = std::numeric_limits<double>::quiet_NaN();
  write_or_fail(folder / "b.h5", take);
  CHECK(to_string(read_through(folder / "b.h5").error()) ==
        (folder / "b.h5") + ": expected finite numbers, found other content in end_sites");
}

namespace {

/// Reads each damaged copy in a child; the result must be a take or an error.
void read_damaged(const FreshFolder& folder, const std::vector<std::string>& copies) {
  int errors = 0;
  int crashes = 0;
  GuardLimits limits;
  limits.memory_bytes = std::uint64_t{512} << 20;
  limits.wall_seconds = 20;
  for (std::size_t i = 0; i < copies.size(); ++i) {
    CAPTURE(i);
    const std::string path = folder.write("damaged.h5", copies[i]);
    const auto read = run_guarded(limits, {path, 0, "a take that HDF5 can read", ""},
                                  [&] { return read_through(path); });
    if (read) continue;
    ++errors;
    CHECK(!read.error().expected.empty());
    if (read.error().found.find("crashed") != std::string::npos) ++crashes;
  }
  MESSAGE(copies.size(), " damaged takes: ", errors, " errors, ", crashes, " of them crashes");
}

}  // namespace

TEST_CASE("a take cut short anywhere is an ordinary error or reads") {
  const FreshFolder folder;
  write_or_fail(folder / "take.h5", sample_take(20));
  const std::string whole = folder.read("take.h5");
  std::vector<std::string> copies;
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 150) {
    copies.push_back(whole.substr(0, size));
  }
  read_damaged(folder, copies);
}

TEST_CASE("a take with bits flipped is an ordinary error or reads") {
  const FreshFolder folder;
  write_or_fail(folder / "take.h5", sample_take(3));
  const std::string whole = folder.read("take.h5");
  std::vector<std::string> copies;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    std::mt19937_64 random(seed);
    std::string& copy = copies.emplace_back(whole);
    for (std::uint64_t flips = 1 + random() % 8; flips > 0; --flips) {
      char& byte = copy[random() % copy.size()];
      byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << random() % 8));
    }
  }
  read_damaged(folder, copies);
}
