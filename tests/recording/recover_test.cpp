// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/recover.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"
#include "tests/recording/part_files.h"
#include "tests/recording/recorded_lab.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/recording/survey.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

using namespace kinalign;

TEST_CASE("of a file that is cut anywhere recover makes a whole one with all that can be read") {
  for (const auto compression : {McapCompression::none, McapCompression::zstd}) {
    const std::string whole = mcap_file(60, 10, compression);
    for (std::size_t cut = mcap_magic.size(); cut < whole.size(); cut += 13) {
      CAPTURE(cut);
      const FreshFolder folder;
      PosixFiles files;
      const std::string torn = whole.substr(0, cut);
      const std::string path = folder.write("a.mcap", torn);
      const auto recovered = recover_recording(files, {path}, folder / "b.mcap", Overwrite::no);
      const ReadMcap before = read_mcap(torn);
      if (!recovered) {  // cut before the records that precede messages: metadata
        CHECK(before.messages.empty());
        CHECK(cut < 200);
        CHECK(to_string(recovered.error()) ==
              path + ": expected a recording with at least one readable message, found none");
        CHECK_FALSE(std::filesystem::exists(folder / "b.mcap"));
        continue;
      }
      REQUIRE(recovered);
      const ReadMcap read = read_mcap(folder.read("b.mcap"));
      CHECK(read.closed);
      CHECK(read.findings.empty());
      REQUIRE(read.messages.size() == before.messages.size());
      for (std::size_t i = 0; i < read.messages.size(); ++i) {
        CHECK(read.messages[i].data == before.messages[i].data);
        CHECK(read.messages[i].message.log_time == before.messages[i].message.log_time);
      }
      CHECK(recovered->messages == before.messages.size());
      CHECK((recovered->unchecked > 0) == before.unchecked);
      CHECK(folder.read("a.mcap") == torn);  // the torn file is not changed
    }
  }
}

TEST_CASE("of a damaged recording recover says how many bytes and messages are lost") {
  std::vector<std::size_t> ends;
  const std::string whole = mcap_file(60, 10, McapCompression::zstd, &ends);
  for (const std::size_t chunk : {0U, 3U, 5U}) {
    CAPTURE(chunk);
    const FreshFolder folder;
    PosixFiles files;
    std::string damaged = whole;
    damaged[ends[chunk] - 250] ^= 0x10;  // before the chunk's indexes, which have at most 214 bytes
    std::string unchecked = damaged;  // written by a program that makes no checksum of the summary
    unchecked.replace(unchecked.size() - mcap_magic.size() - 4, 4, 4, '\0');
    for (const std::string& bytes : {damaged, unchecked}) {
      const auto recovered = recover_recording(files, {folder.write("a.mcap", bytes)},
                                               folder / "b.mcap", Overwrite::yes);
      REQUIRE(recovered);
      CHECK(recovered->messages == 50);
      CHECK(recovered->missing == 10);  // by the file's own count
      CHECK(recovered->skipped > 50);
      CHECK(recovered->skipped < whole.size() / 6);
      CHECK_FALSE(recovered->findings.empty());
    }
  }
}

TEST_CASE("of a torn recording of ours, which has no count, the numbers say what is lost") {
  RecordedLab lab(20261125);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 10.0);
  std::string bytes = lab.file(false);
  const FreshFolder folder;
  PosixFiles files;
  const auto recovered = [&] {
    return recover_recording(files, {folder.write("a.mcap", bytes)}, folder / "b.mcap",
                             Overwrite::yes);
  };
  const auto whole = recovered();
  REQUIRE(whole);
  CHECK(whole->missing == 0);
  bytes[bytes.size() / 2] ^= 0x10;
  const auto damaged = recovered();
  REQUIRE(damaged);
  CHECK(damaged->missing > 0);
  CHECK(damaged->messages + damaged->missing == whole->messages);
}

