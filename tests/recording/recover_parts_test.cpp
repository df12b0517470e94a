// SPDX-License-Identifier: Apache-2.0
// Recovery from a recording of several files: which copy counts, the order, and the findings.
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

TEST_CASE("of two files of a recording recover takes what stands in both once") {
  const FreshFolder folder;
  PosixFiles files;
  MemoryFile first, second;
  for (const auto& [file, from, to] : {std::tuple(&first, 0, 30), std::tuple(&second, 20, 60)}) {
    McapWriter writer(file->store());
    CHECK(writer.begin({"kinalign", "test"}));
    CHECK(writer.write(to_metadata({"", "", "lab", "a.mcap", from == 0 ? 1 : 2, {}})));
    McapChunkContent content;
    for (int k = from; k < to; ++k) add(content, nth_message(static_cast<std::uint32_t>(k)));
    CHECK(writer.write(store(content, McapCompression::zstd)));
  }
  const auto recovered = recover_recording(
      files, {folder.write("a.mcap", first.bytes), folder.write("a.part2.mcap", second.bytes)},
      folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 60);
  CHECK(recovered->twice == 10);
  const ReadMcap read = read_mcap(folder.read("b.mcap"));
  REQUIRE(read.messages.size() == 60);
  for (std::uint32_t k = 0; k < 60; ++k) CHECK(read.messages[k].message.sequence == k);

  const auto named_one =
      recover_recording(files, {folder / "a.mcap"}, folder / "c.mcap", Overwrite::no);
  REQUIRE(named_one);  // the part in the same folder belongs to the recording
  CHECK(named_one->messages == 60);
  REQUIRE(named_one->findings.size() == 1);
  CHECK(named_one->findings.back().severity == Severity::note);
  CHECK(named_one->findings.back().what.found == "a.part2.mcap");
}

TEST_CASE(
    "recover takes the parts beside those that it is given, and no part's name for its file") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 20, false));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 20, 40, false));
  const std::string c = folder.write("a.part3.mcap", part_of(3, 40, 60, true));
  for (const auto& given :
       {std::vector{a, c}, std::vector{c, a}, std::vector{a}, std::vector{c, b}, std::vector{b}}) {
    const auto recovered = recover_recording(files, given, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == 60);
    CHECK(recovered->missing == 0);
    CHECK(worst_of(recovered->findings) == Severity::note);
  }
  for (const auto& [given, out] : {std::pair(a, c), std::pair(c, a)}) {
    const auto refused = recover_recording(files, {given}, out, Overwrite::yes);
    REQUIRE_FALSE(refused);
    CHECK(to_string(refused.error()) ==
          out + ": expected another name than those of the recording's files, found '" +
              std::filesystem::path(out).filename().string() + "', which is one of them");
  }
  std::filesystem::remove(a);
  const auto later = recover_recording(files, {c, b}, folder / "b.mcap", Overwrite::yes);
  REQUIRE(later);
  CHECK(later->messages == 40);
  CHECK(worst_of(later->findings) == Severity::warning);
}

TEST_CASE(
    "of a recording that goes on in a file that is not there recover says so, and check, too") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 20, false));
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  REQUIRE(recovered->findings.size() == 1);
  CHECK(to_string(recovered->findings.front().what) ==
        a + ": expected a recording's last file, found a file without the end of the recording");
  for (const char* name : {"a.mcap", "b.mcap"}) {
    const auto survey = survey_recording(files, folder / name);
    CHECK(ends_before(*survey));
  }
  const FreshFolder other;
  const std::string torn = part_of(1, 0, 20, false);
  const std::string cut = other.write("c.mcap", torn.substr(0, torn.size() - 20));
  REQUIRE(recover_recording(files, {cut}, other / "d.mcap", Overwrite::no));
  const auto survey = survey_recording(files, other / "d.mcap");
  CHECK(survey->ending == Ending::truncated);
  CHECK(!ends_before(*survey));
}

TEST_CASE("of a recording that ends in a file with nothing else new the end is not lost") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 20, false));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 10, 20, true));
  const std::string whole = folder / "whole.mcap";
  const auto recovered = recover_recording(files, {a}, whole, Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 20);
  CHECK(worst_of(recovered->findings) == Severity::note);
  CHECK(survey_recording(files, whole)->end);
  CHECK(find_parts(files, {a})->size() == 2);
  CHECK(find_parts(files, {whole})->size() == 1);
  // A file that was not needed is not overwritten either.
  for (const std::string& part : {a, b}) {
    const std::string before = folder.read(std::filesystem::path(part).filename().string());
    CHECK_FALSE(recover_recording(files, {whole}, part, Overwrite::yes));
    CHECK(folder.read(std::filesystem::path(part).filename().string()) == before);
  }
}

