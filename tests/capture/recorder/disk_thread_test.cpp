// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/disk_thread.h"

#include "tests/capture/recorder/failing_disks.h"
#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/capture/recorder/recorder.h"
#include "kinalign/recording/survey.h"

#include <doctest/doctest.h>

#include <atomic>
#include <filesystem>
#include <future>

using namespace kinalign;

namespace {

McapChunkContent chunk(std::uint32_t from, std::uint32_t to) {
  McapChunkContent content;
  for (std::uint32_t k = from; k < to; ++k) add(content, nth_message(k));
  return content;
}

DiskThread::Open opening(FileSystem& files, const std::string& path) {
  return [&files, path] {
    return RecordingDisk::open(files, path, [](int) {
      return RecordingHead{{"kinalign", "test"}, {}, {}};
    });
  };
}

template <class Holds>
void wait_until(const Holds& holds) {
  while (!holds()) std::this_thread::yield();  // CTest's own limit ends a test that hangs
}

/// A gate at which every attempt to begin a file waits until the test opens it.
struct Gate {
  std::promise<void> stands_still;
  std::shared_future<void> goes_on = stands_still.get_future().share();
};

/// Syncs that last until the test releases them, or fail.
struct SlowSync : PosixFiles {
  std::atomic<bool> slow{false}, fails{false};
  std::atomic<int> waiting{0}, over{0};

  int sync(int fd) override {
    ++waiting;
    while (slow) std::this_thread::yield();
    --waiting;
    const bool failed = fails.exchange(false);
    ++over;
    if (!failed) return PosixFiles::sync(fd);
    errno = EIO;
    return -1;
  }
};

}  // namespace

TEST_CASE("all that was pushed stands in the file, in order") {
  const FreshFolder folder;
  PosixFiles files;
  {
    DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::zstd);
    REQUIRE(thread.start());
    for (std::uint32_t i = 0; i < 100; ++i) thread.push(chunk(10 * i, 10 * i + 10));
    thread.finish();
    wait_until([&] { return thread.status().finished; });
    CHECK(thread.status().waiting_bytes == 0);
    CHECK(!thread.status().refused);
    CHECK(thread.status().bytes == folder.read("a.mcap").size());
  }
  const ReadMcap read = read_mcap(folder.read("a.mcap"));
  CHECK(read.closed);
  REQUIRE(read.messages.size() == 1000);
  for (std::uint32_t k = 0; k < 1000; ++k) CHECK(read.messages[k].message.sequence == k);
}

TEST_CASE("while a sync lasts what comes is written all the same") {
  const FreshFolder folder;
  SlowSync files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return files.over == 2; });  // its head's and its folder's
  files.slow = true;
  thread.push(chunk(0, 10));
  wait_until([&] { return files.waiting == 1; });
  thread.push(chunk(10, 20));
  wait_until([&] { return read_mcap(folder.read("a.mcap")).messages.size() == 20; });
  CHECK(files.waiting == 1);
  CHECK(thread.status().waiting_bytes > 0);
  files.slow = false;
  wait_until([&] { return thread.status().waiting_bytes == 0; });
}

TEST_CASE("who begins a recording asks nothing of the disk, and its name is synced all the same") {
  struct Watched : PosixFiles {
    std::thread::id receiver = std::this_thread::get_id();
    std::atomic<int> by_receiver{0}, synced{0};
    int open(const char* path, int flags, mode_t mode) override {
      note();
      return PosixFiles::open(path, flags, mode);
    }
    ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
      note();
      return PosixFiles::write_at(fd, data, size, at);
    }
    int sync(int fd) override {
      note();
      ++synced;
      return PosixFiles::sync(fd);
    }
    void note() { by_receiver += std::this_thread::get_id() == receiver ? 1 : 0; }
  };
  const FreshFolder folder;
  Watched files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return files.synced == 2; });  // the file's and the folder's, before any chunk
  CHECK(files.by_receiver == 0);
  wait_until([&] { return thread.status().free_bytes.has_value(); });
}

