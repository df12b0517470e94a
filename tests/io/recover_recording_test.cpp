// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recover_recording.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/io/mcap_files.h"
#include "tests/io/recorded_lab.h"

#include "kinalign/io/recording_parts.h"

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
      if (!recovered) {  // cut in front of what stands before messages: metadata
        CHECK(before.messages.empty());
        CHECK(cut < 200);
        CHECK(to_string(recovered.error()) ==
              path + ": expected a recording in which a message can be read, found none");
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
      CHECK(folder.read("a.mcap") == torn);  // the torn one stays as it is
    }
  }
}

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
  REQUIRE(named_one);  // what lies beside it belongs to it
  CHECK(named_one->messages == 60);
  REQUIRE(named_one->findings.size() == 1);
  CHECK(named_one->findings.back().severity == Severity::note);
  CHECK(named_one->findings.back().what.found == "a.part2.mcap");
}

namespace {

Severity worst_of(const Findings& findings) {
  Severity worst = Severity::note;
  for (const Finding& one : findings) worst = std::max(worst, one.severity);
  return worst;
}

/// Messages [from, to), numbered by channel, as ours are.
McapChunkContent messages_of(int from, int to) {
  McapChunkContent content;
  for (int k = from; k < to; ++k) {
    OwnedMessage message = nth_message(static_cast<std::uint32_t>(k));
    message.message.sequence /= 3;
    add(content, message);
  }
  return content;
}

/// Part of a recording, closed in order; `ends`: recording ended there.
std::string part_of(int part, int from, int to, bool ends) {
  MemoryFile file;
  McapWriter writer(file.store());
  REQUIRE(writer.begin({"kinalign", "test"}));
  REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", part, {}})));
  REQUIRE(writer.write(store(messages_of(from, to), McapCompression::none)));
  if (ends) REQUIRE(writer.write(to_metadata(RecordingEnd{})));
  REQUIRE(writer.finish());
  return file.bytes;
}

}  // namespace

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
        a + ": expected a recording up to its end, found one that ends before");
  for (const char* name : {"a.mcap", "b.mcap"}) {
    const auto survey = survey_recording(files, folder / name);
    CHECK(judge_end("x", *survey).size() == 1);
  }
  const std::string torn = part_of(1, 0, 20, false);
  const std::string cut = folder.write("c.mcap", torn.substr(0, torn.size() - 20));
  REQUIRE(recover_recording(files, {cut}, folder / "d.mcap", Overwrite::no));
  const auto survey = survey_recording(files, folder / "d.mcap");
  CHECK(survey->ending == Ending::torn);
  CHECK(judge_end("x", *survey).empty());
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
  CHECK(parts_from(files, a, {})->size() == 2);
  CHECK(parts_from(files, whole, {})->size() == 1);
  // Nor is a file written over that was not needed.
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
    return survey_recording(files, folder / out)->ending == Ending::torn;
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
    for (const Finding& one : recovered->findings) CHECK(one.what.found != "one that ends before");
    const auto survey = survey_recording(files, folder / "b.mcap");
    CHECK(survey->ending == Ending::torn);
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
  std::string nameless = part_of(2, 14, 26, false);
  nameless.resize(nameless.find(nth_message(25).data));  // torn in its chunk, whose channels …
  for (auto at = nameless.find("/topic"); at != std::string::npos;
       at = nameless.find("/topic", at + 1)) {
    nameless[at - 17] = 0x7e;  // … are records of another kind now
  }
  folder.write("a.part2.mcap", nameless);
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
  // In a part's place.
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
    const ReadMcap read = read_mcap(folder.read("b.mcap"));
    REQUIRE(read.messages.size() == (first_is_torn ? 24 : 20));
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
    const auto survey = survey_parts(files, *parts_from(files, a, {}), {});
    REQUIRE(survey);
    return judge_end(a, *survey).empty();
  };
  CHECK_FALSE(says_end());
  folder.write("a.part3.mcap", cut(part_of(3, 54, 57, false)));
  CHECK(says_end());
  const auto recovered = recover_recording(files, {a}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->messages == 60);
  CHECK(survey_recording(files, folder / "b.mcap")->ending == Ending::torn);
}

TEST_CASE("a file with a part's name that does not say that it is one is told, and kept") {
  const std::string one = part_of(1, 0, 20, false), other = part_of(2, 10, 40, true);
  const auto cut = one.substr(0, one.size() - 20);
  const auto damaged = [](std::string bytes) {
    bytes[bytes.find("raw_ns") + 10] ^= 1;
    return bytes;
  };
  const std::string another = "one of another run, or with a damaged beginning";
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
  CHECK(alone->findings.back().what.found ==
        "a part of one, while the other does not say of which it is");
  std::filesystem::create_directory(folder / "a.part2.mcap");
  const auto recovered = recover_recording(files, {a}, folder / "c.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->findings.back().what.found.starts_with("one that can't be read: "));
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

TEST_CASE("of a damaged recording recover says how many bytes and messages are lost") {
  std::vector<std::size_t> ends;
  const std::string whole = mcap_file(60, 10, McapCompression::zstd, &ends);
  for (const std::size_t chunk : {0U, 3U, 5U}) {
    CAPTURE(chunk);
    const FreshFolder folder;
    PosixFiles files;
    std::string damaged = whole;
    damaged[ends[chunk] - 250] ^= 0x10;  // in front of its indexes, which are 214 bytes and less
    std::string unchecked = damaged;     // as of a program that makes no checksum of the summary
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
  std::vector<std::size_t> ends;
  const std::string whole = mcap_file(60, 10, McapCompression::zstd, &ends);
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder.write("a.mcap", whole.substr(0, ends[3] - 300));
  const auto recovered = recover_recording(files, {path}, folder / "b.mcap", Overwrite::no);
  REQUIRE(recovered);
  CHECK(recovered->skipped == 0);
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
    for (const ChannelSurvey& known : undamaged->channels) {  // and one without messages, perhaps
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
  CHECK(survey->torn.empty());
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
