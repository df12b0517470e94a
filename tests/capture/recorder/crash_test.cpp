// SPDX-License-Identifier: Apache-2.0
// A recording after a kill and after a power cut: at most the last second may be missing. In
// virtual time, on files in memory that remember every call.
#include "tests/capture/recorder/memory_files.h"
#include "tests/mcap/mcap_files.h"
#include "tests/seeds.h"

#include "kinalign/capture/recorder/recorder.h"
#include "kinalign/capture/recorder/recording_disk.h"
#include "kinalign/recording/format.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <optional>

using namespace kinalign;

namespace {

using std::chrono::milliseconds;
using namespace std::chrono_literals;

constexpr Duration promised = 1s;
const std::string path = "/take.mcap";

/// Ten seconds of three devices, and the time of each change of a file.
struct Recorded {
  MemoryFiles files;
  std::vector<HostTime> changed;  // the time of each of files.changes
  struct Cut {
    HostTime at{};
    std::size_t changes = 0;  // the number of changes that were made by then
    // For each file the number of its changes that are certainly on the disk.
    std::map<std::string, std::size_t> durable;
  };
  std::vector<Cut> moments;    // each 4 ms
  std::vector<HostTime> sent;  // message k
};

HostTime at(Duration t) { return HostTime{t}; }

std::string payload(std::uint64_t k) {
  return "message " + std::to_string(k) + std::string(k % 97, 'x');
}

/// A sync takes 3 to 102 ms. `fails`: the number of the sync that fails.
class SlowSyncs {
 public:
  SlowSyncs(Recorded& run, RecordingDisk& disk, std::optional<Duration> fails)
      : run_(run), disk_(disk), fails_(fails) {}
  void end(HostTime now) {
    if (!sync_ || ends_ > now) return;
    run_.files.sync_began = began_;
    run_.files.next_sync_fails = fails_ && now >= at(*fails_);
    if (run_.files.next_sync_fails) fails_.reset();
    CHECK(disk_.synced(*sync_, sync_->file->sync()));
    sync_.reset();
  }
  void begin(HostTime now, std::mt19937_64& random) {
    if (sync_) return;
    sync_ = disk_.unsynced();
    if (!sync_) return;
    began_ = run_.files.changes.size();
    ends_ = now + milliseconds(3 + random() % 100);
  }