TEST_CASE("what was pushed is synced within half a second, without anything that comes behind it") {
  struct CountedSyncs : PosixFiles {
    std::atomic<int> begun{0};
    int sync(int) override {  // returns at once, because the thread's own delay is tested
      ++begun;
      return 0;
    }
  };
  using Clock = std::chrono::steady_clock;
  const FreshFolder folder;
  CountedSyncs files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return files.begun == 2 && thread.status().waiting_bytes == 0; });
  int in_time = 0;
  for (std::uint32_t i = 0; i < 5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the thread has nothing to do
    const auto pushed = Clock::now();
    thread.push(chunk(10 * i, 10 * i + 10));
    wait_until([&] { return files.begun == 3 + static_cast<int>(i); });
    in_time += Clock::now() - pushed < std::chrono::milliseconds(500) ? 1 : 0;
  }
  CHECK(in_time >=
        3);  // a busy machine may delay a look; five late looks are allowed for one a second
}

TEST_CASE("a file that can't be begun is begun as soon as it can, with all that came meanwhile") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder / "later/a.mcap";
  DiskThread thread(opening(files, path), McapCompression::none);
  REQUIRE(thread.start());
  thread.push(chunk(0, 10));
  wait_until([&] { return thread.status().refused.has_value(); });
  CHECK(!thread.status().finished);
  std::filesystem::create_directory(folder / "later");
  wait_until([&] { return !thread.status().paths.empty(); });
  thread.push(chunk(10, 20));
  thread.finish();
  wait_until([&] { return thread.status().finished; });
  CHECK(!thread.status().refused);
  CHECK(read_mcap(folder.read("later/a.mcap")).messages.size() == 20);
}

TEST_CASE("a file that can't be begun is told, and given up when nobody wants it any more") {
  const FreshFolder folder;
  PosixFiles files;
  DiskThread thread(opening(files, folder / "none/a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  thread.push(chunk(0, 10));
  wait_until([&] { return thread.status().refused.has_value(); });
  thread.give_up();
  wait_until([&] { return thread.status().finished; });
  CHECK(thread.status().paths.empty());
  REQUIRE(thread.status().refused);
  CHECK(thread.status().refused->file == folder / "none/a.mcap");
  CHECK(folder.names().empty());
}

TEST_CASE("a take that begins with a full pre-roll loses nothing while its file is begun") {
  const RecorderOptions options{.chunk_bytes = std::size_t{16} << 20,
                                .pre_roll = std::chrono::hours(1)};
  Recorder recorder(options);
  const auto channel = recorder.add_channel({0, 0, "/topic1", "json", {}});
  const std::string payload(std::size_t{1} << 20, 'x');
  const auto record_bytes = [&](std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += payload.size()) {
      recorder.record(channel, HostTime{}, payload);
      recorder.tick(HostTime{});
    }
  };
  record_bytes(options.pre_roll_bytes + (std::size_t{32} << 20));
  Gate gate;
  DiskThread thread(
      [goes_on = gate.goes_on]() -> Result<RecordingDisk> {
        goes_on.wait();
        return Failure(Error{"a.mcap", 0, "a disk", "none"});
      },
      McapCompression::none);
  REQUIRE(thread.start());
  recorder.start(HostTime{}, [&](McapChunkContent kept) { thread.push(std::move(kept)); });
  record_bytes(std::size_t{32} << 20);
  recorder.stop();
  const DiskStatus status = thread.status();
  gate.stands_still.set_value();
  CHECK(status.dropped == 0);
  CHECK(status.waiting_bytes > options.pre_roll_bytes);
}

TEST_CASE("what is pushed before it is started waits, and is lost where it is given up") {
  const FreshFolder folder;
  PosixFiles files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  thread.push(chunk(0, 10));
  thread.finish();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(folder.names().empty());
  CHECK_FALSE(thread.status().finished);
  REQUIRE(thread.start());
  wait_until([&] { return thread.status().finished; });
  CHECK(read_mcap(folder.read("a.mcap")).messages.size() == 10);

  DiskThread given_up(opening(files, folder / "b.mcap"), McapCompression::none);
  given_up.push(chunk(0, 10));
  given_up.give_up();
  CHECK(given_up.status().finished);
  CHECK(given_up.status().dropped == 10);
  CHECK(given_up.status().waiting_bytes == 0);
}

TEST_CASE("what has no room beside other takes is dropped and counted") {
  const FreshFolder folder;
  PosixFiles files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  thread.push(chunk(0, 10), 10);
  CHECK(thread.status().dropped == 10);
  thread.push(chunk(10, 20));
  thread.finish();
  wait_until([&] { return thread.status().finished; });
  CHECK(read_mcap(folder.read("a.mcap")).messages.size() == 10);
}

TEST_CASE("what memory had no room for is counted, in the file too") {
  const FreshFolder folder;
  PosixFiles files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  thread.push(chunk(0, 10));
  McapChunkContent more_than_all;
  const std::string payload(DiskThread::most_waiting, 'x');
  more_than_all.add(McapChannel{1, 0, "/topic1", "json", {}});
  more_than_all.add(McapMessage{1, 0, 0, 0, payload});
  thread.push(std::move(more_than_all));
  CHECK(thread.status().dropped == 1);
  thread.finish();
  wait_until([&] { return thread.status().finished; });
  const auto survey = survey_recording(files, folder / "a.mcap");
  REQUIRE(survey);
  CHECK(survey->messages == 10);
  REQUIRE(survey->end);
  CHECK(survey->end->dropped == 1);
}

TEST_CASE("a failed sync is told, and the recording goes on in a new file") {
  const FreshFolder folder;
  SlowSync files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return files.over == 2; });
  files.fails = true;
  thread.push(chunk(0, 10));
  wait_until([&] { return thread.status().paths.size() == 2; });
  thread.push(chunk(10, 20));
  thread.finish();
  wait_until([&] { return thread.status().finished; });
  const auto failures = thread.take_failures();
  REQUIRE(failures.size() == 1);
  CHECK(failures[0].why.expected == "data that reach the disk");
  CHECK(failures[0].next == folder / "a.part2.mcap");
  CHECK(read_mcap(folder.read("a.part2.mcap")).messages.size() == 20);
}