TEST_CASE("torn for good is what recover made of a recording whose last file is torn") {
  const FreshFolder folder;
  PosixFiles files;
  const auto cut = [](const std::string& bytes) { return bytes.substr(0, bytes.size() - 20); };
  const auto was_torn = [&](const std::vector<std::string>& paths, const std::string& out) {
    REQUIRE(recover_recording(files, paths, folder / out, Overwrite::no));
    return survey_recording(files, folder / out)->ending == Ending::truncated;
  };
  const std::string a = folder.write("a.mcap", cut(part_of(1, 0, 20, false)));
  CHECK(was_torn({a}, "torn.mcap"));
  CHECK(was_torn({folder / "torn.mcap"}, "again.mcap"));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 20, 40, false));
  CHECK_FALSE(was_torn({a, b}, "goes_on.mcap"));
  CHECK_FALSE(was_torn({folder / "torn.mcap", b}, "goes_on_too.mcap"));
}

TEST_CASE("a torn file that only repeats changes neither the order of messages nor their bytes") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 20, false));
  std::string torn = part_of(2, 14, 20, false);
  torn.resize(torn.find(nth_message(18).data));  // within its chunk: no checksum covers it
  const std::string spoilt = nth_message(15).data;
  torn.replace(torn.find(spoilt), spoilt.size(), spoilt.size(), '\0');
  const std::string b = folder.write("a.part2.mcap", torn);
  for (const auto& given : {std::vector{a}, std::vector{b}, std::vector{b, a}, std::vector{a, a}}) {
    const auto recovered = recover_recording(files, given, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->missing == 0);
    for (const Finding& one : recovered->findings)
      CHECK(one.what.found != "a file without the end of the recording");
    const auto survey = survey_recording(files, folder / "b.mcap");
    CHECK(survey->ending == Ending::truncated);
    for (const ChannelSurvey& channel : survey->channels) CHECK(channel.missing == 0);
    const ReadMcap read = read_mcap(folder.read("b.mcap"));
    REQUIRE(read.messages.size() == 20);
    for (std::uint32_t k = 0; k < 20; ++k) CHECK(read.messages[k].data == nth_message(k).data);
  }
}

TEST_CASE("what a torn file brings of one channel does not disturb the others") {
  const FreshFolder folder;
  PosixFiles files;
  const auto file = [](int part, const McapChunkContent& content) {
    MemoryFile memory;
    McapWriter writer(memory.store());
    REQUIRE(writer.begin({"kinalign", "test"}));
    REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", part, {}})));
    REQUIRE(writer.write(store(content, McapCompression::none)));
    REQUIRE(writer.finish());
    return memory.bytes;
  };
  const auto numbered = [](std::uint32_t k, std::uint32_t number) {
    OwnedMessage message = nth_message(k);
    message.message.sequence = number;
    return message;
  };
  McapChunkContent first, second;  // nth_message(3k) are of one channel
  for (std::uint32_t k = 0; k < 20; ++k) add(first, numbered(3 * k, k));
  for (std::uint32_t k = 15; k < 18; ++k) add(second, numbered(3 * k, k));
  for (std::uint32_t k = 0; k < 4; ++k) add(second, numbered(3 * k + 1, k));
  const std::string a = folder.write("a.mcap", file(1, first));
  std::string torn = file(2, second);
  folder.write("a.part2.mcap", torn.substr(0, torn.size() - 20));
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 24);
  CHECK(recovered->twice == 3);
  CHECK(recovered->missing == 0);
  const auto survey = survey_recording(files, folder / "b.mcap");
  REQUIRE(survey);
  for (const ChannelSurvey& one : survey->channels) CHECK(one.missing == 0);
}

TEST_CASE("no file is left out for what can't be read of it") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string one = part_of(1, 0, 20, false);
  const std::string a = folder.write("a.mcap", one.substr(0, one.size() - 20));
  std::string second = part_of(2, 14, 26, false);
  second.resize(second.find(nth_message(25).data));  // torn in its chunk
  folder.write("a.part2.mcap", nameless(second));
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 25);
  CHECK(recovered->missing == 0);
  std::string damaged = part_of(2, 14, 26, false);
  damaged[damaged.find(nth_message(25).data)] ^= 1;
  folder.write("a.part2.mcap", damaged);
  const auto told = recover_recording(files, {a}, folder / "c.mcap", Overwrite::no);
  REQUIRE(told);
  CHECK(told->messages == 20);
  CHECK(worst_of(told->findings) == Severity::error);
}

