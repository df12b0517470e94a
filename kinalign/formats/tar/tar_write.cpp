// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/tar/tar_write.h"

#include <fmt/format.h>

#include <numeric>

namespace kinalign {

namespace {

constexpr std::size_t block = 512;
constexpr std::size_t longest_in_header = 100, longest_name = 1000;
constexpr std::uint64_t largest_in_header = (std::uint64_t{1} << 33) - 1;  // 11 octal digits

/// Writes a number as digits - 1 octal digits, for example "0000644". The zero byte after them is
/// already in the header.
void put_octal(std::string& header, std::size_t at, std::size_t digits, std::uint64_t value) {
  header.replace(at, digits - 1, fmt::format("{:0{}o}", value, digits - 1));
}

/// The header block of a member. The checksum is computed with blanks in the checksum's own field.
std::string header_of(std::string_view name, std::uint64_t size, char kind) {
  std::string out(block, '\0');
  out.replace(0, name.size(), name);
  put_octal(out, 100, 8, 0644);
  put_octal(out, 108, 8, 0);  // the user's id
  put_octal(out, 116, 8, 0);  // the group's id
  put_octal(out, 124, 12, size);
  put_octal(out, 136, 12, 0);  // the time of the last change
  // The format requires blanks here while the checksum is computed.
  out.replace(148, 8, "        ");
  out[156] = kind;
  out.replace(257, 8, std::string_view("ustar\00000", 8));
  put_octal(out, 329, 8, 0);  // the device's number
  put_octal(out, 337, 8, 0);
  const auto sum = std::accumulate(out.begin(), out.end(), 0U, [](unsigned total, char c) {
    return total + static_cast<unsigned char>(c);
  });
  put_octal(out, 148, 7, sum);
  out[154] = '\0';
  return out;
}

/// A record such as "20 size=8589934592\n". It begins with its own length, which includes the
/// digits of the length.
std::string pax_record(std::string_view key, std::string_view value) {
  const std::string rest = fmt::format(" {}={}\n", key, value);
  // The length depends on the number of its own digits. The first length that fits is correct.
  std::size_t length = rest.size() + 1;
  while (std::to_string(length).size() + rest.size() != length) ++length;
  return std::to_string(length) + rest;
}

// True for an absolute name. Also true if the name contains a part "..", which could lead out of
// the folder.
bool leads_out(std::string_view name) {
  return name.starts_with('/') || ("/" + std::string(name) + "/").find("/../") != std::string::npos;
}

std::string padding(std::uint64_t size) {
  return std::string((block - size % block) % block, '\0');
}

}  // namespace

Result<void> TarWriter::put(std::string_view bytes) {
  return bytes.empty() ? Result<void>{} : sink_(bytes);
}

Result<void> TarWriter::add(std::string_view name, std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  const bool has_zero = name.find('\0') != std::string_view::npos;
  if (name.empty() || name.size() > longest_name || has_zero || leads_out(name)) {
    return refuse("a relative name of 1 to 1000 bytes in a tar", "'" + shown(name) + "'");
  }
  // The fields of the header are too short. A pax header in front of the member contains the true
  // values.
  std::string records;
  if (name.size() > longest_in_header) records += pax_record("path", name);
  if (size > largest_in_header) records += pax_record("size", std::to_string(size));
  if (!records.empty()) {
    KA_TRY(put(header_of("PaxHeader", records.size(), 'x') + records + padding(records.size())));
  }
  // Programs that can't read pax headers then read an empty member and not a wrong size.
  const bool too_large = size > largest_in_header;
  KA_TRY(put(header_of(name.substr(0, longest_in_header), too_large ? 0 : size, '0')));
  KA_TRY(put(bytes));
  // A member begins at a block, so its last block is filled with zeros.
  return put(padding(size));
}

Result<void> TarWriter::finish() { return put(std::string(2 * block, '\0')); }

}  // namespace kinalign
