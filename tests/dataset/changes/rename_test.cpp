// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/rename.h"

#include "tests/dataset/changes/changed_set.h"

#include "kinalign/dataset/index.h"
#include "kinalign/dataset/take_inputs.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

Result<Renamed> renamed(FileSystem& files, const std::string& folder, const std::string& from,
                        const std::string& to) {
  const Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  return rename_takes(files, folder, KA_TRY(plan_rename(files, folder, catalogue, from, to)));
}

std::string fault(ChangedSet& set, const std::string& from, const std::string& to) {
  const auto before = set.contents();
  const auto done = renamed(set.files, set.folder.path(), from, to);
  REQUIRE(!done);
  CHECK(set.contents() == before);
  std::string text = to_string(done.error());
  for (auto at = text.find(set.folder.path()); at != std::string::npos;
       at = text.find(set.folder.path())) {
    text.replace(at, set.folder.path().size(), "SET");
  }
  return text;
}

}  // namespace

TEST_CASE(
    "a person's new id stands in names, manifests, raw files and dataset.toml, and takes are to be "
    "built") {
  ChangedSet set;
  const auto done = renamed(set.files, set.folder.path(), "sub-01", "sub-11");
  REQUIRE(done);
  CHECK(done->moved == 0);
  CHECK(done->to_build == 2);
  const auto now = set.contents();
  CHECK(now.size() == 1 + 2 * 2 + 4);  // dataset.toml; manifest and raw file; the other take
  CHECK(now.at("sourcedata/sub-11/sub-11_task-S1A02_run-01/mocap.bvh") ==
        "raw of sub-01_task-S1A02_run-01");
  CHECK(now.at("sub-11/sub-11_task-S1A01_run-01_recording.toml") ==
        "# by hand\nsubject = \"11\"  # who\naction = \"S1A01\"\n\n[stream.mocap]\nfile = "
        "\"../sourcedata/sub-11/sub-11_task-S1A01_run-01/mocap.bvh\"  # suit\n");
  CHECK(now.at("dataset.toml")
            .starts_with("# ours\n[subject.11]  # tall\nsex = \"f\"\n[subject.11.segments_m]\nshin "
                         "= 0.4\n[subject.02]"));
  CHECK(!std::filesystem::exists(set.folder / "sub-01"));
  CHECK(!std::filesystem::exists(set.folder / "sourcedata/sub-01"));
}

TEST_CASE("a take that only gets another run keeps its bytes") {
  ChangedSet set;
  const auto done =
      renamed(set.files, set.folder.path(), "sub-02_task-S1A01_run-01", "sub-02_task-S1A01_run-04");
  REQUIRE(done);
  CHECK(done->moved == 1);
  CHECK(done->to_build == 0);
  const auto now = set.contents();
  CHECK(now.at("sub-02/sub-02_task-S1A01_run-04_take.h5") == "take sub-02_task-S1A01_run-01");
  CHECK(now.at("sub-02/sub-02_task-S1A01_run-04_take.json") == "summary sub-02_task-S1A01_run-01");
  CHECK(now.contains("sourcedata/sub-02/sub-02_task-S1A01_run-04/mocap.bvh"));
  CHECK(now.size() == 1 + 3 * 4);
}

TEST_CASE(
    "a rename that is stopped at any call is finished by the same command, with the same files") {
  const std::pair<const char*, const char*> renames[] = {
      {"sub-01", "sub-11"},
      {"S1A01", "S1A09"},
      {"sub-01_task-S1A01_run-01", "sub-01_task-S1A01_run-02"},
      {"sub-01_task-S1A01_run-01", "sub-02_task-S1A02_run-01"}};
  for (const auto& [from, to] : renames) {
    CAPTURE(std::string(from));
    ChangedSet whole;
    REQUIRE(renamed(whole.files, whole.folder.path(), from, to));
    int calls = 0;
    for (bool stopped = true; stopped; ++calls) {
      CAPTURE(calls);
      ChangedSet set;
      StoppingFiles files(calls);
      const auto first = renamed(files, set.folder.path(), from, to);
      stopped = files.stopped();
      CHECK(first.has_value() == !stopped);
      set.drop_unfinished_files();
      const bool begun = std::filesystem::exists(set.folder / unfinished_rename_file);
      if (begun) {
        const auto other =
            plan_rename(set.files, set.folder.path(), Catalogue{}, "sub-02", "sub-12");
        REQUIRE(!other);
        CHECK(other.error().expected.starts_with(
            "the stopped rename to be finished first: kinalign "));
      }
      if (stopped) {
        const auto again = renamed(set.files, set.folder.path(), from, to);
        if (!again) FAIL(to_string(again.error()));
      }
      CHECK(set.contents() == whole.contents());
    }
    CHECK(calls > 6);
  }
}

TEST_CASE("a rename onto what is there changes nothing") {
  ChangedSet set;
  CHECK(fault(set, "sub-01", "sub-02") ==
        "sub-02: expected an id that the data set does not have, found an id that it has");
  CHECK(fault(set, "S1A01", "S1A02") ==
        "task-S1A02: expected an id that the data set does not have, found an id that it has");
  CHECK(fault(set, "sub-01_task-S1A01_run-01", "sub-02_task-S1A01_run-01") ==
        "SET/sub-02/sub-02_task-S1A01_run-01_take.h5: expected no take of the new name, found an "
        "existing take");
  CHECK(fault(set, "sub-01_task-S1A01_run-01", "sub-07_task-S1A01_run-01") ==
        "sub-07_task-S1A01_run-01: expected a subject of dataset.toml, found 07");
  CHECK(fault(set, "sub-01", "sub-../x") ==
        "sub-../x: expected an id of letters and digits, found ../x");
  CHECK(fault(set, "sub-09", "sub-10") ==
        "sub-09: expected a take, a subject (sub-03) or an action of SET, found sub-09");
  std::filesystem::create_directories(set.folder / "sourcedata/sub-02/sub-02_task-S1A01_run-02");
  CHECK(fault(set, "sub-02_task-S1A01_run-01", "sub-02_task-S1A01_run-02") ==
        "SET/sourcedata/sub-02/sub-02_task-S1A01_run-02/: expected no raw files of the new name, "
        "found a folder");
}

TEST_CASE("a take that could not be made again is not renamed to another person") {
  ChangedSet set;
  std::filesystem::remove(set.folder / "sourcedata/sub-02/sub-02_task-S1A01_run-01/mocap.bvh");
  CHECK(fault(set, "sub-02", "sub-12")
            .starts_with(
                "SET/sub-02/../sourcedata/sub-02/sub-02_task-S1A01_run-01/mocap.bvh: "
                "expected the raw file of sub-02_task-S1A01_run-01 (a take's file contains subject"
                " and action"));
  std::filesystem::remove(set.folder / path_of({"02", "S1A01", 1}, TakeFile::manifest));
  CHECK(fault(set, "sub-02", "sub-12").ends_with("found a take that was added as a take"));
}

TEST_CASE("a person whose id was changed in dataset.toml by hand can be renamed") {
  ChangedSet set;
  std::string toml = set.folder.read("dataset.toml");
  toml.replace(toml.find("[subject.02]"), 12, "[subject.12]");
  set.folder.write("dataset.toml", toml);
  REQUIRE(renamed(set.files, set.folder.path(), "sub-02", "sub-12"));
  CHECK(set.folder.read("dataset.toml") == toml);
  CHECK(set.contents().contains("sub-12/sub-12_task-S1A01_run-01_recording.toml"));
}
