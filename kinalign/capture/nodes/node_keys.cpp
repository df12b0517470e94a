// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_keys.h"

#include "kinalign/wire/hex.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <pwd.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace kinalign {

namespace {

Failure no_key(const std::string& path, const std::string& expected, const std::string& found,
               ErrorKind kind = ErrorKind::other) {
  return Failure(Error{path, 0, expected, found, kind});
}

std::string octal(unsigned mode) {
  std::string text = "mode 0000";
  for (std::size_t i = 0; i < 3; ++i)
    text[6 + i] = static_cast<char>('0' + (mode >> (6 - 3 * i) & 7U));
  return text;
}

/// Checks that only the owner may read the file. The open file is checked, not its path, so the
/// file can't be exchanged between check and read.
Result<void> check_mode(int fd, const std::string& path) {
  struct stat found {};
  if (::fstat(fd, &found) != 0) return no_key(path, "a key file", std::strerror(errno));
  if (!S_ISREG(found.st_mode)) return no_key(path, "a key file", "no regular file");
  if ((found.st_mode & 077U) == 0) return {};
  return no_key(path, "a key file that only you can read (chmod 600)", octal(found.st_mode),
                ErrorKind::exposed_key);
}

/// The message for a file that this user may not read. It names the file's owner and mode if they
/// are known.
std::string forbidden(const std::string& path) {
  std::string text = "no permission to read this file";
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return text;
  const passwd* owner = ::getpwuid(found.st_uid);
  const std::string name = owner != nullptr ? owner->pw_name : std::to_string(found.st_uid);
  return text + ": it belongs to " + name + ", " + octal(found.st_mode);
}

/// The error for a lab key file that could not be opened.
Failure no_lab_key(const std::string& path, int code) {
  if (code == EACCES) return no_key(path, "a lab key", forbidden(path), ErrorKind::forbidden_key);
  const ErrorKind kind = code == ENOENT ? ErrorKind::no_such_file : ErrorKind::other;
  return no_key(path, "a lab key", std::strerror(code), kind);
}

/// The message for a file that could not be created.
std::string no_place(const std::string& path, int error) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code unknown;
  const bool nowhere =
      error == ENOENT && !folder.empty() && !std::filesystem::exists(folder, unknown);
  return nowhere ? "no folder " + folder.string() : std::strerror(error);
}

template <class Key>
Result<Key> drawn() {
  Key key{};
  if (::getrandom(key.data(), key.size(), 0) == static_cast<ssize_t>(key.size())) return key;
  return Failure(Error{"", 0, "random numbers from the system", "an error"});
}

}  // namespace

// Each node gets only its own key, so a lost node does not reveal the key of another node.
MacKey node_key(const LabKey& lab, std::uint32_t node_id) {
  const std::string name = "kinalign node key " + std::to_string(node_id);
  std::array<std::uint8_t, 32> whole{};
  unsigned size = 0;
  const auto* bytes = reinterpret_cast<const unsigned char*>(name.data());
  const auto* done = ::HMAC(::EVP_sha256(), lab.data(), static_cast<int>(lab.size()), bytes,
                            name.size(), whole.data(), &size);
  assert(done != nullptr && size == whole.size());
  (void)done;
  MacKey key{};
  std::copy_n(whole.begin(), key.size(), key.begin());
  return key;
}

Result<LabKey> new_lab_key() { return drawn<LabKey>(); }

Result<SipHashKey> new_secret() { return drawn<SipHashKey>(); }

std::string key_text(std::span<const std::uint8_t> key) {
  std::string text(2 * key.size(), ' ');
  put_hex(key, text);
  return text;
}

// If the path is a pipe, O_NONBLOCK prevents open from waiting.
Result<LabKey> read_lab_key(FileSystem& files, const std::string& path) {
  const OpenFile file(files, files.open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK, 0));
  if (file.fd() < 0) return no_lab_key(path, errno);
  KA_TRY(check_mode(file.fd(), path));
  // The buffer is longer than a key file, so a file that is too long is noticed.
  std::array<char, 128> text{};
  const ssize_t got = files.read(file.fd(), text.data(), text.size());
  std::string_view digits(text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (digits.ends_with('\n')) digits.remove_suffix(1);
  LabKey key{};
  if (take_hex(digits, key)) return key;
  MacKey node{};
  const bool is_node_key = take_hex(digits, node);
  return no_key(path, "a lab key of 64 hexadecimal digits",
                is_node_key ? "32 digits, a node's key" : "other text");
}

Result<void> write_key(FileSystem& files, const std::string& path,
                       std::span<const std::uint8_t> key) {
  const OpenFile file(files,
                      files.open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (file.fd() < 0) {
    const bool there = errno == EEXIST;
    return no_key(path, "a place for a new key file",
                  there ? "an existing file, which is not overwritten" : no_place(path, errno));
  }
  const std::string text = key_text(key) + '\n';
  const bool written =
      files.write(file.fd(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      files.sync(file.fd()) == 0;
  if (written) return {};
  const std::string why = std::strerror(errno);
  files.remove(path.c_str());  // an incomplete key file is useless
  return no_key(path, "room for a key", why);
}

const MacKey* KeyRing::Derived::key_of(std::uint32_t node_id) {
  if (!lab) return nullptr;
  Key& place = kept[node_id % most];
  // Two nodes with the same index replace each other, which only costs time.
  if (place.node_id != node_id) place = {node_id, node_key(*lab, node_id)};
  return &place.key;
}

const MacKey* KeyRing::old_key_of(std::uint32_t node_id, HostTime now) {
  return now < before_ends_ ? before_.key_of(node_id) : nullptr;
}

void KeyRing::replace(const LabKey& lab, HostTime now) {
  before_ = std::exchange(now_, Derived(lab));
  before_ends_ = now + old_key_lasts;
}

}  // namespace kinalign
