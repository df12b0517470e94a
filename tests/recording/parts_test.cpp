// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/parts.h"

#include "tests/folder.h"
#include "tests/recording/recorded_lab.h"

#include "kinalign/recording/beside.h"
#include "kinalign/recording/recover.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/recording/survey_parts.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace kinalign;

namespace {

/// A recording of forty seconds whose disk failed at 25 s. The second file repeats half a second.
class TornLab {
 public:
  explicit TornLab(const FreshFolder& folder) : folder_(&folder) {
    lab_.add_node(12, 0xb0071, {3.0, -35.0}, 0.0, 30.0);
    lab_.add_node(13, 0xb0072, {3.0, -35.0}, 30.0, 40.0);  // after the first file
  }
  std::string write(const std::string& name, const RecordedLab::Part& part) {
    return folder_->write(name, lab_.file(part));
  }
  std::string first() { return write("take.mcap", {1, -1e9, 25.0}); }
  std::string second() { return write("take.part2.mcap", {2, 24.5, 35.0}); }
  std::string third() { return write("take.part10.mcap", {10, 34.0, 1e9}); }
  /// The whole recording in one file.
  std::string whole() { return write("whole_take.mcap", {}); }
  RecordedLab& lab() { return lab_; }

 private:
  const FreshFolder* folder_;
  RecordedLab lab_{20261123};
};

std::uint64_t samples(FileSystem& files, const std::string& path, const std::string& node) {
  StreamOptions options;
  options.name = "imu";
  options.files = {{path, node}};
  const auto streams = open_streams(files, {options});
  if (!streams) FAIL(to_string(streams.error()));
  auto pass = std::get<ImuInput>(streams->streams.front().data).passes();
  REQUIRE(pass);
  std::uint64_t count = 0;
  ImuSamples block;
  Time last = Time::min();
  while (*(*pass)(block)) {
    count += block.size();
    CHECK(block.stamps.front() > last);
    last = block.stamps.back();
  }
  CHECK(count == streams->streams.front().survey.samples);
  return count;
}

std::string told(const Findings& findings) {
  return std::accumulate(findings.begin(), findings.end(), std::string(),
                         [](const std::string& text, const Finding& finding) {
                           return text + finding.what.expected + ", " + finding.what.found + "\n";
                         });
}

}  // namespace

TEST_CASE("a recording is read on in the files that it went on in") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const std::string path = lab.first(), whole = lab.whole();
  const std::uint64_t all = samples(files, whole, "12");
  CHECK(all == 2 * 451);
  CHECK(samples(files, path, "12") < all);
  lab.second();
  lab.third();
  CHECK(samples(files, path, "12") == all);
  CHECK(samples(files, path, "13") == samples(files, whole, "13"));
  // The manifest has the nodes of all files, and the take has those files.
  const auto manifest =
      manifest_of(*survey_parts(files, *parts_from(files, path, {}), {}), "take.mcap");
  REQUIRE(manifest);
  CHECK(manifest->streams.front().files.size() == 2);
  const auto recording = open_recording(files, *manifest, folder.path() + "/");
  REQUIRE(recording);
  REQUIRE(recording->streams.front().files.size() == 3);
  CHECK(recording->streams.front().files.back().name == "take.part10.mcap");
}

TEST_CASE("who reads a recording whose later file is not there is told that it ends before") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const std::string path = lab.first();
  const auto said = [&](const std::string& file) {
    StreamOptions options;
    options.name = "imu";
    options.files = {{file, "12"}};
    return told(open_streams(files, {options})->shared_files.front().findings);
  };
  CHECK(said(path) == "a recording up to its end, one that ends before\n");
  CHECK(said(lab.whole()).empty());
  lab.second();
  lab.third();
  CHECK(said(path).find("ends before") == std::string::npos);
}

TEST_CASE("of a recording's files it is said which are not there or were not read") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const std::string path = lab.first();
  const auto judged = [&](const std::string& which) {
    return told(judge_parts(*parts_from(files, which, {}), PartsBehind::left));
  };
  CHECK(judged(path).empty());
  const std::string second = lab.second();
  CHECK(judged(path) == "a recording in one file, take.part2.mcap\n");
  CHECK(judged(second) == "the recording's first file, take.mcap, part 2\n");
  lab.third();
  CHECK(judged(path) == "a recording in one file, take.part2.mcap, take.part10.mcap\n");
  // A file that holds the whole recording has no further parts, and files of another run are no
  // parts of it either.
  folder.write("other.part2.mcap", lab.lab().file({2, 24.5, 35.0, "take_02.mcap"}));
  CHECK(judged(lab.write("other.mcap", {})).empty());
}

TEST_CASE(
    "what is wrong with a later file is found with the first, what stands twice counts once") {
  const FreshFolder folder;
  TornLab lab(folder);
  lab.lab().add_clock(40.0, 33.0, 2.0);  // the wall clock is set in the second file
  lab.lab().add_mark(24.7, {Mark::Kind::t_pose, "", {}, ""});
  lab.lab().add_mark(31.0, {Mark::Kind::stop, "", {}, ""});
  PosixFiles files;
  const std::string path = lab.first();
  const std::string second = lab.second();
  const auto survey = [&] { return *survey_parts(files, *parts_from(files, path, {}), {}); };
  const RecordingSurvey whole = survey();
  CHECK(whole.torn.empty());
  CHECK(whole.findings.empty());
  CHECK(whole.steps.size() == 1);
  REQUIRE(whole.marks.size() == 2);
  CHECK(whole.marks.back().first.mark.kind == Mark::Kind::stop);
  std::uint64_t messages = 0;
  for (const ChannelSurvey& one : whole.channels) messages += one.messages;
  CHECK(whole.messages == messages);
  CHECK(whole.bytes == folder.read("take.mcap").size() + folder.read("take.part2.mcap").size());

  std::string bytes = folder.read("take.part2.mcap");
  bytes[bytes.size() / 2] ^= 1;
  folder.write("take.part2.mcap", bytes.substr(0, bytes.size() - 100));
  const RecordingSurvey broken = survey();
  CHECK(broken.torn == std::vector<std::string>{second});
  REQUIRE(!broken.findings.empty());
  CHECK(broken.findings.front().what.file == second);
}

