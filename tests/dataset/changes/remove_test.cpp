// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/remove.h"

#include "tests/dataset/changes/changed_set.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

Result<void> removed(FileSystem& files, const std::string& folder,
                     const std::vector<std::string>& names, bool with_raw) {
  return remove_takes(files, folder, KA_TRY(plan_removal(files, folder, names, with_raw)));
}

}  // namespace

TEST_CASE(
    "a take goes with its manifest, its summary and its page; its raw files only where that is "
    "asked for") {
  ChangedSet set;
  const TakeName name{"01", "S1A01", 1};
  set.folder.write("report/" + to_string(name) + ".html", "page");
  const auto plan = plan_removal(set.files, set.folder.path(), {to_string(name)}, false);
  REQUIRE(plan);
  CHECK(plan->files.size() == 4);
  CHECK(plan->raw_left == std::vector<std::string>{raw_folder(name)});
  std::uint64_t bytes = 0;
  for (const std::string& file : plan->files) bytes += set.folder.read(file).size();
  CHECK(plan->bytes == bytes);
  REQUIRE(remove_takes(set.files, set.folder.path(), *plan));
  CHECK(set.contents().size() == 1 + 2 * 4 + 1);
  REQUIRE(removed(set.files, set.folder.path(), {to_string(name)}, true));
  CHECK(set.contents().size() == 1 + 2 * 4);
  CHECK(!std::filesystem::exists(set.folder / raw_folder(name)));
}

TEST_CASE("a person goes with all takes and raw files, and dataset.toml stays as it is") {
  ChangedSet set;
  const std::string toml = set.folder.read("dataset.toml");
  REQUIRE(removed(set.files, set.folder.path(), {"sub-01"}, true));
  CHECK(set.contents().size() == 1 + 4);
  CHECK(set.folder.read("dataset.toml") == toml);
  CHECK(!std::filesystem::exists(set.folder / "sourcedata/sub-01"));
  CHECK(!std::filesystem::exists(set.folder / "sub-01"));
}

TEST_CASE("a removal that is stopped at any call is finished by the same command") {
  ChangedSet whole;
  REQUIRE(removed(whole.files, whole.folder.path(), {"sub-01", "sub-02_task-S1A01_run-01"}, true));
  bool stopped = true;
  int calls = 0;
  for (; stopped; ++calls) {
    ChangedSet set;
    StoppingFiles files(calls);
    (void)removed(files, set.folder.path(), {"sub-01", "sub-02_task-S1A01_run-01"}, true);
    stopped = files.stopped();
    if (stopped) {
      REQUIRE(removed(set.files, set.folder.path(), {"sub-01", "sub-02_task-S1A01_run-01"}, true));
    }
    CHECK(set.contents() == whole.contents());
  }
  CHECK(calls > 12);
}

TEST_CASE("no link is followed: what lies elsewhere stays") {
  ChangedSet set;
  const FreshFolder elsewhere;
  elsewhere.write("precious.bvh", "raw");
  const TakeName name{"01", "S1A01", 1};
  std::filesystem::create_symlink(elsewhere.path(), set.folder / (raw_folder(name) + "more"));
  std::filesystem::create_symlink(elsewhere / "precious.bvh",
                                  set.folder / (raw_folder(name) + "one.bvh"));
  const auto plan = plan_removal(set.files, set.folder.path(), {to_string(name)}, true);
  REQUIRE(plan);
  CHECK(plan->files.size() == 3 + 1 + 2);  // the raw file and both links
  REQUIRE(removed(set.files, set.folder.path(), {to_string(name)}, true));
  CHECK(elsewhere.read("precious.bvh") == "raw");
  CHECK(!std::filesystem::exists(set.folder / raw_folder(name)));

  const std::string other = set.folder / "sourcedata/sub-02";
  std::filesystem::rename(other, elsewhere / "sub-02");
  std::filesystem::create_symlink(elsewhere / "sub-02", other);
  const auto refused = removed(set.files, set.folder.path(), {"sub-02"}, true);
  REQUIRE(!refused);
  CHECK(refused.error().found == "a link to another place");
  CHECK(elsewhere.read("sub-02/sub-02_task-S1A01_run-01/mocap.bvh").starts_with("raw of"));
}

