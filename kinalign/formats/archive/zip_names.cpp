// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/archive/zip_names.h"

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

// Signatures and sizes of the end record and of an entry (APPNOTE 4.3.12 and 4.3.16).
constexpr std::string_view end_mark{"PK\5\6", 4}, entry_mark{"PK\1\2", 4};
constexpr std::size_t end_size = 22, entry_size = 46, longest_comment = 65535;

std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// At the end of the file the result is shorter than `size`.
Result<std::string> part(const ArchiveBytes& bytes, std::uint64_t at, std::uint64_t size) {
  std::string out(size, '\0');
  out.resize(KA_TRY(bytes.read_at(at, out)));
  return out;
}

struct Place {
  std::uint64_t at = 0, size = 0;
};

/// Finds the central directory. It ends where the end record begins, and that record states its
/// size. Absent for ZIP64, which has more records between the two.
Result<std::optional<Place>> find_list(const ArchiveBytes& bytes) {
  // A comment of up to 65,535 bytes may follow the end record.
  const std::uint64_t tail = std::min<std::uint64_t>(bytes.size, end_size + longest_comment);
  const std::string text = KA_TRY(part(bytes, bytes.size - tail, tail));
  // The last match, because the mark may also stand in a file's contents.
  const auto at = text.rfind(end_mark);
  if (at == std::string::npos || text.size() - at < end_size) return std::nullopt;
  const std::uint64_t size = number(text, at + 12, 4);
  const std::uint64_t end = bytes.size - tail + at;
  // Such a size says that the real one is in the ZIP64 records.
  constexpr std::uint64_t in_zip64 = 0xFFFFFFFF;
  if (size == in_zip64 || size > end) return std::nullopt;
  return Place{end - size, size};
}

}  // namespace

Result<void> check_zip_names(const ArchiveBytes& bytes) {
  const auto list = KA_TRY(find_list(bytes));
  if (!list) return {};
  std::uint64_t at = list->at;
  const std::uint64_t end = list->at + list->size;
  while (at + entry_size <= end) {
    const std::string head = KA_TRY(part(bytes, at, entry_size));
    // The directory is not where it was expected; libarchive will decide.
    if (!head.starts_with(entry_mark) || head.size() < entry_size) return {};
    const std::uint64_t name_size = number(head, 28, 2);
    const std::string name = KA_TRY(part(bytes, at + entry_size, name_size));
    if (name.find('\0') != std::string::npos) {
      return Failure(Error{bytes.name, 0, "names without a NUL in the archive", shown(name)});
    }
    // Name, extra field and comment follow the entry's fixed part.
    at += entry_size + name_size + number(head, 30, 2) + number(head, 32, 2);
  }
  return {};
}

}  // namespace kinalign