TEST_CASE("what recover made of all needs no part, wherever it stands") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string whole = folder.write("whole.mcap", part_of(1, 0, 60, true));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 20, 40, false));
  for (const auto& given : {std::vector{whole, b}, std::vector{b, whole}}) {
    const auto recovered = recover_recording(files, given, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(recovered->messages == 60);
    CHECK(recovered->missing == 0);
    CHECK(survey_recording(files, folder / "b.mcap")->channels.front().missing == 0);
  }
  // At the place of a part.
  const std::string torn = part_of(1, 0, 30, false);
  const std::string a = folder.write("a.mcap", torn.substr(0, torn.size() - 20));
  folder.write("a.part2.mcap", part_of(1, 0, 60, true));
  CHECK(recover_recording(files, {a}, folder / "b.mcap", Overwrite::yes)->messages == 60);
}

TEST_CASE("what lies between others stands between them, also where recover had joined those") {
  const FreshFolder folder;
  PosixFiles files;
  folder.write("a.mcap", part_of(1, 0, 30, false));
  folder.write("a.part3.mcap", part_of(3, 57, 90, true));
  const std::string whole = folder / "whole.mcap";
  REQUIRE(recover_recording(files, {folder / "a.mcap"}, whole, Overwrite::no)->missing == 27);
  const std::string b = folder.write("a.part2.mcap", part_of(2, 27, 60, false));
  for (const auto& given : {std::vector{whole, b}, std::vector{b, whole}, std::vector{b}}) {
    const auto recovered = recover_recording(files, given, folder / "b.mcap", Overwrite::yes);
    REQUIRE(recovered);
    CHECK(worst_of(recovered->findings) == Severity::note);
    CHECK(recovered->missing == 0);
    const ReadMcap read = read_mcap(folder.read("b.mcap"));
    REQUIRE(read.messages.size() == 90);
    for (std::uint32_t k = 0; k < 90; ++k) CHECK(read.messages[k].data == nth_message(k).data);
  }
}

TEST_CASE("a copy that a checksum covers is taken, whichever file it stands in") {
  const std::string spoilt = nth_message(17).data;
  const auto torn = [&](std::string bytes) {
    bytes.resize(bytes.find(nth_message(19).data));
    return bytes.replace(bytes.find(spoilt), spoilt.size(), spoilt.size(), '\0');
  };
  for (const bool first_is_torn : {true, false}) {
    const FreshFolder folder;
    PosixFiles files;
    const std::string first = part_of(1, 0, 20, false), second = part_of(2, 15, 24, false);
    const std::string a = folder.write("a.mcap", first_is_torn ? torn(first) : first);
    folder.write("a.part2.mcap", first_is_torn ? second : torn(second));
    REQUIRE(recover_recording(files, {a}, folder / "b.mcap", Overwrite::no));
    ReadMcap read = read_mcap(folder.read("b.mcap"));
    REQUIRE(read.messages.size() == (first_is_torn ? 24 : 20));
    // The messages of the truncated chunk, which no other part has, come last.
    if (first_is_torn) {
      std::rotate(read.messages.begin(), read.messages.begin() + 9, read.messages.end());
    }
    for (std::uint32_t k = 0; k < read.messages.size(); ++k) {
      CHECK(read.messages[k].data == nth_message(k).data);
    }
  }
}

TEST_CASE("which file is the last one tells how a recording of several ends") {
  const FreshFolder folder;
  PosixFiles files;
  const auto cut = [](const std::string& bytes) { return bytes.substr(0, bytes.size() - 20); };
  const std::string a = folder.write("a.mcap", cut(part_of(1, 0, 30, false)));
  folder.write("a.part2.mcap", part_of(2, 27, 60, false));
  const auto says_end = [&] {
    const auto survey = survey_recording(files, a);
    REQUIRE(survey);
    return !ends_before(*survey);
  };
  CHECK_FALSE(says_end());
  folder.write("a.part3.mcap", cut(part_of(3, 54, 57, false)));
  CHECK(says_end());
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 60);
  CHECK(survey_recording(files, folder / "b.mcap")->ending == Ending::truncated);
}