 private:
  Recorded& run_;
  RecordingDisk& disk_;
  std::optional<Duration> fails_;
  std::optional<RecordingDisk::Sync> sync_{};
  std::size_t began_ = 0;
  HostTime ends_{};
};

std::vector<std::uint16_t> three_channels(Recorder& recorder) {
  std::vector<std::uint16_t> channels;
  for (const std::string topic : {"/mocap/raw", "/kinect/raw", "/imu/raw"}) {
    channels.push_back(recorder.add_channel(McapChannel{0, 0, topic, "test", {}}));
  }
  return channels;
}

/// `sync_fails`: the number of the sync that fails.
void record_ten_seconds(Recorded& run, std::uint64_t seed, McapCompression compression,
                        std::optional<Duration> sync_fails = std::nullopt) {
  std::mt19937_64 random(seed);
  auto disk = RecordingDisk::open(run.files, path, [](int) {
    return RecordingHead{{"kinalign", "test"}, {{"kinalign.recording", {{"subject", "03"}}}}, {}};
  });
  REQUIRE(disk);
  Recorder recorder(RecorderOptions{});
  const auto channels = three_channels(recorder);
  recorder.start(at(Duration{0}), [&](const McapChunkContent& chunk) {
    CHECK(disk->write(store(chunk, compression)));
  });
  SlowSyncs syncs(run, *disk, sync_fails);
  for (Duration t{0}; t < 10s; t += 4ms) {
    syncs.end(at(t));
    for (const std::uint16_t channel : channels) {
      if (random() % 3 != 0) continue;
      recorder.record(channel, at(t), payload(run.sent.size()));
      run.sent.push_back(at(t));
    }
    recorder.tick(at(t));
    syncs.begin(at(t), random);
    run.changed.resize(run.files.changes.size(), at(t));
    run.moments.push_back({at(t), run.files.changes.size(), run.files.synced});
  }
  recorder.stop();
  CHECK(disk->finish(to_metadata(RecordingEnd{})));
  run.changed.resize(run.files.changes.size(), at(10s));
}

using Contents = std::map<std::string, std::string>;  // by path

/// Finds the messages that a file holds: they must be unaltered, and there must be no others.
void find_messages(const Recorded& run, const std::string& content, std::vector<bool>& found) {
  const ReadMcap read = read_mcap(content);
  for (const OwnedMessage& m : read.messages) {
    const std::uint64_t k = std::strtoull(m.data.c_str() + 8, nullptr, 10);
    const bool is_whole =
        k < run.sent.size() && m.data == payload(k) &&
        m.message.log_time == static_cast<std::uint64_t>(run.sent[k].time_since_epoch().count());
    if (is_whole) found[k] = true;
    if (!is_whole && !read.unchecked) FAIL_CHECK("a message that nobody sent: ", m.data);
  }
}

/// Whether the files hold, unaltered, every message sent before `cut` less a second.
void check_state(const Recorded& run, const Contents& contents, HostTime cut) {
  std::vector<bool> found(run.sent.size());
  for (const auto& [name, content] : contents) find_messages(run, content, found);
  for (std::size_t k = 0; k < found.size() && run.sent[k] < cut - promised; ++k) {
    if (!found[k]) {
      FAIL_CHECK("message ", k, " is lost");
      return;
    }
  }
}

/// The files after a power cut. All that is certainly on the disk is there. Of the rest, chance
/// decides for each sector of each unsynced write whether it reached the disk. A sector that did
/// not reads as zeros if a later sector of the file did.
Contents after_power_cut(const Recorded& run, const Recorded::Cut& cut, std::mt19937_64& random) {
  constexpr std::size_t sector = 512;
  Contents contents;
  for (std::size_t k = 0; k < cut.changes; ++k) {
    const MemoryFiles::Change& change = run.files.changes[k];
    std::string& content = contents[change.path];
    const auto durable = cut.durable.find(change.path);
    if (durable != cut.durable.end() && k < durable->second) {
      MemoryFiles::apply(content, change);
      continue;
    }
    for (std::size_t from = 0; from < change.bytes.size(); from += sector) {
      if (random() % 2 == 0) continue;
      MemoryFiles::apply(
          content, {change.path, change.kind, change.at + from, change.bytes.substr(from, sector)});
    }
  }
  return contents;
}

/// Gives the number of states that were checked.
std::size_t cut_power_all_along(const Recorded& run, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::size_t states = 0;
  for (const Recorded::Cut& cut : run.moments) {
    for (int trial = 0; trial < 4; ++trial) {
      CAPTURE(cut.at.time_since_epoch().count());
      CAPTURE(trial);
      check_state(run, after_power_cut(run, cut, random), cut.at);
      ++states;
    }
  }
  return states;
}

}  // namespace

TEST_CASE("a kill at any system call costs at most the last second") {
  for (const auto compression : {McapCompression::none, McapCompression::zstd}) {
    for (const auto seed : fresh_seeds(2)) {
      CAPTURE(seed);
      Recorded run;
      record_ten_seconds(run, seed, compression);
      std::mt19937_64 random(seed);
      Contents contents;
      for (std::size_t k = 0; k < run.files.changes.size(); ++k) {
        CAPTURE(k);
        const auto& change = run.files.changes[k];
        // Between two calls, up to the moment of the next call …
        check_state(run, contents, run.changed[k]);
        // … and within it
        MemoryFiles::Change torn = change;
        torn.bytes.resize(random() % (change.bytes.size() + 1));
        Contents partly = contents;
        MemoryFiles::apply(partly[change.path], torn);
        check_state(run, partly, run.changed[k]);
        MemoryFiles::apply(contents[change.path], change);
      }
      check_state(run, contents, at(100s));
      REQUIRE(contents.size() == 1);
      CHECK(read_mcap(contents[path]).closed);
    }
  }
}

TEST_CASE("a power cut costs at most the last second, whatever became of unsynced writes") {
  std::size_t states = 0;
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    Recorded run;
    record_ten_seconds(run, seed, seed % 2 == 0 ? McapCompression::none : McapCompression::zstd);
    states += cut_power_all_along(run, seed);
  }
  CHECK(states >= 10'000);
}

TEST_CASE("nor does one behind a failed sync, which may have forgotten what it was to cover") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    Recorded run;
    record_ten_seconds(run, seed, McapCompression::zstd, milliseconds(1000 + seed % 7000));
    const auto changes = run.files.changes;
    CHECK(std::any_of(changes.begin(), changes.end(),
                      [](const MemoryFiles::Change& change) { return change.path != path; }));
    cut_power_all_along(run, seed);
  }
}
