// SPDX-License-Identifier: Apache-2.0
// Names that an archive may have. dataset_import_check.py tests real archives with malicious names.
#include "kinalign/formats/archive/archive.h"

#include "kinalign/formats/tar/tar_write.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

namespace {

std::string name_fault(std::string_view name) {
  const auto safe = safe_archive_name(name);
  return safe ? "" : to_string(safe.error());
}

ArchiveBytes bytes_of(const std::string& text) {
  return {"a.tar", text.size(),
          [&text](std::uint64_t at, std::span<char> to) -> Result<std::size_t> {
            if (at >= text.size()) return std::size_t{0};
            return text.copy(to.data(), to.size(), at);
          }};
}

std::string tar_of(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string text;
  TarWriter tar([&text](std::string_view bytes) -> Result<void> {
    text += bytes;
    return {};
  });
  for (const auto& [name, bytes] : files) REQUIRE(tar.add(name, bytes));
  REQUIRE(tar.finish());
  return text;
}

std::string read_all_files(const std::string& archive, const ArchiveLimits& limits) {
  std::string out;
  const auto read =
      read_archive(bytes_of(archive), limits,
                   [&](const std::string& name, const ArchivePieces& next) -> Result<void> {
                     out += name + ":";
                     for (;;) {
                       const std::string_view piece = KA_TRY(next());
                       if (piece.empty()) break;
                       out += piece;
                     }
                     out += ";";
                     return {};
                   });
  return read ? out : to_string(read.error());
}

}  // namespace

TEST_CASE("a name in an archive is relative, and its . and empty parts are left out") {
  CHECK(safe_archive_name("a/b.txt") == "a/b.txt");
  CHECK(safe_archive_name("./a//b/./c.txt") == "a/b/c.txt");
  CHECK(safe_archive_name("..a/b..") == "..a/b..");
}

TEST_CASE("a name that leads elsewhere, or that systems read differently, is refused") {
  CHECK(name_fault("../a") == "expected names without .., found ../a");
  CHECK(name_fault("a/..") == "expected names without .., found a/..");
  CHECK(name_fault("/a") == "expected relative names, found /a");
  CHECK(name_fault("C:a") == "expected relative names, found C:a");
  CHECK(name_fault("a\\b") == "expected names without a backslash, found a\\b");
  CHECK(name_fault("a\nb").starts_with("expected names without control characters"));
  CHECK(name_fault(std::string_view("a\0b", 3)).starts_with("expected names without control"));
  CHECK(name_fault("").starts_with("expected names"));
  CHECK(name_fault("./").starts_with("expected names"));
  CHECK(name_fault(std::string(256, 'a')).starts_with("expected folders and files of at most 255"));
  CHECK(name_fault(std::string(2000, 'a')).starts_with("expected names of at most 1000 bytes"));
}

TEST_CASE("the files of a tar come in its order, with their bytes") {
  const std::string tar = tar_of({{"b/1.txt", "one"}, {"a.txt", ""}, {"b/2.txt", "two"}});
  CHECK(read_all_files(tar, {}) == "b/1.txt:one;a.txt:;b/2.txt:two;");
}

TEST_CASE("an archive above the limits is refused") {
  const std::string tar = tar_of({{"a.txt", "123456"}, {"b.txt", "123456"}});
  CHECK(read_all_files(tar, {.entries = 1}) ==
        "a.tar: expected at most 1 entries in the archive, found more");
  CHECK(read_all_files(tar, {.bytes = 11}) ==
        "a.tar: expected at most 11 bytes in all files in the archive, found more files, up to "
        "b.txt");
  CHECK(read_all_files(tar, {.bytes = 12}) == "a.txt:123456;b.txt:123456;");
}

TEST_CASE("a name that two entries have is refused, and so is a file in place of a folder") {
  CHECK(read_all_files(tar_of({{"a.txt", "1"}, {"a.txt", "2"}}), {}) ==
        "a.tar: expected each name once in the archive, found a.txt again");
  CHECK(read_all_files(tar_of({{"a", "1"}, {"a/b", "2"}}), {}) ==
        "a.tar: expected each name once in the archive, found a/b again");
  CHECK(read_all_files(tar_of({{"a/b", "1"}, {"a", "2"}}), {}) ==
        "a.tar: expected each name once in the archive, found a again");
}

TEST_CASE("a file that fails while it is read says so, and not that the archive is damaged") {
  const ArchiveBytes failing{
      "a.zip", 1000, [](std::uint64_t, std::span<char>) {
        return Result<std::size_t>(Failure(Error{"a.zip", 0, "a readable file", "no more disk"}));
      }};
  const auto read =
      read_archive(failing, {}, [](const auto&, const auto&) -> Result<void> { return {}; });
  REQUIRE_FALSE(read);
  CHECK(to_string(read.error()) == "a.zip: expected a readable file, found no more disk");
}
