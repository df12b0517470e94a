// SPDX-License-Identifier: Apache-2.0
// Recovery from a recording of several files, some torn, damaged or on a bad disk.
#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"
#include "tests/recording/part_files.h"

#include "kinalign/recording/parts.h"
#include "kinalign/recording/recover.h"
#include "kinalign/recording/survey_parts.h"

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
    REQUIRE(recovered->proof.channels.size() == 3);
    CHECK(recovered->proof.channels[1].channel.topic == "/topic2");
  }
}

TEST_CASE("metadata are of a file that a checksum covers, and the end is the last one's") {
  const FreshFolder folder;
  PosixFiles files;
  const auto part = [](int number, const std::string& camera, std::uint64_t dropped) {
    MemoryFile file;
    McapWriter writer(file.store());
    REQUIRE(writer.begin({"kinalign", "test"}));
    REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", number, {}})));
    REQUIRE(writer.write(McapMetadata{"lab", {{"camera", camera}}}));
    REQUIRE(writer.write(store(messages_of(10 * number, 10 * number + 15), McapCompression::none)));
    REQUIRE(writer.write(to_metadata(RecordingEnd{dropped})));
    REQUIRE(writer.finish());
    return file.bytes;
  };
  const std::string a = folder.write("a.mcap", torn_at(part(1, "lefd", 0), 24));
  folder.write("a.part2.mcap", part(2, "left", 7));
  folder.write("a.part3.mcap", part(3, "left", 9));  // ends, too
  REQUIRE(recover_recording(files, {a}, folder / "b.mcap", Overwrite::no));
  const auto survey = survey_recording(files, folder / "b.mcap");
  REQUIRE(survey->facts);
  CHECK(survey->facts->part == 1);
  CHECK(survey->facts->last_part() == 3);
  REQUIRE(survey->end);
  CHECK(survey->end->dropped == 9);
  std::vector<std::string> cameras;
  for (const McapRecord& record : read_mcap(folder.read("b.mcap")).records) {
    const auto* metadata = std::get_if<McapMetadata>(&record);
    if (metadata != nullptr && metadata->name == "lab") {
      cameras.push_back(metadata->texts.at("camera"));
    }
  }
  CHECK(cameras == std::vector<std::string>{"left"});
}

TEST_CASE("of what recover made, old files that lie beside it say nothing, however bad they are") {
  const std::string torn = torn_at(part_of(2, 27, 60, true), 57);
  std::string damaged = part_of(2, 27, 60, true);
  damaged[damaged.find(nth_message(40).data)] ^= 1;
  for (const std::string& second : {torn, damaged, part_of(2, 27, 500, true)}) {
    const FreshFolder folder;
    const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
    const std::string b = folder.write("a.part2.mcap", second);
    BadPage files(second.size() > 2 * BadPage::size ? b : "", 2 * BadPage::size);
    const std::string whole = folder / "whole.mcap";
    const auto recovered = recover_recording(files, {a}, whole, Overwrite::no);
    REQUIRE(recovered);
    const auto parts = parts_from(files, whole, {});
    REQUIRE(parts);
    CHECK(parts->size() == 1);
    const auto survey = survey_parts(files, *parts, {});
    REQUIRE(survey);
    CHECK(survey->messages == recovered->messages);
    CHECK(survey->torn.empty());
    CHECK(survey->findings.empty());
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
  CHECK(judge_end("x", recovered->proof).size() == 1);
  const auto survey = survey_parts(files, *parts_from(files, a, {}), {});
  CHECK(judge_end("x", *survey).size() == 1);
}

TEST_CASE("a file of parts up to the third ends the recording, not the second part beside it") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
  const std::string c = folder.write("a.part3.mcap", cut(part_of(3, 57, 90, false)));
  const std::string joined = folder / "joined.mcap";
  REQUIRE(recover_recording(files, {a, c}, joined, Overwrite::no));
  CHECK(survey_recording(files, joined)->ending == Ending::torn);
  std::filesystem::remove(a);
  std::filesystem::remove(c);
  const std::string b = folder.write("a.part2.mcap", part_of(2, 27, 60, false));
  for (const auto& given : {std::vector{joined, b}, std::vector{b, joined}}) {
    const auto recovered = recover_recording(files, given, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == 90);
    CHECK(recovered->proof.ending == Ending::torn);
    CHECK(recovered->proof.facts->last_part() == 3);
  }
  const auto survey = survey_parts(files, *parts_from(files, joined, {}), {});
  CHECK(survey->ending == Ending::torn);
}

TEST_CASE("messages behind later ones of their channel are told by whoever reads the file") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string bytes = part_of(1, {messages_of(30, 60), messages_of(0, 30)}, false);
  const auto survey = survey_recording(files, folder.write("a.mcap", bytes));
  const Findings told = judge_order("a.mcap", *survey);
  REQUIRE(told.size() == 1);
  CHECK(to_string(told.front().what) ==
        "a.mcap: expected each channel's messages in their order, found some behind later ones");
  const auto sound = survey_recording(files, folder.write("b.mcap", part_of(1, 0, 60, true)));
  CHECK(judge_order("b.mcap", *sound).empty());
}

TEST_CASE("of two files that say one number the higher one in the name is the later") {
  const FreshFolder folder;  // the state after every sync failed and the program was killed
  PosixFiles files;
  const std::string second = folder.write("a.part9.mcap", part_of(2, 10, 40, false));
  const std::string third = folder.write("a.part10.mcap", part_of(2, 10, 60, true));
  const auto parts = read_parts(files, {third, second}, {});
  REQUIRE(parts);
  CHECK(parts->front().path == second);
  const auto from = parts_from(files, second, {});
  REQUIRE(from);
  CHECK(from->size() == 2);
  CHECK(parts_from(files, third, {})->size() == 1);
}