TEST_CASE("raw files that another take is made of are not removed") {
  ChangedSet set;
  const std::string other = path_of({"02", "S1A01", 1}, TakeFile::manifest);
  set.folder.write(
      other, "[stream.mocap]\nfile = \"../" + raw_folder({"01", "S1A01", 1}) + "mocap.bvh\"\n");
  const auto before = set.contents();
  const auto done = removed(set.files, set.folder.path(), {"sub-01"}, true);
  REQUIRE(!done);
  CHECK(to_string(done.error()) ==
        other +
            ": expected no raw files of sub-01_task-S1A01_run-01, which would be removed, found "
            "sourcedata/sub-01/sub-01_task-S1A01_run-01/");
  CHECK(set.contents() == before);
}

TEST_CASE("unknown names are reported, and are an error if all are unknown") {
  ChangedSet set;
  const auto plan = plan_removal(set.files, set.folder.path(), {"sub-02", "sub-33"}, false);
  REQUIRE(plan);
  CHECK(plan->unknown == std::vector<std::string>{"sub-33"});
  const auto none = plan_removal(set.files, set.folder.path(), {"sub-01_task-S1A01_run-9"}, false);
  REQUIRE(!none);
  CHECK(none.error().expected.find("nearest: sub-01_task-S1A01_run-01") != std::string::npos);
}

namespace {

const std::string unpacked = "sourcedata/s05-0c951d0c/";

/// A data set whose takes of person 01 are made from an unpacked corpus; one file belongs to both
/// takes.
void put_unpacked(const ChangedSet& set) {
  for (const char* file : {"Vicon/a.bvh", "Vicon/b.bvh", "both.bvh", "readme.txt"}) {
    set.folder.write(unpacked + file, "raw");
  }
  const auto manifest = [&](const char* action, const std::string& own) {
    set.folder.write(path_of({"01", action, 1}, TakeFile::manifest),
                     "[stream.mocap]\nfile = \"../" + unpacked + own +
                         "\"\n[stream.other]\nfile = \"../" + unpacked + "both.bvh\"\n");
  };
  manifest("S1A01", "Vicon/a.bvh");
  manifest("S1A02", "Vicon/b.bvh");
}

}  // namespace

TEST_CASE("raw files of an unpacked corpus go with the last take that is made of them") {
  const ChangedSet set;
  PosixFiles files;
  put_unpacked(set);
  const auto kept = plan_removal(files, set.folder.path(), {"sub-01_task-S1A01_run-01"}, false);
  REQUIRE(kept);
  CHECK(kept->raw_left.size() == 3);  // both.bvh, a.bvh and the folder of the take
  CHECK(kept->raw_left.back() == unpacked + "Vicon/a.bvh");

  const auto one = plan_removal(files, set.folder.path(), {"sub-01_task-S1A01_run-01"}, true);
  REQUIRE(one);
  CHECK(one->raw_shared == std::vector<std::string>{unpacked + "both.bvh"});
  REQUIRE(remove_takes(files, set.folder.path(), *one));
  CHECK(!set.contents().contains(unpacked + "Vicon/a.bvh"));
  CHECK(set.contents().contains(unpacked + "Vicon/b.bvh"));
  CHECK(set.contents().contains(unpacked + "both.bvh"));

  REQUIRE(removed(files, set.folder.path(), {"sub-01"}, true));
  CHECK(!std::filesystem::exists(set.folder / (unpacked + "Vicon")));
  CHECK(!set.contents().contains(unpacked + "both.bvh"));
  CHECK(set.contents().contains(unpacked + "readme.txt"));  // no take is made from it
}

TEST_CASE("folders of raw files go once they are empty") {
  const ChangedSet set;
  PosixFiles files;
  put_unpacked(set);
  std::filesystem::remove(set.folder / (unpacked + "readme.txt"));
  REQUIRE(removed(files, set.folder.path(), {"sub-01", "sub-02"}, true));
  CHECK(set.contents().size() == 1);
  CHECK(!std::filesystem::exists(set.folder / "sourcedata"));
}