TEST_CASE("what is missing of a recording is what no file of it has") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const auto missing = [&](const std::string& path) {
    const auto survey = survey_parts(files, *parts_from(files, path, {}), {});
    REQUIRE(survey);
    std::map<std::string, std::uint64_t> by_topic;
    for (const ChannelSurvey& one : survey->channels) by_topic[one.channel.topic] = one.missing;
    return by_topic;
  };
  const std::string path = lab.first();
  CHECK(missing(path).count("/imu/13/raw") == 0);
  lab.write("take.part3.mcap", {3, 30.0, 1e9});  // the second part is lost
  CHECK(missing(path)["/imu/12/raw"] == 5 * 15);
  CHECK(missing(path)["/imu/13/raw"] == 0);
  lab.second();
  CHECK(missing(path)["/imu/12/raw"] == 0);
}

TEST_CASE("recover takes parts in any order, and none of another run") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const std::string path = lab.first(), second = lab.second(), third = lab.third();
  const auto recovered =
      recover_recording(files, {path, third, second}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  const ReadMcap read = read_mcap(folder.read("b.mcap")), whole = read_mcap(lab.lab().file());
  REQUIRE(read.messages.size() == whole.messages.size());
  CHECK(recovered->twice > 0);
  CHECK(recovered->proof.contents == survey_recording(files, lab.whole())->contents);
  for (std::size_t k = 0; k < read.messages.size(); ++k) {
    CHECK(read.messages[k].message.sequence == whole.messages[k].message.sequence);
    CHECK(read.messages[k].data == whole.messages[k].data);
  }
  const std::string other =
      folder.write("other.mcap", lab.lab().file(RecordedLab::Part{1, -1e9, 1e9, "take_02.mcap"}));
  const auto blended = recover_recording(files, {path, other}, folder / "c.mcap", Overwrite::no);
  REQUIRE(!blended);
  CHECK(to_string(blended.error()) == other + ": expected a part of take.mcap, as " + path +
                                          " is, found part 1 of another run, take_02.mcap");
  CHECK(folder.read("c.mcap").empty());
}

TEST_CASE("what the disk spoilt in one file is taken from the next, which repeats it") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  std::string bytes = lab.lab().file({1, -1e9, 25.0});
  const std::string second = lab.write("take.part2.mcap", {2, 23.0, 1e9});
  const ReadMcap before = read_mcap(bytes);
  std::vector<McapChunkIndex> chunks;  // chunks of half a second each
  for (const McapRecord& record : before.records) {
    if (const auto* chunk = std::get_if<McapChunkIndex>(&record)) chunks.push_back(*chunk);
  }
  const McapChunkIndex& spoilt = chunks[chunks.size() - 2];
  const std::size_t at = spoilt.chunk_offset + spoilt.chunk_length / 2;
  for (std::size_t k = 0; k < 40; ++k) bytes[at + k] = static_cast<char>(~bytes[at + k]);
  const std::string path = folder.write("take.mcap", bytes);
  const std::size_t whole = read_mcap(lab.lab().file()).messages.size();
  CHECK(read_mcap(bytes).messages.size() < before.messages.size());
  const auto recovered = recover_recording(files, {path, second}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == whole);
  CHECK(samples(files, path, "12") == samples(files, lab.whole(), "12"));
}

TEST_CASE("what a torn end says of a channel counts only where no checksum covers it elsewhere") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  std::string first = lab.lab().file({1, -1e9, 30.4, "take.mcap", McapCompression::none}, false);
  // The begin of a message of node 13, in the last chunk.
  const auto begin = first.rfind("kinalign-node");
  first.resize(begin + 500);
  first[begin] ^= 1;
  folder.write("take.mcap", first);
  lab.write("take.part2.mcap", {2, 29.5, 1e9});
  CHECK(samples(files, folder / "take.mcap", "13") == samples(files, lab.whole(), "13"));
}

TEST_CASE("a message of a torn end whose number can't be is left out, and told") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  std::string bytes = lab.lab().file({1, -1e9, 25.0, "take.mcap", McapCompression::none});
  // Channel 1 is that of node 12. Finds its last message but one in the torn chunk: 0x05 and a
  // length come before it.
  std::size_t last = 0, before = 0;
  for (std::size_t at = 0; (at = bytes.find(std::string("\0\0\0\0\0\0\1\0", 8), at)) < bytes.size();
       ++at) {
    if (at < 3 || bytes[at - 3] != 0x05) continue;
    before = last;
    last = at;
  }
  REQUIRE(before > 0);
  bytes.resize(last);
  const std::uint64_t all = samples(files, folder.write("take.mcap", bytes), "12");
  bytes[before + 11] = 0x7f;  // the number's highest byte
  CHECK(samples(files, folder.write("take.mcap", bytes), "12") == all - 2);
  StreamOptions options;
  options.name = "imu";
  options.files = {{folder / "take.mcap", "12"}};
  const auto streams = open_streams(files, {options});
  REQUIRE(streams);
  CHECK(told(streams->shared_files.front().findings).find("1 of others") != std::string::npos);
}