TEST_CASE("a bad page in one file costs what only that one has") {
  const FreshFolder folder;
  const std::string one = part_of(1, 0, 500, false), other = part_of(2, 200, 700, true);
  const std::string a = folder.write("a.mcap", one);
  const std::string b = folder.write("a.part2.mcap", other);
  REQUIRE(one.size() > 4 * BadPage::size);
  for (const auto& [path, left] : {std::pair(a, 500), std::pair(b, 500)}) {
    BadPage files(path, 3 * BadPage::size);  // each has one chunk
    const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == static_cast<std::uint64_t>(left));
    CHECK(worst_of(recovered->findings) == Severity::error);
  }
}

TEST_CASE("of a first file in which nothing can be read the files beside it are named") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", std::string(mcap_magic) + std::string(100, '?'));
  folder.write("a.part2.mcap", part_of(2, 0, 30, true));
  const auto refused = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().found == "nothing; beside it are a.part2.mcap");
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
  CHECK(survey_parts(files, *parts_from(files, a, {}), {})->messages == 80);
  const ReadMcap read = read_mcap(folder.read("b.mcap"));
  for (std::uint32_t k = 0; k < 80; ++k) CHECK(read.messages[k].data == nth_message(k).data);
}

TEST_CASE("where a disk gives a page at one reading and not at the other, recover makes nothing") {
  const FreshFolder folder;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 500, false));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 200, 700, true));
  int refusals = 0, openings = 0;
  for (;;) {  // the file's beginning is read more than once, too
    BadPage files(b, 3 * BadPage::size);
    files.only_opening = ++openings;
    const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::yes);
    if (!recovered) {
      CHECK(recovered.error().expected == "files that a second reading finds as the first one did");
      ++refusals;
      continue;
    }
    CHECK(recovered->messages == 700);
    if (files.openings() < openings) break;
  }
  CHECK(refusals == 1);  // one case: the second reading has the page that the first one missed
}

TEST_CASE("a survey of parts has each channel once, as a checksum covers it") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string first = torn_at(part_of(1, 0, 20, false), 18);
  const std::string a = folder.write("a.mcap", replaced(first, "/topic2", "/topik2"));
  folder.write("a.part2.mcap", part_of(2, 5, 40, true));
  const auto survey = survey_parts(files, *parts_from(files, a, {}), {});
  REQUIRE(survey);
  REQUIRE(survey->channels.size() == 3);
  CHECK(survey->channels[1].channel.topic == "/topic2");
  CHECK(survey->messages == 40);
}

TEST_CASE(
    "of a channel that one file does not name one copy is read, whichever reads them in turn") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", nameless(torn_at(part_of(1, 0, 30, false), 28)));
  folder.write("a.part2.mcap", torn_at(part_of(2, 10, 60, true), 50));
  const RecordingParts parts = *parts_from(files, a, {});
  REQUIRE(parts.size() == 2);
  for (std::uint32_t k = 10; k < 28; ++k) {
    McapMessage message = nth_message(k).message;
    message.sequence /= 3;
    CHECK(stands_elsewhere(parts, 0, message));
    CHECK_FALSE(stands_elsewhere(parts, 1, message));
  }
}

TEST_CASE("a file whose beginning the disk can't give is told, and what to do") {
  const FreshFolder folder;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 500, false));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 200, 700, true));
  BadPage second(b, 0);
  const auto recovered = recover_recording(second, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 500);
  const auto told = std::find_if(recovered->findings.begin(), recovered->findings.end(),
                                 [&](const Finding& one) { return one.what.file == b; });
  REQUIRE(told != recovered->findings.end());
  CHECK(told->what.found.find("ddrescue") != std::string::npos);
  BadPage first(a, 0);
  const auto refused = recover_recording(first, {a}, folder / "c.mcap", Overwrite::no);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().expected == "a file whose beginning the disk can read");
}

TEST_CASE("a damaged part that recover had not seen is told beside what it made of others") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 30, false));
  const std::string c = folder.write("a.part3.mcap", part_of(3, 30, 90, true));
  const std::string joined = folder / "joined.mcap";
  REQUIRE(recover_recording(files, {a, c}, joined, Overwrite::no));
  CHECK(survey_recording(files, joined)->facts->joined == std::set<int>{1, 3});
  std::string second = part_of(2, 20, 40, false);
  second[second.find(nth_message(25).data)] ^= 1;
  folder.write("a.part2.mcap", second);
  CHECK(parts_from(files, joined, {})->size() == 2);
}

TEST_CASE("of two messages with one number in a file recover keeps both") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string bytes = part_of(1, {messages_of(0, 30), messages_of(27, 33)}, false);
  const std::string a = folder.write("a.mcap", bytes);
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 36);
  CHECK(recovered->twice == 0);
}

TEST_CASE("a channel that the first file does not define has in a survey the later one's name") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", nameless(torn_at(part_of(1, 0, 30, false), 28)));
  folder.write("a.part2.mcap", torn_at(part_of(2, 10, 60, true), 50));
  const auto survey = survey_parts(files, *parts_from(files, a, {}), {});
  REQUIRE(survey);
  REQUIRE(survey->channels.size() == 3);
  CHECK(survey->channels.front().channel.topic == "/topic1");
  CHECK(survey->messages == 50);
}
