// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/files.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <utility>

using namespace kinalign;

namespace {

Result<void> write_file(FileSystem& files, const std::string& path, Overwrite overwrite) {
  OutputFile file = KA_TRY(OutputFile::create(files, path, overwrite));
  KA_TRY(file.write("new "));
  KA_TRY(file.write("text"));
  return file.commit();
}

std::string refusal(const Result<void>& result) { return result ? "" : to_string(result.error()); }

/// "FOLDER/name: ..." without the folder.
template <class T>
std::string refusal_in(const FreshFolder& folder, const Result<T>& result) {
  REQUIRE(!result);
  const std::string text = to_string(result.error());
  REQUIRE(text.starts_with(folder.path() + "/"));
  return text.substr(folder.path().size() + 1);
}

}  // namespace

TEST_CASE("a file is read from front to back in pieces") {
  const FreshFolder folder;
  PosixFiles files;
  std::string bytes;
  for (std::size_t i = 0; i < 2 * InputFile::piece_size + 77; ++i) {
    bytes += static_cast<char>(i * 131 >> 4);
  }
  auto file = InputFile::open(files, folder.write("data", bytes));
  REQUIRE(file);
  CHECK(file->size() == bytes.size());
  std::string found;
  for (;;) {
    const auto piece = file->next();
    REQUIRE(piece);
    CHECK(piece->size() <= InputFile::piece_size);
    if (piece->empty()) break;
    found += *piece;
  }
  CHECK(found == bytes);
  CHECK(read_whole(files, folder / "data", bytes.size()) == bytes);
}

TEST_CASE("a folder and a bad disk have kinds of their own among the errors") {
  const FreshFolder folder;
  PosixFiles files;
  const auto kind = [](const auto& result) { return result.error().kind; };
  CHECK(kind(InputFile::open(files, folder.path())) == ErrorKind::directory);
  CHECK(kind(InputFile::open(files, folder / "none")) == ErrorKind::other);
  CHECK(kind(InputFile::open(files, "/dev/null")) == ErrorKind::other);
  const std::string path = folder.write("data", "12345");
  for (const auto& [code, expected] :
       {std::pair(EIO, ErrorKind::unreadable_disk), std::pair(EACCES, ErrorKind::other)}) {
    FaultyFiles faulty;
    faulty.code = code;
    faulty.fail_at = 1;
    CHECK(kind(InputFile::open(faulty, path)) == expected);
    auto file = InputFile::open(faulty, path);
    REQUIRE(file);
    faulty.fail_at = faulty.calls + 1;
    CHECK(kind(file->next()) == expected);
    faulty.fail_at = faulty.calls + 1;
    std::array<char, 4> some{};
    CHECK(kind(file->read_at(0, some)) == expected);
  }
}

TEST_CASE("what is no regular file is refused at once, with what it is") {
  const FreshFolder folder;
  PosixFiles files;
  CHECK(refusal_in(folder, InputFile::open(files, folder / "none")) ==
        "none: expected a readable file, found No such file or directory");
  REQUIRE(::mkdir((folder / "sub").c_str(), 0700) == 0);
  CHECK(refusal_in(folder, InputFile::open(files, folder / "sub")) ==
        "sub: expected a regular file, found a directory");
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK(refusal_in(folder, InputFile::open(files, folder / "pipe")) ==
        "pipe: expected a regular file, found a pipe; save it to a file first");
  const auto device = InputFile::open(files, "/dev/null");
  REQUIRE(!device);
  CHECK(to_string(device.error()) == "/dev/null: expected a regular file, found a device");
  folder.write("large", "12345");
  CHECK(refusal_in(folder, read_whole(files, folder / "large", 4)) ==
        "large: expected at most 4 bytes, found more");
}

