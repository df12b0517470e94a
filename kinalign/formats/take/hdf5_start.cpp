// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/hdf5_start.h"

#include "kinalign/formats/unknown_file.h"

#include <optional>

namespace kinalign::hdf5 {

namespace {

constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";

/// An integer of `size` bytes, the lowest first.
std::optional<std::uint64_t> number_at(std::string_view head, std::size_t at, std::size_t size) {
  if (size == 0 || size > 8 || at + size > head.size()) return std::nullopt;
  std::uint64_t out = 0;
  for (std::size_t i = size; i-- > 0;) out = out << 8 | static_cast<unsigned char>(head[at + i]);
  return out;
}

/// The address where the file says that it ends.
std::optional<std::uint64_t> stated_end(std::string_view head) {
  const auto version = number_at(head, 8, 1);
  if (!version || *version > 3) return std::nullopt;
  const std::size_t size_of_addresses = *version < 2 ? 13 : 9;
  const std::size_t addresses = *version == 0 ? 24 : *version == 1 ? 28 : 12;
  const auto width = number_at(head, size_of_addresses, 1);
  if (!width) return std::nullopt;
  return number_at(head, addresses + 2 * *width, *width);  // behind base and another one
}

}  // namespace

Result<void> check_start(const std::string& path, std::string_view head, std::uint64_t size) {
  const std::string_view start = head.substr(0, signature.size());
  if (start != signature.substr(0, start.size()) || start.empty()) {
    return Failure(Error{path, 0, "a take, which is an HDF5 file", beginning_of(head)});
  }
  const auto end = stated_end(head);
  if (end && *end <= size) return {};
  if (end) {
    return Failure(
        Error{path, 0, "a whole HDF5 file",
              "one cut short: " + std::to_string(size) + " bytes of " + std::to_string(*end)});
  }
  if (head.size() < start_bytes) {
    return Failure(
        Error{path, 0, "a whole HDF5 file", "one cut short: " + std::to_string(size) + " bytes"});
  }
  return {};  // what else there may be HDF5 itself has to say
}

}  // namespace kinalign::hdf5
