// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/key_file.h"

#include "kinalign/wire/hex.h"

#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

namespace kinalign {

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string octal(unsigned mode) {
  std::array<char, 8> digits{};
  const auto [end, error] = std::to_chars(digits.begin(), digits.end(), mode & 07777U, 8);
  return '0' + std::string(digits.begin(), end);
}

}  // namespace

Tried<MacKey> read_key_file(const std::string& path) {
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "re"));
  if (!file) {
    return failure(path + ": expected a key, found: " + std::strerror(errno) +
                   "; kinalign node-key --lab-key LAB --node N -o FILE makes one");
  }
  struct stat found {};
  if (fstat(fileno(file.get()), &found) != 0 || !S_ISREG(found.st_mode)) {
    return failure(path + ": expected a regular file with a key, found none");
  }
  if ((found.st_mode & 077U) != 0) {
    return failure(path + ": expected mode 0600, so that only you can read the key, found " +
                   octal(found.st_mode) + ": chmod 600 " + path);
  }
  std::array<char, 80> text{};
  std::string_view digits(text.data(), std::fread(text.data(), 1, text.size(), file.get()));
  if (!digits.empty() && digits.back() == '\n') digits.remove_suffix(1);
  MacKey key{};
  if (take_hex(digits, key)) return key;
  // Any other content may be secret, so the message does not show it.
  std::array<std::uint8_t, 32> lab{};
  const char* instead = take_hex(digits, lab) ? "64 digits, the lab's key" : "other text";
  return failure(path + ": expected a key of 32 hexadecimal digits, found " + instead);
}

}  // namespace kinalign