TEST_CASE("a file with a part's name that does not say that it is one is told, and kept") {
  const std::string one = part_of(1, 0, 20, false), other = part_of(2, 10, 40, true);
  const auto cut = one.substr(0, one.size() - 20);
  const auto damaged = [](std::string bytes) {
    bytes[bytes.find("raw_ns") + 10] ^= 1;
    return bytes;
  };
  const std::string another =
      "a part of another recording, or one of the two has a damaged beginning";
  for (const auto& [first, second, found] :
       {std::tuple(cut, damaged(other), another), std::tuple(damaged(cut), other, another),
        std::tuple(cut, std::string(),
                   std::string("a file that does not say of which recording it is"))}) {
    const FreshFolder folder;
    PosixFiles files;
    const std::string a = folder.write("a.mcap", first);
    const std::string b = folder.write("a.part2.mcap", second);
    const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
    REQUIRE(recovered);
    CHECK(recovered->messages == 20);
    REQUIRE_FALSE(recovered->findings.empty());
    CHECK(recovered->findings.back().severity == Severity::warning);
    CHECK(recovered->findings.back().what.file == b);
    CHECK(recovered->findings.back().what.found == found);
    CHECK_FALSE(recover_recording(files, {a}, b, Overwrite::yes));
    CHECK(folder.read("a.part2.mcap") == second);
  }
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", cut);
  std::string nameless = cut;
  nameless[nameless.find("raw_ns")] ^= 1;
  folder.write("n.mcap", nameless);
  folder.write("n.part2.mcap", other);
  const auto alone =
      recover_recording(files, {folder / "n.mcap"}, folder / "b.mcap", Overwrite::no);
  REQUIRE(alone);
  CHECK(alone->findings.back().what.found == another);
  std::filesystem::create_directory(folder / "a.part2.mcap");
  const auto recovered = recover_recording(files, {a}, folder / "c.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->findings.back().what.found.starts_with("a file that can't be read: "));
}

TEST_CASE("of a link the parts beside the file are taken, and not written over") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", part_of(1, 0, 20, false));
  const std::string b = folder.write("a.part2.mcap", part_of(2, 20, 40, true));
  std::filesystem::create_directory(folder / "links");
  std::filesystem::create_symlink(a, folder / "links/a.mcap");
  const std::string link = folder / "links/a.mcap";
  CHECK(recover_recording(files, {link}, folder / "b.mcap", Overwrite::no)->messages == 40);
  CHECK_FALSE(recover_recording(files, {link}, b, Overwrite::yes));
}

TEST_CASE("recover keeps all records of one name, and once what each part repeats") {
  const FreshFolder folder;
  PosixFiles files;
  std::vector<std::string> paths;
  for (const int part : {1, 2}) {
    MemoryFile file;
    McapWriter writer(file.store());
    REQUIRE(writer.begin({"kinalign", "test"}));
    REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", part, {}})));
    REQUIRE(writer.write(McapAttachment{0, 0, "lab.toml", "", "port = 1"}));
    for (const char* what : {"one", "another"}) {
      REQUIRE(writer.write(McapMetadata{"session", {{"take", what}}}));
      REQUIRE(writer.write(McapAttachment{0, 0, "photo.jpg", "", what}));
    }
    if (part == 2) REQUIRE(writer.write(to_metadata(RecordingEnd{})));
    McapChunkContent content;
    add(content, nth_message(static_cast<std::uint32_t>(part)));
    REQUIRE(writer.write(store(content, McapCompression::none)));
    REQUIRE(writer.finish());
    paths.push_back(folder.write("a" + std::to_string(part) + ".mcap", file.bytes));
  }
  const auto said_by = [&](const std::vector<std::string>& old) {
    REQUIRE(recover_recording(files, old, folder / "b.mcap", Overwrite::yes));
    std::vector<std::string> said;
    for (const McapRecord& record : read_mcap(folder.read("b.mcap")).records) {
      const auto* metadata = std::get_if<McapMetadata>(&record);
      if (metadata != nullptr && metadata->name == "session") {
        said.push_back("session " + metadata->texts.at("take"));
      } else if (metadata != nullptr) {
        said.push_back(metadata->name);
      }
      const auto* attachment = std::get_if<McapAttachment>(&record);
      if (attachment != nullptr) said.push_back(attachment->name + " " + attachment->data);
    }
    return said;
  };
  std::vector<std::string> all{"kinalign.recording", "lab.toml port = 1", "session one",
                               "photo.jpg one",      "session another",   "photo.jpg another"};
  CHECK(said_by({paths[0]}) == all);
  all.emplace_back(end_metadata);
  CHECK(said_by(paths) == all);
  CHECK(said_by({paths[1]}) == all);
}
