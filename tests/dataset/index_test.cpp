// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/index.h"

#include "tests/folder.h"

#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/take_summary.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace kinalign;

namespace {

/// A data set in which only the takes' summaries exist.
class Listed {
 public:
  Listed() {
    folder.write("dataset.toml",
                 "[subject.01]\nsex = \"f\"\nheight_cm = 165\n[subject.02]\nsex = \"m\"\n"
                 "height_cm = 180\n[class.S1]\nname = \"walking\"\n[class.S2]\nname = \"dance\"\n"
                 "[action.S1A01]\nclass = \"S1\"\n[action.S2A01]\nclass = \"S2\"\n");
  }

  void put(const TakeName& name, std::uint64_t frames, bool has_imu = false) {
    TakeSummary take;
    take.subject = name.subject;
    take.action = name.action;
    take.frames = frames;
    take.rate_hz = 60.0;
    take.sha256 = std::string(64, 'a');
    take.streams.resize(has_imu ? 2 : 1);
    take.streams[0].name = "mocap";
    if (has_imu) {
      take.streams[1].name = "imu";
      take.streams[1].modality = Modality::imu;
      take.streams[1].valid = 0.5;
    }
    std::filesystem::create_directories(folder / ("sub-" + name.subject));
    folder.write(path_of(name, TakeFile::summary), summary_json(take));
  }

  DatasetIndex open() {
    auto index = DatasetIndex::open(files, folder.path());
    if (!index) FAIL(to_string(index.error()));
    return *std::move(index);
  }

  FreshFolder folder;
  PosixFiles files;
};

std::int64_t number(const DatasetIndex& index, const std::string& sql) {
  const auto table = index.select(sql);
  if (!table) FAIL(to_string(table.error()));
  return std::get<std::int64_t>(table->rows.at(0).at(0));
}

}  // namespace

TEST_CASE("the index has each take with its person, its class and the frames of each modality") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  set.put({"02", "S2A01", 1}, 900, true);
  const DatasetIndex index = set.open();
  const auto table = index.select(
      "select name, sex, height_cm, class, class_name, seconds, mocap, kinect, imu from takes "
      "order by name");
  REQUIRE(table);
  REQUIRE(table->rows.size() == 2);
  CHECK(table->rows[1] == std::vector<Cell>{std::string("sub-02_task-S2A01_run-01"),
                                            std::string("m"), 180.0, std::string("S2"),
                                            std::string("dance"), 15.0, std::int64_t{900},
                                            std::int64_t{0}, std::int64_t{900}});
  CHECK(number(index, "select count(*) from streams where valid < 1") == 1);
  const auto all = index.select("select * from takes");
  REQUIRE(all);
  REQUIRE(all->columns.size() == DatasetIndex::columns().size());
  for (std::size_t c = 0; c < all->columns.size(); ++c) {
    CHECK(all->columns[c].key == DatasetIndex::columns()[c].key);
  }
}

TEST_CASE("what is added, changed or gone is seen when the index is opened again") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  CHECK(number(set.open(), "select count(*) from takes") == 1);
  set.put({"01", "S1A01", 2}, 700);
  set.put({"02", "S1A01", 1}, 800);
  CHECK(number(set.open(), "select sum(frames) from takes") == 2'100);
  set.put({"01", "S1A01", 2}, 750);
  CHECK(number(set.open(), "select sum(frames) from takes") == 2'150);
  std::filesystem::remove(set.folder / path_of({"01", "S1A01", 1}, TakeFile::summary));
  CHECK(number(set.open(), "select sum(frames) from takes") == 1'550);
  std::filesystem::remove_all(set.folder / "sub-02");
  CHECK(number(set.open(), "select sum(frames) from takes") == 750);
  CHECK(number(set.open(), "select count(*) from streams") == 1);
}

TEST_CASE("an action that moves to another class takes its takes along") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  CHECK(number(set.open(), "select count(*) from takes where class = 'S1'") == 1);
  std::string toml = set.folder.read("dataset.toml");
  toml.replace(toml.find("[action.S1A01]\nclass = \"S1\""), 27, "[action.S1A01]\nclass = \"S2\"");
  set.folder.write("dataset.toml", toml);
  CHECK(number(set.open(), "select count(*) from takes where class = 'S2'") == 1);
}

TEST_CASE("a summary that can't be read is a finding, and hides no other take") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  set.folder.write(path_of({"01", "S1A01", 2}, TakeFile::summary), "{");
  const DatasetIndex index = set.open();
  CHECK(number(index, "select count(*) from takes") == 1);
  REQUIRE(index.findings().size() == 1);
  CHECK(index.findings()[0].what.file == "sub-01/sub-01_task-S1A01_run-02_take.json");
  CHECK(set.open().findings().size() == 1);  // until the take is repaired
}

TEST_CASE("a person's folder that can't be read is an error, and the index stays") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  (void)set.open();
  // The user root can read any other folder.
  std::filesystem::create_symlink("sub-02", set.folder / "sub-02");
  const auto index = DatasetIndex::open(set.files, set.folder.path());
  REQUIRE(!index);
  CHECK(index.error().file == set.folder / "sub-02");
  CHECK(index.error().expected == "a folder that can be read");
  CHECK(std::filesystem::exists(set.folder / index_file));
  CHECK(!scan_takes(set.folder.path()));
}

TEST_CASE("an index that is damaged or of another program is made again") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  (void)set.open();
  const std::string path(index_file);
  for (const std::string& bytes :
       {std::string(5'000, 'x'), std::string(), set.folder.read(path).substr(0, 3'000)}) {
    set.folder.write(path, bytes);
    CHECK(number(set.open(), "select count(*) from takes") == 1);
  }
}

TEST_CASE("a statement that is no reading is refused") {
  Listed set;
  set.put({"01", "S1A01", 1}, 600);
  const DatasetIndex index = set.open();
  for (const std::string sql : {"delete from take", "insert into class values('a','b')",
                                "drop table take", "pragma user_version = 3", "attach 'x' as y",
                                "begin", "vacuum", "select 1; delete from take", "", "select"}) {
    CAPTURE(sql);
    CHECK_FALSE(index.select(sql));
  }
  CHECK(number(index, "select count(*) from takes") == 1);
}