TEST_CASE("of a file that is only torn nothing is skipped, and nothing known to be missing") {
  const std::string whole = part_of(1, 0, 60, true);
  for (std::size_t k = 20; k < 60; k += 7) {
    CAPTURE(k);
    const FreshFolder folder;
    PosixFiles files;
    const auto torn = torn_at(whole, static_cast<std::uint32_t>(k));
    const std::string path = folder.write("a.mcap", torn);
    const auto recovered = recover_recording(files, {path}, folder / "b.mcap", Overwrite::no);
    REQUIRE(recovered);
    CHECK(recovered->messages == k);
    CHECK(recovered->skipped == 0);
    CHECK(recovered->missing == 0);
    CHECK(recovered->unchecked == k);
  }
}

TEST_CASE("a number that a torn end's damage made is no message, and nothing is missing for it") {
  const FreshFolder folder;
  PosixFiles files;
  for (const std::uint32_t number : {0x00001000U, 0xfffffff0U}) {
    CAPTURE(number);
    McapChunkContent last = messages_of(30, 36);  // numbers 10 and 11 of each channel
    OwnedMessage garbage = nth_message(36);
    garbage.message.sequence = number;
    add(last, garbage);
    add(last, nth_message(40));  // the message that is cut off
    std::string bytes = part_of(1, {messages_of(0, 30), last}, false);
    bytes.resize(bytes.find(nth_message(40).data));
    const std::string path = folder.write("a.mcap", bytes);
    const auto recovered = recover_recording(files, {path}, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == 36);
    CHECK(recovered->missing == 0);
    const auto survey = survey_recording(files, path);
    REQUIRE(survey);
    CHECK(survey->messages == 36);
    for (const ChannelSurvey& one : survey->channels) CHECK(one.missing == 0);
    for (const Findings& findings : {recovered->findings, survey->findings}) {
      const auto told = std::find_if(findings.begin(), findings.end(), [](const Finding& one) {
        return one.what.found == "1 messages with impossible numbers";
      });
      REQUIRE(told != findings.end());
      CHECK(told->severity == Severity::error);
      CHECK(told->what.file == path);
    }
  }
}

TEST_CASE("whatever byte of a summary is damaged, recover has all messages and invents no loss") {
  std::vector<std::size_t> ends;
  const std::string whole = mcap_file(60, 10, McapCompression::zstd, &ends);
  const FreshFolder folder;
  PosixFiles files;
  const auto undamaged = survey_recording(files, folder.write("whole.mcap", whole));
  REQUIRE(undamaged);
  for (std::size_t at = ends.back() + 13; at < whole.size() - mcap_magic.size(); ++at) {
    CAPTURE(at);
    std::string damaged = whole;
    damaged[at] ^= 0x10;
    const auto recovered = recover_recording(files, {folder.write("a.mcap", damaged)},
                                             folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == 60);
    CHECK(recovered->missing == 0);
    const auto survey = survey_recording(files, folder / "a.mcap");
    REQUIRE(survey);
    CHECK(survey->messages == 60);
    // And perhaps a channel without messages.
    for (const ChannelSurvey& known : undamaged->channels) {
      CHECK(std::any_of(survey->channels.begin(), survey->channels.end(), [&](const auto& one) {
        return one.channel == known.channel && one.messages == known.messages;
      }));
    }
  }
}

TEST_CASE("rubbish between chunks is counted, byte by byte") {
  std::vector<std::size_t> ends;
  std::string bytes = mcap_file(60, 10, McapCompression::zstd, &ends);
  bytes.insert(ends[2], std::string(1000, '\0'));
  const FreshFolder folder;
  PosixFiles files;
  const auto recovered =
      recover_recording(files, {folder.write("a.mcap", bytes)}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 60);
  CHECK(recovered->missing == 0);
  CHECK(recovered->skipped == 1000);
}

