// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recording_disk.h"

#include "tests/capture/recorder/failing_disks.h"
#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"

#include "kinalign/recording/format.h"

#include <doctest/doctest.h>

#include <set>

using namespace kinalign;

namespace {

RecordingHead head(int part) {
  return {{"kinalign", "test"},
          {{"kinalign.recording", {{"part", std::to_string(part)}}}},
          {{0, 0, "lab.toml", "application/toml", "[streams.mocap]\n"}}};
}

McapStoredChunk chunk(std::uint32_t from, std::uint32_t to) {
  McapChunkContent content;
  for (std::uint32_t k = from; k < to; ++k) add(content, nth_message(k));
  return store(content, McapCompression::none);
}

/// The numbers of the messages in the files; all but the last file may be torn.
struct Found {
  std::set<std::uint32_t> sequences;
  std::vector<bool> closed;
};
Found found_in(const std::vector<std::string>& paths) {
  Found found;
  for (const std::string& path : paths) {
    const ReadMcap read = read_mcap(bytes_in(path));
    CHECK(read.findings.empty());
    for (const OwnedMessage& m : read.messages) {
      CHECK(m.data == nth_message(m.message.sequence).data);
      found.sequences.insert(m.message.sequence);
    }
    found.closed.push_back(read.closed);
  }
  return found;
}

/// Writes chunks of ten messages each with a sync after each; gives the number of messages that
/// were accepted.
struct Written {
  std::uint32_t messages = 0;
  bool finished = false;
  std::vector<std::string> paths;
  std::vector<PartFailure> failures;
};
Written write_chunks(FileSystem& files, const std::string& path) {
  Written written;
  auto disk = RecordingDisk::open(files, path, head);
  if (!disk) return written;
  for (std::uint32_t i = 0; i < 5; ++i) {
    (void)disk->write(chunk(10 * i, 10 * i + 10));
    written.messages += 10;
    if (const auto sync = disk->unsynced()) (void)disk->synced(*sync, sync->file->sync());
  }
  written.finished = disk->finish(to_metadata(RecordingEnd{})).has_value();
  written.paths = disk->paths();
  written.failures = disk->take_failures();
  return written;
}

}  // namespace

TEST_CASE("a recording is one file that other readers can open at any time") {
  const FreshFolder folder;
  PosixFiles files;
  const Written written = write_chunks(files, folder / "a.mcap");
  CHECK(written.finished);
  CHECK(written.paths == std::vector<std::string>{folder / "a.mcap"});
  const Found found = found_in(written.paths);
  CHECK(found.sequences.size() == 50);
  CHECK(found.closed == std::vector<bool>{true});
}

TEST_CASE("after a failed sync all that was not synced stands in the next file") {
  const FreshFolder folder;
  PosixFiles files;
  auto disk = RecordingDisk::open(files, folder / "a.mcap", head);
  REQUIRE(disk);
  CHECK(disk->write(chunk(0, 10)));
  auto sync = disk->unsynced();
  REQUIRE(sync);
  CHECK(disk->synced(*sync, sync->file->sync()));
  CHECK(!disk->unsynced());
  CHECK(disk->write(chunk(10, 20)));
  sync = disk->unsynced();
  CHECK(disk->write(chunk(20, 30)));  // while it is synced
  CHECK(disk->synced(*sync, Failure(Error{"a.mcap", 0, "data that reach the disk", "I/O error"})));
  CHECK(disk->write(chunk(30, 40)));
  CHECK(disk->finish(to_metadata(RecordingEnd{})));

  CHECK(disk->paths() == std::vector<std::string>{folder / "a.mcap", folder / "a.part2.mcap"});
  const auto failures = disk->take_failures();
  REQUIRE(failures.size() == 1);
  CHECK(failures[0].next == folder / "a.part2.mcap");
  CHECK(found_in({folder / "a.part2.mcap"}).sequences.size() == 30);  // 10 to 39
  CHECK(found_in(disk->paths()).sequences.size() == 40);
}

TEST_CASE("where every sync fails there are two files, the second with all that came") {
  const FreshFolder folder;
  FailingSyncs files;
  auto disk = RecordingDisk::open(files, folder / "a.mcap", head);
  REQUIRE(disk);
  for (std::uint32_t i = 0; i < 20; ++i) {
    CHECK(disk->write(chunk(10 * i, 10 * i + 10)));
    const auto sync = disk->unsynced();
    REQUIRE(sync);
    CHECK(disk->synced(*sync, Failure(Error{})));
    REQUIRE(disk->paths().size() == 2);
    CHECK(found_in({disk->paths()[1]}).sequences.size() == 10 * i + 10);
    CHECK(disk->bytes() == folder.read("a.mcap").size() + bytes_in(disk->paths()[1]).size());
  }
  CHECK(folder.names().size() == 2);
  files.fails = true;
  for (int i = 0; i < 10; ++i) {
    CHECK(!disk->finish(to_metadata(RecordingEnd{})));
    CHECK(folder.names().size() == 2);
    REQUIRE(disk->paths().size() == 2);
    CHECK(found_in({disk->paths()[1]}).sequences.size() == 200);
    CHECK(disk->bytes() == folder.read("a.mcap").size() + bytes_in(disk->paths()[1]).size());
  }
  CHECK(disk->take_failures().size() < 25);  // 20 while it recorded
  files.fails = false;
  const int before = files.synced;
  CHECK(disk->finish(to_metadata(RecordingEnd{})));
  CHECK(files.synced > before);  // the syncs that failed do not count: the file is synced again
  CHECK(disk->unwritten() == 0);
  CHECK(folder.names().size() == 2);
  CHECK(found_in({disk->paths()[1]}).sequences.size() == 200);
}