TEST_CASE("a reading that fails says so") {
  const FreshFolder folder;
  folder.write("data", "text");
  for (const auto& [call, place] : {std::pair{1, ""}, std::pair{2, " at byte 0"}}) {
    FaultyFiles files;
    files.fail_at = call;
    CHECK(refusal_in(folder, read_whole(files, folder / "data", 100)) ==
          std::string("data: expected a readable file, found No space left on device") + place);
  }
}

TEST_CASE("a written file is there whole after commit and not at all before") {
  for (const bool nameless : {true, false}) {
    CAPTURE(nameless);
    const FreshFolder folder;
    FaultyFiles files;
    files.nameless = nameless;
    files.most = 3;
    {
      auto file = OutputFile::create(files, folder / "out", Overwrite::no);
      REQUIRE(file);
      REQUIRE(file->write("some text"));
      CHECK(::access((folder / "out").c_str(), F_OK) != 0);
      CHECK(folder.names().size() == (nameless ? 0 : 1));
      REQUIRE(file->commit());
    }
    CHECK(folder.names() == std::vector<std::string>{"out"});
    CHECK(folder.read("out") == "some text");
  }
}

TEST_CASE("a file that is not committed leaves nothing") {
  for (const bool nameless : {true, false}) {
    CAPTURE(nameless);
    const FreshFolder folder;
    FaultyFiles files;
    files.nameless = nameless;
    REQUIRE(OutputFile::create(files, folder / "out", Overwrite::yes)->write("text"));
    CHECK(folder.names().empty());
  }
}

TEST_CASE("an existing file is overwritten only when asked for") {
  const FreshFolder folder;
  PosixFiles files;
  folder.write("out", "old");
  CHECK(refusal_in(folder, write_file(files, folder / "out", Overwrite::no)) ==
        "out: expected no file of that name (--force overwrites), found an existing file");
  CHECK(folder.read("out") == "old");
  CHECK(refusal(write_file(files, folder / "out", Overwrite::yes)).empty());
  CHECK(folder.read("out") == "new text");
  CHECK(folder.names().size() == 1);
}

TEST_CASE("a name taken while a file is written is not overwritten") {
  for (const bool nameless : {true, false}) {
    CAPTURE(nameless);
    const FreshFolder folder;
    FaultyFiles files;
    files.nameless = nameless;
    auto file = OutputFile::create(files, folder / "out", Overwrite::no);
    REQUIRE(file);
    folder.write("out", "theirs");
    CHECK(refusal_in(folder, file->commit()) ==
          "out: expected no file of that name (--force overwrites), found an existing file");
    file = Failure(Error{});
    CHECK(folder.read("out") == "theirs");
    CHECK(folder.names().size() == 1);
  }
}

TEST_CASE("what is no regular file is not overwritten") {
  const FreshFolder folder;
  PosixFiles files;
  REQUIRE(::mkdir((folder / "sub").c_str(), 0700) == 0);
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  REQUIRE(::symlink("elsewhere", (folder / "link").c_str()) == 0);
  CHECK(refusal_in(folder, write_file(files, folder / "sub", Overwrite::yes)) ==
        "sub: expected a regular file or no file, found a directory");
  CHECK(refusal_in(folder, write_file(files, folder / "pipe", Overwrite::yes)) ==
        "pipe: expected a regular file or no file, found a pipe; save it to a file first");
  CHECK(refusal_in(folder, write_file(files, folder / "link", Overwrite::yes)) ==
        "link: expected a regular file or no file, found a symbolic link");
  CHECK(refusal_in(folder, write_file(files, folder / "sub/", Overwrite::yes)) ==
        "sub/: expected the name of a file, found the name of a folder");
  CHECK(refusal_in(folder, write_file(files, folder / "none/out", Overwrite::no)) ==
        "none/out: expected a folder that can be written, found No such file or directory");
}

