// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/unknown_file.h"

#include "kinalign/core/utf8.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> marks{
    {{"\x1f\x8b"sv, "a gzip archive: unpack it first"},
     {"PK\x03\x04"sv, "a ZIP archive, such as .npz"},
     {hdf5_signature, "an HDF5 file"},
     {"\x89PNG"sv, "a picture"},
     {"%PDF"sv, "a PDF"},
     {"<?xml"sv, "XML"}}};

bool is_text(std::string_view line) {
  return std::all_of(line.begin(), line.end(),
                     [](char c) { return c == '\t' || c == '\r' || (c >= ' ' && c < '\x7f'); });
}

}  // namespace

bool looks_like_hdf5(std::string_view head) { return head.starts_with(hdf5_signature); }

bool looks_like_model(std::string_view head) {
  // A SafeTensors file begins with the header's length, a little-endian 64-bit number of at most 16
  // MB. Bytes 4 to 7 are therefore 0, and byte 3 is 0 or 1.
  if (head.size() < 10 || head.substr(8, 2) != "{\"") return false;
  return (head[3] == 0 || head[3] == 1) && head.substr(4, 4) == "\0\0\0\0"sv;
}

std::string beginning_of(std::string_view head) {
  if (head.empty()) return "an empty file";
  if (looks_like_model(head)) return "a model (SafeTensors)";
  for (const auto& [mark, name] : marks) {
    if (head.starts_with(mark)) return std::string(name);
  }
  head = without_byte_order_mark(head);
  const std::string_view line = head.substr(0, head.find('\n'));
  // Only the beginning is examined, because the line may be long.
  return is_text(line.substr(0, 200)) ? "'" + shown(line) + "'" : "bytes that are no plain text";
}

Error unknown_file(const std::string& path, std::string_view head) {
  if (looks_like_model(head)) {
    return {path, 0, "a file of motion",
            "a model (SafeTensors): kinalign info shows what is in it"};
  }
  const bool empty = head.empty();
  return {path, empty ? 0 : 1,
          empty
              ? "a recording's file"
              : "a format that kinalign knows (docs/formats); for a table of another kind write a "
                "layout (docs/formats/layouts.md: layout = in a manifest, --layout with one file)",
          beginning_of(head)};
}

}  // namespace kinalign