TEST_CASE("a disk that fails every sync is not asked again at once") {
  const FreshFolder folder;
  FailingSyncs files;
  files.fails = true;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return thread.status().paths.size() == 2; });
  for (std::uint32_t i = 0; i < 50; ++i) {
    thread.push(chunk(10 * i, 10 * i + 10));
    wait_until([&] { return thread.status().bytes > 500 * i; });
  }
  CHECK(files.failed < 10);  // a second lies between two syncs, or each chunk would have its own
  thread.finish();
  wait_until([&] { return thread.status().refused.has_value(); });
  thread.give_up();
  wait_until([&] { return thread.status().finished; });
  CHECK(thread.status().dropped == 0);  // everything was written, though no sync proves it
  CHECK(folder.names().size() == 2);
  CHECK(read_mcap(bytes_in(thread.status().paths.back())).messages.size() == 500);
}

TEST_CASE("what a full disk refuses at the end is written as soon as there is room") {
  const FreshFolder folder;
  FullDisk files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return !thread.status().paths.empty(); });
  files.full = true;
  thread.push(chunk(0, 28));
  thread.finish();
  wait_until([&] { return thread.status().refused.has_value(); });
  CHECK(!thread.status().finished);
  files.full = false;
  wait_until([&] { return thread.status().finished; });
  CHECK(!thread.status().refused);
  CHECK(thread.status().dropped == 0);
  const std::vector<std::string> paths = thread.status().paths;
  const std::string last(file_name(paths.back()));
  CHECK(read_mcap(folder.read(last)).messages.size() == 28);
}

TEST_CASE("what a full disk never takes is counted when it is given up") {
  const FreshFolder folder;
  FullDisk files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  thread.push(chunk(0, 10));
  wait_until([&] { return thread.status().waiting_bytes == 0; });
  files.full = true;
  thread.push(chunk(10, 38));
  thread.finish();
  wait_until([&] { return thread.status().refused.has_value(); });
  thread.give_up();
  wait_until([&] { return thread.status().finished; });
  CHECK(thread.status().refused);
  CHECK(thread.status().dropped == 28);
  CHECK(read_mcap(folder.read("a.mcap")).messages.size() == 10);
}

TEST_CASE("a file that is removed is told, and the recording goes on in a new one") {
  const FreshFolder folder;
  PosixFiles files;
  DiskThread thread(opening(files, folder / "a.mcap"), McapCompression::none);
  REQUIRE(thread.start());
  wait_until([&] { return thread.status().free_bytes.has_value(); });
  REQUIRE(files.remove((folder / "a.mcap").c_str()) == 0);
  thread.push(chunk(0, 10));
  wait_until([&] { return thread.status().paths.size() == 2; });
  thread.finish();
  wait_until([&] { return thread.status().finished; });
  const auto failures = thread.take_failures();
  REQUIRE(failures.size() == 1);
  CHECK(failures[0].why.found == "no file: it was removed");
  CHECK(read_mcap(folder.read("a.part2.mcap")).messages.size() == 10);
}
