// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_keys.h"

#include <doctest/doctest.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace kinalign {

namespace {

struct Folder {
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "keysXXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& text, mode_t mode) const {
    const std::string name = path + "/lab.key";
    std::filesystem::remove(name);
    std::ofstream(name) << text;
    ::chmod(name.c_str(), mode);
    return name;
  }
  std::string path;
};

const std::string digits = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f";

}  // namespace

TEST_CASE("a node's key is the one that openssl's own program derives") {
  // printf 'kinalign node key 7' | openssl dgst -sha256 -mac HMAC -macopt hexkey:0001…1f
  LabKey lab{};
  for (std::size_t i = 0; i < lab.size(); ++i) lab[i] = static_cast<std::uint8_t>(i);
  CHECK(key_text(node_key(lab, 7)) == "56f3d684013713b5efdc34acdc46e3ef");
  CHECK(key_text(node_key(lab, 4294967295)) == "1632d04b559661b452da2e554b9a40a9");
}

TEST_CASE("a lab key is read from a file that its owner alone may read") {
  const Folder folder;
  PosixFiles files;
  for (const std::string end : {"", "\n"}) {
    const auto key = read_lab_key(files, folder.file(digits + end, 0600));
    REQUIRE(key);
    CHECK(key_text(*key) == digits);
  }
  CHECK(read_lab_key(files, folder.file(digits, 0400)));
  for (const mode_t mode : {0640U, 0604U, 0660U, 0666U, 0777U}) {
    const std::string path = folder.file(digits, mode);
    const auto key = read_lab_key(files, path);
    REQUIRE_FALSE(key);
    CHECK(key.error().expected == "a key file that only you can read (chmod 600)");
    CHECK(key.error().found.starts_with("mode 0"));
  }
  CHECK(read_lab_key(files, folder.file(digits, 0640)).error().found == "mode 0640");
}

TEST_CASE("a text that is not a lab key is refused, and no byte of it is shown") {
  const Folder folder;
  PosixFiles files;
  const std::vector<std::string> wrong{"",
                                       digits.substr(1),
                                       digits + "00",
                                       digits + " \n",
                                       std::string(64, 'g'),
                                       std::string(500, 'a')};
  for (const std::string& text : wrong) {
    const std::string path = folder.file(text, 0600);
    const auto key = read_lab_key(files, path);
    REQUIRE_FALSE(key);
    CHECK(to_string(key.error()) ==
          path + ": expected a lab key of 64 hexadecimal digits, found other text");
  }
  const std::string node_key_file = folder.file(digits.substr(0, 32) + "\n", 0600);
  CHECK(read_lab_key(files, node_key_file).error().found == "32 digits, a node's key");
  CHECK(read_lab_key(files, folder.path).error().found == "no regular file");
  CHECK(read_lab_key(files, folder.path + "/none").error().found == "No such file or directory");
}

TEST_CASE("a key is written for its owner alone, and never over anything") {
  const Folder folder;
  PosixFiles files;
  const std::string path = folder.path + "/lab.key";
  const auto key = new_lab_key();
  REQUIRE(key);
  REQUIRE(write_key(files, path, *key));
  struct stat found {};
  REQUIRE(::stat(path.c_str(), &found) == 0);
  CHECK((found.st_mode & 0777U) == 0600U);
  CHECK(*read_lab_key(files, path) == *key);
  const auto again = write_key(files, path, LabKey{});
  REQUIRE_FALSE(again);
  CHECK(again.error().found == "an existing file, which is not overwritten");
  CHECK(*read_lab_key(files, path) == *key);
}

TEST_CASE("a lab key of another user is refused with the owner's name") {
  struct Forbidden : PosixFiles {
    int open(const char*, int, mode_t) override {
      errno = EACCES;
      return -1;
    }
  } files;
  const Folder folder;
  const passwd* me = ::getpwuid(::getuid());
  const std::string owner = me != nullptr ? me->pw_name : std::to_string(::getuid());
  CHECK(read_lab_key(files, folder.file(digits, 0400)).error().found ==
        "no permission to read this file: it belongs to " + owner + ", mode 0400");
  CHECK(read_lab_key(files, folder.path + "/none").error().found ==
        "no permission to read this file");
}

TEST_CASE("why a lab key could not be read stands in the error's kind") {
  struct Forbidden : PosixFiles {
    int open(const char*, int, mode_t) override {
      errno = EACCES;
      return -1;
    }
  } forbidden;
  const Folder folder;
  PosixFiles files;
  const auto kind = [](const Result<LabKey>& key) { return key.error().kind; };
  CHECK(kind(read_lab_key(files, folder.file(digits, 0640))) == ErrorKind::exposed_key);
  CHECK(kind(read_lab_key(forbidden, folder.file(digits, 0600))) == ErrorKind::forbidden_key);
  CHECK(kind(read_lab_key(files, folder.path + "/none")) == ErrorKind::no_such_file);
  CHECK(kind(read_lab_key(files, folder.file("no key", 0600))) == ErrorKind::other);
  CHECK(kind(read_lab_key(files, folder.path)) == ErrorKind::other);
}

TEST_CASE("a key for a folder that is not there names the folder") {
  const Folder folder;
  PosixFiles files;
  const auto written = write_key(files, folder.path + "/nodir/x", LabKey{});
  REQUIRE_FALSE(written);
  CHECK(to_string(written.error()) == folder.path + "/nodir/x: expected a place for a new key " +
                                          "file, found no folder " + folder.path + "/nodir");
}

TEST_CASE("keys that were replaced are good for a minute") {
  LabKey first{}, second{};
  second[0] = 1;
  KeyRing ring(first), none;
  const HostTime now{std::chrono::hours(1)};
  CHECK(none.key_of(7) == nullptr);
  CHECK(ring.old_key_of(7, now) == nullptr);
  ring.replace(second, now);
  CHECK(*ring.key_of(7) == node_key(second, 7));
  CHECK(*ring.key_of(7 + 256) == node_key(second, 7 + 256));
  CHECK(*ring.old_key_of(7, now + std::chrono::seconds(59)) == node_key(first, 7));
  CHECK(ring.old_key_of(7, now + std::chrono::seconds(60)) == nullptr);
}

}  // namespace kinalign
