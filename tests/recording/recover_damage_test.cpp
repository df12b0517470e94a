// SPDX-License-Identifier: Apache-2.0
// Recovery from a recording of several files, some torn, damaged or on a bad disk.
#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"
#include "tests/recording/part_files.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/recording/parts.h"
#include "kinalign/recording/recover.h"
#include "kinalign/recording/survey.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

using namespace kinalign;

namespace {

std::string cut(const std::string& bytes) { return bytes.substr(0, bytes.size() - 20); }

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  REQUIRE(text.find(what) != std::string::npos);
  return text.replace(text.find(what), what.size(), with);
}

}  // namespace

TEST_CASE("what a channel is says the file in which a checksum covers it") {
  for (const bool first_is_torn : {true, false}) {
    CAPTURE(first_is_torn);
    const FreshFolder folder;
    PosixFiles files;
    std::string first = part_of(1, 0, 20, false), second = part_of(2, 5, 40, true);
    std::string& torn = first_is_torn ? first : second;
    torn = replaced(torn_at(torn, 18), "/topic2", "/topik2");
    const std::string a = folder.write("a.mcap", first);
    folder.write("a.part2.mcap", second);
    const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
    REQUIRE(recovered);
    const auto survey = survey_recording(files, folder / "b.mcap");
    REQUIRE(survey->channels.size() == 3);
    CHECK(survey->channels[1].channel.topic == "/topic2");
  }
}

TEST_CASE("a closed file that only repeats a torn one says that a third one is missing") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", cut(part_of(1, 0, 30, false)));
  folder.write("a.part2.mcap", part_of(2, 20, 30, false));
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 30);
  for (const char* name : {"a.mcap", "b.mcap"}) {
    CHECK(ends_before(*survey_recording(files, folder / name)));
  }
}

TEST_CASE("a file of parts up to the third ends the recording, not the second part beside it") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
  const std::string c = folder.write("a.part3.mcap", cut(part_of(3, 57, 90, false)));
  const std::string joined = folder / "joined.mcap";
  REQUIRE(recover_recording(files, {a, c}, joined, Overwrite::no));
  CHECK(survey_recording(files, joined)->ending == Ending::truncated);
  std::filesystem::remove(a);
  std::filesystem::remove(c);
  const std::string b = folder.write("a.part2.mcap", part_of(2, 27, 60, false));
  for (const auto& given : {std::vector{joined, b}, std::vector{b, joined}}) {
    const auto recovered = recover_recording(files, given, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == 90);
    const auto survey = survey_recording(files, folder / "b.mcap");
    CHECK(survey->ending == Ending::truncated);
    CHECK(survey->facts->part == 1);
    CHECK(survey->facts->last_part() == 3);
  }
  const auto survey = survey_recording(files, joined);
  CHECK(survey->ending == Ending::truncated);
}

TEST_CASE("messages that follow later ones of their channel are reported, and not missing") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string bytes = part_of(1, {messages_of(30, 60), messages_of(0, 30)}, false);
  const auto survey = survey_recording(files, folder.write("a.mcap", bytes));
  REQUIRE(survey->findings.size() == 1);
  CHECK(survey->findings.front().what.expected == "each channel's messages in order");
  CHECK(survey->messages == 60);
  for (const ChannelSurvey& one : survey->channels) CHECK(one.missing == 0);
  const auto sound = survey_recording(files, folder.write("b.mcap", part_of(1, 0, 60, true)));
  CHECK(sound->findings.empty());
}

TEST_CASE("a page that the disk can't read is an error that names file and position") {
  const FreshFolder folder;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 500, false));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 200, 700, true));
  for (const std::string& path : {a, b}) {
    for (const off_t page : {0, 3}) {
      CAPTURE(page);
      BadPage files(path, page * BadPage::size);
      const auto refused = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
      REQUIRE_FALSE(refused);
      CHECK(refused.error().kind == ErrorKind::unreadable_disk);
      CHECK(to_string(refused.error()) == path +
                                              ": expected a readable file, found Input/output "
                                              "error at byte " +
                                              std::to_string(page * BadPage::size));
      CHECK_FALSE(std::filesystem::exists(folder / "b.mcap"));
    }
  }
}

TEST_CASE("what two torn files have of a channel that only a third one defines is taken once") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
  folder.write("a.part2.mcap", nameless(torn_at(part_of(2, 27, 60, false), 50)));
  folder.write("a.part3.mcap", nameless(torn_at(part_of(3, 40, 90, false), 80)));
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 80);
  CHECK(recovered->nameless == 0);
  CHECK(recovered->missing == 0);
  CHECK(survey_recording(files, a)->messages == 80);
  const ReadMcap read = read_mcap(folder.read("b.mcap"));
  for (std::uint32_t k = 0; k < 80; ++k) CHECK(read.messages[k].data == nth_message(k).data);
}

TEST_CASE("a survey of parts has each channel once, as a checksum covers it") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string first = torn_at(part_of(1, 0, 20, false), 18);
  const std::string a = folder.write("a.mcap", replaced(first, "/topic2", "/topik2"));
  folder.write("a.part2.mcap", part_of(2, 5, 40, true));
  const auto survey = survey_recording(files, a);
  REQUIRE(survey);
  REQUIRE(survey->channels.size() == 3);
  CHECK(survey->channels[1].channel.topic == "/topic2");
  CHECK(survey->messages == 40);
}

TEST_CASE("a message with a number that was read before is left out, in one file, too") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string bytes = part_of(1, {messages_of(0, 30), messages_of(27, 33)}, false);
  const std::string a = folder.write("a.mcap", bytes);
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 33);
  CHECK(recovered->twice == 3);
}

TEST_CASE("a channel that the first file does not define has in a survey the later one's name") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", nameless(torn_at(part_of(1, 0, 30, false), 28)));
  folder.write("a.part2.mcap", torn_at(part_of(2, 10, 60, true), 50));
  const auto survey = survey_recording(files, a);
  REQUIRE(survey);
  REQUIRE(survey->channels.size() == 3);
  CHECK(survey->channels.front().channel.topic == "/topic1");
  CHECK(survey->messages == 50);
}
