// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_parts.h"

#include "tests/folder.h"
#include "tests/io/recorded_lab.h"

#include "kinalign/io/recover_recording.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// A recording of forty seconds whose disk failed at 25 s: the second file repeats half a second.
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
  /// All in one file.
  std::string whole() { return write("whole_take.mcap", {}); }
  RecordedLab& lab() { return lab_; }

 private:
  const FreshFolder* folder_;
  RecordedLab lab_{20261123};
};

}  // namespace

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
  std::vector<McapChunkIndex> chunks;  // of half a second each
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
}
