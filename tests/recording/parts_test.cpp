// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/parts.h"

#include "tests/folder.h"
#include "tests/recording/part_files.h"
#include "tests/recording/recorded_lab.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/recording/recover.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/recording/survey.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
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
  const auto manifest = manifest_of(*survey_recording(files, path), "take.mcap");
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
  CHECK(said(path) == "a recording's last file, a file without the end of the recording\n");
  CHECK(said(lab.whole()).empty());
  lab.second();
  lab.third();
  CHECK(said(path).find("ends before") == std::string::npos);
}

TEST_CASE("a recording of several files is reported, and a missing first file") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const std::string path = lab.first();
  const auto judged = [&](const std::string& which) {
    return told(judge_parts(files, *find_parts(files, {which}), Severity::warning));
  };
  CHECK(judged(path).empty());
  const std::string second = lab.second();
  for (const std::string& which : {path, second}) {
    CHECK(judged(which) == "a recording in one file, take.part2.mcap\n");
  }
  lab.third();
  CHECK(judged(path) == "a recording in one file, take.part2.mcap, take.part10.mcap\n");
  std::filesystem::remove(path);
  CHECK(judged(second) ==
        "the recording's first file, take.mcap, part 2\n"
        "a recording in one file, take.part10.mcap\n");
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
  const auto survey = [&] { return *survey_recording(files, path); };
  const RecordingSurvey whole = survey();
  CHECK(whole.truncated.empty());
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
  CHECK(broken.truncated == std::vector<std::string>{second});
  REQUIRE(!broken.findings.empty());
  CHECK(broken.findings.front().what.file == second);
}

TEST_CASE("what is missing of a recording is what no file of it has") {
  const FreshFolder folder;
  TornLab lab(folder);
  PosixFiles files;
  const auto missing = [&](const std::string& path) {
    const auto survey = survey_recording(files, path);
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
  const auto survey = survey_recording(files, path);
  REQUIRE(survey);
  CHECK(survey->messages == whole);
  for (const ChannelSurvey& one : survey->channels) CHECK(one.missing == 0);
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
  CHECK(told(streams->shared_files.front().findings).find("1 messages with impossible numbers") !=
        std::string::npos);
}

TEST_CASE("for a link, siblings are found in its folder and in the folder of its target") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("A/a.mcap", part_of(1, 0, 20, false));
  const std::string b = folder.write("B/a.part2.mcap", part_of(2, 20, 40, false));
  const std::string c = folder.write("B/a.part3.mcap", part_of(3, 40, 60, true));
  const std::string link = folder / "A/a.part2.mcap";
  std::filesystem::create_symlink("../B/a.part2.mcap", link);
  for (const auto& named :
       {std::vector{a, b}, std::vector{b, a}, std::vector{link}, std::vector{c, a}}) {
    const auto found = find_parts(files, named);
    REQUIRE(found);
    std::vector<std::string> parts;
    for (const RecordingPart& one : *found) parts.push_back(one.path);
    for (const auto& all : {parts, with_siblings(files, named)}) {
      CHECK(all.size() == 3);
      for (const std::string& one : {a, b, c}) {
        CHECK(std::any_of(all.begin(), all.end(), [&](const std::string& path) {
          return std::filesystem::equivalent(path, one);
        }));
      }
    }
  }
}

TEST_CASE("the names of parts are those of a file's siblings") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", "");
  for (const char* name : {"a.part2.mcap", "a.part77.mcap", "b.mcap", "a.parts.mcap", "a.part.mcap",
                           "a.part2.txt", "sub/a.part2.mcap"}) {
    folder.write(name, "");
  }
  CHECK(with_siblings(files, {a}) ==
        std::vector{a, folder / "a.part2.mcap", folder / "a.part77.mcap"});
}

TEST_CASE("a file that has the name of a part and proves nothing is reported") {
  const FreshFolder folder;
  PosixFiles files;
  const auto reported = [&](const std::string& path) {
    std::vector<std::string> paths;
    for (const Finding& one : judge_parts(files, *find_parts(files, {path}), Severity::note)) {
      paths.push_back(one.what.file);
    }
    return paths;
  };
  const std::string renamed = folder.write("old.mcap", part_of(1, 0, 20, false));
  CHECK(reported(renamed).empty());
  const std::string damaged = folder.write("a.part2.mcap", "???");
  CHECK(reported(renamed) == std::vector{damaged});
  std::filesystem::remove(damaged);
  // A recording of another machine that has the same file name.
  std::string another = part_of(1, 0, 20, true);
  folder.write("a.mcap", another.replace(another.find("lab"), 3, "bal"));
  CHECK(reported(renamed).empty());
  CHECK(find_parts(files, {renamed})->size() == 1);
  const std::string foreign = folder.write("b.mcap", mcap_file(6, 3, McapCompression::none));
  CHECK(reported(foreign).empty());
  const std::string other = folder.write("b.part2.mcap", mcap_file(6, 3, McapCompression::none));
  CHECK(reported(foreign) == std::vector{other});
}

TEST_CASE("if two files have one part number, the higher number in the name is the later part") {
  const FreshFolder folder;  // the state after every sync failed and the program was killed
  PosixFiles files;
  const std::string second = folder.write("a.part9.mcap", part_of(2, 10, 40, false));
  const std::string third = folder.write("a.part10.mcap", part_of(2, 10, 60, true));
  for (const std::string& named : {second, third}) {
    const auto parts = find_parts(files, {named});
    REQUIRE(parts);
    REQUIRE(parts->size() == 2);
    CHECK(parts->front().path == second);
  }
}

TEST_CASE("parts that recover has joined are not read again, however bad they are") {
  const std::string torn = torn_at(part_of(2, 27, 60, true), 57);
  std::string damaged = part_of(2, 27, 60, true);
  damaged[damaged.find(nth_message(40).data)] ^= 1;
  for (const std::string& second : {torn, damaged}) {
    const FreshFolder folder;
    PosixFiles files;
    const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
    folder.write("a.part2.mcap", second);
    const std::string whole = folder / "whole.mcap";
    const auto recovered = recover_recording(files, {a}, whole, Overwrite::no);
    REQUIRE(recovered);
    CHECK(find_parts(files, {whole})->size() == 1);
    const auto survey = survey_recording(files, whole);
    REQUIRE(survey);
    CHECK(survey->messages == recovered->messages);
    CHECK(survey->truncated.empty());
    CHECK(survey->findings.empty());
  }
}

TEST_CASE("a part that recover had not seen is read with the file that it made of others") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
  const std::string c = folder.write("a.part3.mcap", part_of(3, 30, 90, true));
  const std::string joined = folder / "joined.mcap";
  REQUIRE(recover_recording(files, {a, c}, joined, Overwrite::no));
  CHECK(survey_recording(files, joined)->facts->joined == std::set<int>{1, 3});
  folder.write("a.part2.mcap", part_of(2, 20, 40, false));
  CHECK(find_parts(files, {joined})->size() == 2);
}