TEST_CASE("recover says of a file that is none what it is instead") {
  const FreshFolder folder;
  PosixFiles files;
  const auto refusal = [&](std::string_view bytes) {
    const std::string path = folder.write("a.mcap", bytes);
    const auto recovered = recover_recording(files, {path}, folder / "b.mcap", Overwrite::no);
    REQUIRE_FALSE(recovered);
    CHECK(recovered.error().file == path);
    return recovered.error().expected + "; " + recovered.error().found;
  };
  CHECK(refusal("") == "a recording's file; an empty file");
  CHECK(refusal("HIERARCHY\nROOT a\n") == "an MCAP file; 'HIERARCHY'");
  CHECK(refusal("\x1f\x8b rest") == "an MCAP file; a gzip archive: unpack it first");
}

TEST_CASE("whichever call fails, recover leaves a whole file or none") {
  const std::string whole = mcap_file(60, 10, McapCompression::zstd);
  for (int fail_at = 1;; ++fail_at) {
    CAPTURE(fail_at);
    const FreshFolder folder;
    FaultyFiles files;
    files.fail_at = fail_at;
    files.code = EIO;
    const std::string path = folder.write("a.mcap", whole.substr(0, whole.size() / 2));
    const auto recovered = recover_recording(files, {path}, folder / "b.mcap", Overwrite::no);
    const std::string written = folder.read("b.mcap");
    CHECK((written.empty() || read_mcap(written).closed));
    CHECK((!recovered || !written.empty()));
    if (!files.failed()) break;
  }
}

TEST_CASE("a disk that alters what it was given is found out, and the new file gets no name") {
  class AlteringFiles final : public PosixFiles {
   public:
    explicit AlteringFiles(std::uint64_t at) : at_(at) {}
    ssize_t write(int fd, const void* data, std::size_t size) override {
      std::string bytes(static_cast<const char*>(data), size);
      if (at_ - written_ < size) bytes[at_ - written_] ^= 0x10;
      const ssize_t taken = PosixFiles::write(fd, bytes.data(), size);
      written_ += static_cast<std::uint64_t>(std::max<ssize_t>(taken, 0));
      return taken;
    }

   private:
    std::uint64_t at_, written_ = 0;
  };
  const FreshFolder folder;
  const std::string path = folder.write("a.mcap", mcap_file(60, 10, McapCompression::none));
  PosixFiles files;
  REQUIRE(recover_recording(files, {path}, folder / "whole.mcap", Overwrite::no));
  const std::uint64_t size = folder.read("whole.mcap").size();
  for (std::uint64_t at = 0; at < size; ++at) {
    CAPTURE(at);
    AlteringFiles altering(at);
    CHECK_FALSE(recover_recording(altering, {path}, folder / "b.mcap", Overwrite::no));
    CHECK_FALSE(std::filesystem::exists(folder / "b.mcap"));
  }
}

TEST_CASE("a survey says of each channel what came, when, and what is missing") {
  const FreshFolder folder;
  PosixFiles files;
  MemoryFile file;
  McapWriter writer(file.store());
  CHECK(writer.begin({"kinalign", "test"}));
  McapChunkContent content;
  for (const std::uint32_t k : {0U, 3U, 6U, 15U, 18U}) add(content, nth_message(k));
  CHECK(writer.write(store(content, McapCompression::zstd)));
  CHECK(writer.finish());
  const auto survey = survey_recording(files, folder.write("a.mcap", file.bytes));
  REQUIRE(survey);
  CHECK(survey->truncated.empty());
  REQUIRE(survey->channels.size() == 1);
  const ChannelSurvey& channel = survey->channels.front();
  CHECK(channel.channel.topic == "/topic1");
  CHECK(channel.messages == 5);
  CHECK(channel.first == 1000);
  CHECK(channel.last == 1180);
  CHECK(channel.missing == 2 + 2 + 8 + 2);
  CHECK(survey->bytes == file.bytes.size());
}

TEST_CASE("a file that is no recording is refused by its name") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder.write("a.bvh", "HIERARCHY");
  const auto survey = survey_recording(files, path);
  REQUIRE(!survey);
  CHECK(to_string(survey.error()) == path + ": expected an MCAP file, found another beginning");
  CHECK(!*is_recording(files, path));
  CHECK(*is_recording(files, folder.write("b.mcap", mcap_magic)));
}