TEST_CASE("whichever call fails, the old file or the whole new one stands there, and no other") {
  for (const bool nameless : {true, false}) {
    for (const auto overwrite : {Overwrite::no, Overwrite::yes}) {
      int failures = 0;
      for (int k = 1; k < 30; ++k) {
        CAPTURE(nameless);
        CAPTURE(k);
        const FreshFolder folder;
        if (overwrite == Overwrite::yes) folder.write("out", "old");
        FaultyFiles files;
        files.nameless = nameless;
        files.fail_at = k;
        const auto result = write_file(files, folder / "out", overwrite);
        const auto names = folder.names();
        CHECK(std::all_of(names.begin(), names.end(), [](auto& name) { return name == "out"; }));
        if (result) {
          CHECK(folder.read("out") == "new text");
        } else {
          ++failures;
          CHECK(folder.read("out") == (overwrite == Overwrite::yes ? "old" : ""));
          CHECK(names.size() == (overwrite == Overwrite::yes ? 1 : 0));
          CHECK(to_string(result.error()).ends_with("found No space left on device"));
        }
        if (files.calls < k) break;
      }
      CHECK(failures >= 5);  // opening, two writes, syncing, placing
    }
  }
}

TEST_CASE("a file that lost a piece can't be committed, wherever it was to stand") {
  using Lose = bool (*)(OutputFile & file);
  const Lose ways[] = {[](OutputFile& file) { return file.write("lost").has_value(); },
                       [](OutputFile& file) { return file.write_at(7, "lost").has_value(); },
                       [](OutputFile& file) { return file.reserve(100).has_value(); }};
  for (const Lose lose : ways) {
    const FreshFolder folder;
    FaultyFiles files;
    auto file = OutputFile::create(files, folder / "out", Overwrite::no);
    REQUIRE(file);
    files.fail_at = 2;
    CHECK(!lose(*file));
    CHECK(!file->write("more"));
    CHECK(!file->commit());
    CHECK(folder.names().empty());
  }
}

TEST_CASE("a disk that takes nothing is full") {
  const FreshFolder folder;
  FaultyFiles files;
  files.most = 0;
  auto file = OutputFile::create(files, folder / "out", Overwrite::no);
  REQUIRE(file);
  const auto written = file->write_at(3, "a");
  REQUIRE(!written);
  CHECK(to_string(written.error()) ==
        (folder / "out") + ": expected room to write, found No space left on device");
}

TEST_CASE("a program killed while it writes leaves what stood there") {
  for (const auto overwrite : {Overwrite::no, Overwrite::yes}) {
    const FreshFolder folder;
    if (overwrite == Overwrite::yes) folder.write("out", "old");
    const auto before = folder.names();
    const pid_t child = ::fork();
    if (child == 0) {
      PosixFiles files;
      auto file = OutputFile::create(files, folder / "out", overwrite);
      if (!file || !file->write(std::string(100000, 'x'))) ::_exit(1);
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    CHECK(folder.names() == before);
    if (overwrite == Overwrite::yes) CHECK(folder.read("out") == "old");
  }
}

TEST_CASE("a moved output file is still the one to commit") {
  const FreshFolder folder;
  PosixFiles files;
  auto first = OutputFile::create(files, folder / "out", Overwrite::no);
  REQUIRE(first);
  OutputFile second = std::move(*first);
  REQUIRE(second.write("text"));
  REQUIRE(second.commit());
  CHECK(folder.read("out") == "text");
}

TEST_CASE("a path has a folder and a name") {
  CHECK(file_name("a/b/c.txt") == "c.txt");
  CHECK(folder("a/b/c.txt") == "a/b/");
  CHECK(file_name("c.txt") == "c.txt");
  CHECK(folder("c.txt").empty());
  CHECK(folder("/c") == "/");
}

TEST_CASE("the error for a page that a disk can't read names its position") {
  const FreshFolder folder;
  const std::string path = folder.write("data", std::string(3 * BadPage::size, 'x'));
  BadPage files(path, BadPage::size);
  auto file = InputFile::open(files, path);
  REQUIRE(file);
  CHECK(file->next()->size() == BadPage::size);
  CHECK(to_string(file->next().error()) ==
        path + ": expected a readable file, found Input/output error at byte 4096");
}