TEST_CASE("a recording never takes another's place") {
  const FreshFolder folder;
  PosixFiles files;
  folder.write("a.mcap", "kept");
  CHECK(!RecordingDisk::open(files, folder / "a.mcap", head));
  CHECK(folder.read("a.mcap") == "kept");
}

TEST_CASE("a part that an earlier recording left takes its number, and nothing more") {
  const FreshFolder folder;
  PosixFiles files;
  folder.write("a.part2.mcap", "kept");
  folder.write("a.part3.mcap", "kept, too");
  auto disk = RecordingDisk::open(files, folder / "a.mcap", head);
  REQUIRE(disk);
  CHECK(disk->write(chunk(0, 10)));
  const auto sync = disk->unsynced();
  REQUIRE(sync);
  CHECK(disk->synced(*sync, Failure(Error{})));
  CHECK(disk->finish(to_metadata(RecordingEnd{})));
  CHECK(disk->paths() == std::vector<std::string>{folder / "a.mcap", folder / "a.part4.mcap"});
  CHECK(found_in({folder / "a.part4.mcap"}).sequences.size() == 10);
  CHECK(folder.read("a.part2.mcap") == "kept");
}

TEST_CASE("whichever call fails, nothing is lost and every file is in order") {
  for (const int code : {ENOSPC, EIO, EINTR}) {
    for (int fail_at = 1;; ++fail_at) {
      CAPTURE(code);
      CAPTURE(fail_at);
      const FreshFolder folder;
      FaultyFiles files;
      files.fail_at = fail_at;
      files.code = code;
      const Written written = write_chunks(files, folder / "a.mcap");
      if (code == EINTR) CHECK(written.failures.empty());
      if (written.messages > 0) {
        CHECK(written.finished);
        const Found found = found_in(written.paths);
        CHECK(found.sequences.size() == 50);
        CHECK(found.closed.back());
        // Only the first call may fail before anything is reported: then there is no recording.
        CHECK((written.paths.size() == 1) == written.failures.empty());
      } else {
        CHECK(folder.empty());  // no unfinished file is left
      }
      if (!files.failed()) break;
    }
  }
}

TEST_CASE("a disk that refuses everything for a while loses nothing") {
  const FreshFolder folder;
  FullDisk files;
  auto disk = RecordingDisk::open(files, folder / "a.mcap", head);
  REQUIRE(disk);
  CHECK(disk->write(chunk(0, 10)));
  files.full = true;
  CHECK(!disk->write(chunk(10, 20)));
  CHECK(!disk->write(chunk(20, 30)));
  CHECK(!disk->write(chunk(30, 35)));
  const auto told = disk->take_failures();  // reported once, however often it is tried
  REQUIRE(told.size() == 1);
  CHECK(told[0].next.empty());
  files.full = false;
  CHECK(disk->write(chunk(35, 40)));
  const auto then = disk->take_failures();
  REQUIRE(then.size() == 1);
  CHECK(then[0].next == folder / "a.part2.mcap");
  CHECK(disk->finish(to_metadata(RecordingEnd{})));
  CHECK(disk->take_failures().empty());
  CHECK(found_in(disk->paths()).sequences.size() == 40);
}

TEST_CASE("a disk that takes names and no data does not fill with files") {
  struct Full : PosixFiles {
    bool full = false;
    ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
      if (!full || size < 1000) return PosixFiles::write_at(fd, data, size, at);
      errno = ENOSPC;
      return -1;
    }
  };
  const FreshFolder folder;
  Full files;
  auto disk = RecordingDisk::open(files, folder / "a.mcap", head);
  REQUIRE(disk);
  CHECK(disk->write(chunk(0, 100)));
  files.full = true;
  for (std::uint32_t i = 1; i < 10; ++i) CHECK(!disk->write(chunk(100 * i, 100 * i + 100)));
  CHECK(disk->paths().size() == 1);
  CHECK(folder.names().size() == 1);
  CHECK(disk->take_failures().size() == 1);
  files.full = false;
  CHECK(disk->write(chunk(1000, 1100)));
  CHECK(disk->finish(to_metadata(RecordingEnd{})));
  CHECK(disk->paths().size() == 2);
  CHECK(disk->bytes() == folder.read("a.mcap").size() + folder.read("a.part2.mcap").size());
  CHECK(found_in(disk->paths()).sequences.size() == 1100);
}

TEST_CASE("a sync that succeeds after one that failed proves nothing") {
  struct NoNewFile : PosixFiles {
    bool refuses = false;
    int open(const char* path, int flags, mode_t mode) override {
      if (!refuses) return PosixFiles::open(path, flags, mode);
      errno = EIO;
      return -1;
    }
  };
  const FreshFolder folder;
  NoNewFile files;
  auto disk = RecordingDisk::open(files, folder / "a.mcap", head);
  REQUIRE(disk);
  CHECK(disk->write(chunk(0, 10)));
  const auto sync = disk->unsynced();
  REQUIRE(sync);
  files.refuses = true;
  CHECK(!disk->synced(*sync, Failure(Error{})));
  CHECK(!disk->unsynced());
  CHECK(disk->synced(*sync, {}));  // for the file that was given up
  CHECK(disk->kept_bytes() > 0);
  files.refuses = false;
  CHECK(disk->write(chunk(10, 20)));
  CHECK(disk->finish(to_metadata(RecordingEnd{})));
  CHECK(disk->kept_bytes() == 0);
  CHECK(found_in({disk->paths().back()}).sequences.size() == 20);
}