TEST_CASE("a removal of unpacked raw files that is stopped at any call is finished by the same") {
  for (int calls = 0, stopped = 1; stopped != 0; ++calls) {
    const ChangedSet set;
    put_unpacked(set);
    StoppingFiles stopping(calls);
    PosixFiles files;
    (void)removed(stopping, set.folder.path(), {"sub-01"}, true);
    stopped = stopping.stopped() ? 1 : 0;
    if (stopped != 0) REQUIRE(removed(files, set.folder.path(), {"sub-01"}, true));
    CHECK(set.contents().size() == 1 + 4 + 1);  // dataset.toml, the take of 02, readme.txt
  }
}

TEST_CASE("inputs that a link leads to elsewhere stay, and so does the target of a take's link") {
  const ChangedSet set;
  PosixFiles files;
  put_unpacked(set);
  const FreshFolder elsewhere;
  elsewhere.write("a.bvh", "precious");
  std::filesystem::remove_all(set.folder / (unpacked + "Vicon"));
  std::filesystem::create_directory_symlink(elsewhere.path(), set.folder / (unpacked + "Vicon"));
  set.folder.write(path_of({"02", "S1A01", 1}, TakeFile::manifest),
                   "[stream.mocap]\nfile = \"../sourcedata/linked.bvh\"\n");
  std::filesystem::create_symlink(set.folder / (unpacked + "both.bvh"),
                                  set.folder / "sourcedata/linked.bvh");
  REQUIRE(removed(files, set.folder.path(), {"sub-01"}, true));
  CHECK(elsewhere.read("a.bvh") == "precious");
  CHECK(std::filesystem::is_symlink(set.folder / (unpacked + "Vicon")));
  CHECK(set.folder.read(unpacked + "both.bvh") == "raw");
}

TEST_CASE("raw files stay where another take's manifest can't be read") {
  const ChangedSet set;
  PosixFiles files;
  put_unpacked(set);
  set.folder.write(path_of({"02", "S1A01", 1}, TakeFile::manifest), "[stream.mocap\n");
  const auto before = set.contents();
  CHECK(!removed(files, set.folder.path(), {"sub-01"}, true));
  CHECK(set.contents() == before);
  CHECK(removed(files, set.folder.path(), {"sub-01"}, false));
}

TEST_CASE("raw files that the user put below sourcedata stay, and are named") {
  const ChangedSet set;
  PosixFiles files;
  const std::string own = "sourcedata/monday/walk.bvh", other = "sourcedata/my-walks/walk.bvh";
  for (const std::string& file : {own, other}) set.folder.write(file, "the only copy");
  set.folder.write(
      path_of({"01", "S1A01", 1}, TakeFile::manifest),
      "[stream.mocap]\nfile = \"../" + own + "\"\n[stream.other]\nfile = \"../" + other + "\"\n");
  for (const bool with_raw : {false, true}) {
    const auto plan = plan_removal(files, set.folder.path(), {"sub-01"}, with_raw);
    REQUIRE(plan);
    CHECK(plan->raw_kept == std::vector<std::string>{other, own});
    CHECK(plan->raw_left.size() == (with_raw ? 0 : 2));  // the takes' own folders
  }
  REQUIRE(removed(files, set.folder.path(), {"sub-01"}, true));
  CHECK(set.folder.read(own) == "the only copy");
  CHECK(set.folder.read(other) == "the only copy");
  CHECK(!std::filesystem::exists(set.folder / "sub-01"));
}

TEST_CASE("raw files of a take whose manifest can't be read are not forgotten") {
  const ChangedSet set;
  PosixFiles files;
  put_unpacked(set);
  const TakeName name{"01", "S1A01", 1};
  set.folder.write(path_of(name, TakeFile::manifest), "[stream.mocap\n");
  const auto before = set.contents();
  const auto failed = removed(files, set.folder.path(), {to_string(name)}, true);
  REQUIRE(!failed);
  CHECK(failed.error().file == path_of(name, TakeFile::manifest));
  CHECK(failed.error().expected.starts_with("a manifest that lists the raw files to remove"));
  CHECK(set.contents() == before);
  CHECK(removed(files, set.folder.path(), {to_string(name)}, false));
  CHECK(set.contents().contains(unpacked + "Vicon/a.bvh"));
}
