// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/archive/archive.h"

#include "kinalign/core/utf8.h"
#include "kinalign/wire/little_endian_reader.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <locale.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace kinalign {

namespace {

// On Linux the name of a file has at most 255 bytes.
constexpr std::size_t longest_name = 1000, longest_part = 255;
// The limit on the ratio does not apply to the first 64 MiB, because a short archive may contain a
// long table of equal numbers.
constexpr std::uint64_t not_judged = std::uint64_t{64} << 20;

/// The state of libarchive's read callbacks. A callback can only return -1 for a failure, so the
/// error is kept here. `bytes` belongs to the caller of read_archive().
struct Feed {
  const ArchiveBytes& bytes;
  std::uint64_t at = 0;
  std::vector<char> buffer = std::vector<char>(std::size_t{256} << 10);
  std::optional<Error> failure{};
};

la_ssize_t read_more(archive*, void* data, const void** out) {
  Feed& feed = *static_cast<Feed*>(data);
  const auto got = feed.bytes.read_at(feed.at, feed.buffer);
  if (!got) {
    // libarchive only gets -1. damage() returns the error that was kept.
    feed.failure = got.error();
    return -1;
  }
  feed.at += *got;
  *out = feed.buffer.data();
  return static_cast<la_ssize_t>(*got);
}

/// libarchive's callback for seeking. Moves to `offset` from the start, from the current position
/// or from the end. Positions outside of the archive are refused.
la_int64_t seek_to(archive*, void* data, la_int64_t offset, int whence) {
  Feed& feed = *static_cast<Feed*>(data);
  const auto size = static_cast<la_int64_t>(feed.bytes.size);
  const la_int64_t from = whence == SEEK_SET   ? 0
                          : whence == SEEK_CUR ? static_cast<la_int64_t>(feed.at)
                                               : size;
  // The comparison avoids sums that could overflow.
  if (offset < -from || offset > size - from) return ARCHIVE_FATAL;
  feed.at = static_cast<std::uint64_t>(from + offset);
  return static_cast<la_int64_t>(feed.at);
}

/// Sets the locale of this thread to UTF-8 while the object exists. libarchive drops names with
/// characters that the locale does not have.
class NamesInUtf8 {
 public:
  // Only the thread's locale is set, because setlocale() would change the locale of the whole
  // program.
  NamesInUtf8() : own_(newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
    if (own_ != nullptr) before_ = uselocale(own_);
  }
  NamesInUtf8(const NamesInUtf8&) = delete;
  NamesInUtf8& operator=(const NamesInUtf8&) = delete;
  ~NamesInUtf8() {
    if (own_ == nullptr) return;
    uselocale(before_);
    freelocale(own_);
  }

 private:
  locale_t own_, before_ = nullptr;
};

struct Free {
  void operator()(archive* one) const { archive_read_free(one); }
};
using Owned = std::unique_ptr<archive, Free>;

/// The names of files so far, and the folders that contain these files. A disk can't have a file
/// and a folder with the same name, so one of them would be lost.
class GivenNames {
 public:
  /// Adds the name of a file. Returns false if the name exists already, or if a file has the name
  /// of a folder.
  bool add(const std::string& name) {
    if (folders_.contains(name) || !files_.insert(name).second) return false;
    for (auto slash = name.find('/'); slash != std::string::npos;
         slash = name.find('/', slash + 1)) {
      std::string folder = name.substr(0, slash);
      if (files_.contains(folder)) return false;
      folders_.insert(std::move(folder));
    }
    return true;
  }

 private:
  std::set<std::string> files_, folders_;
};

/// Reads an archive. It does not use libarchive's functions that write to the disk. Therefore
/// nothing is written that this class has not checked.
class ArchiveReader {
 public:
  ArchiveReader(const ArchiveBytes& bytes, const ArchiveLimits& limits)
      : feed_{bytes}, limits_(limits), archive_(archive_read_new()) {}

  /// Reads all entries. Checks name and kind of each entry before `use` is called.
  Result<void> read(const UseArchiveFile& use) {
    KA_TRY(open());
    std::uint64_t entries = 0;
    for (;;) {
      archive_entry* entry = nullptr;
      const int status = archive_read_next_header(archive_.get(), &entry);
      if (status == ARCHIVE_EOF) return {};
      // ARCHIVE_WARN: libarchive did not understand a detail, but the entry can be read.
      if (status != ARCHIVE_OK && status != ARCHIVE_WARN) return Failure(damage("an entry"));
      if (++entries > limits_.entries) {
        return refuse(fmt::format("at most {} entries", limits_.entries), "more");
      }
      const std::string stated_name = name_of(entry);
      // The kind is checked first, because a link with a good name may lead anywhere.
      KA_TRY(check_kind(entry, stated_name));
      auto safe = safe_archive_name(stated_name);
      // The entry "./" is no file name, but a tar file often begins with it.
      if (!safe && archive_entry_filetype(entry) == AE_IFDIR && is_top(stated_name)) continue;
      if (!safe) return refuse(safe.error().expected, shown(stated_name));
      if (archive_entry_filetype(entry) == AE_IFDIR) continue;
      if (!given_.add(*safe)) return refuse("each name once", shown(stated_name) + " again");
      // The pieces belong to the current entry. They end when the next header is read.
      KA_TRY(use(*safe, [this, stated_name] { return next_piece(stated_name); }));
    }
  }

 private:
  Result<void> open() {
    archive* const a = archive_.get();
    // Only these formats are enabled, because each further format of libarchive is a risk.
    archive_read_support_format_zip_seekable(a);
    archive_read_support_format_tar(a);
    archive_read_support_filter_gzip(a);
    archive_read_set_read_callback(a, read_more);
    archive_read_set_seek_callback(a, seek_to);
    archive_read_set_callback_data(a, &feed_);
    if (archive_read_open1(a) == ARCHIVE_OK) return {};
    return Failure(damage("a ZIP, a tar or a tar.gz"));
  }

  Failure refuse(std::string expected, std::string found) const {
    return kinalign::refuse(feed_.bytes.name, std::move(expected) + " in the archive",
                            std::move(found));
  }

  Error damage(const std::string& expected) const {
    if (feed_.failure) return *feed_.failure;
    const char* const reason = archive_error_string(archive_.get());
    return Error{feed_.bytes.name, 0, expected + " that can be read",
                 reason == nullptr ? "damaged bytes" : shown(reason)};
  }

  /// True for an entry that stands for the archive's top folder, such as "./". ".." must be
  /// excluded, because it also consists of dots only.
  static bool is_top(std::string_view name) {
    return name.find_first_not_of("./") == std::string_view::npos && name.find("..") == name.npos &&
           !name.starts_with('/');
  }

  static std::string name_of(archive_entry* entry) {
    // Names in a ZIP file may be Latin-1.
    const char* name = archive_entry_pathname_utf8(entry);
    if (name == nullptr) name = archive_entry_pathname(entry);
    return name == nullptr ? "" : as_utf8(name);
  }

  /// Refuses links, devices and encrypted files. Links could lead out of the target folder.
  Result<void> check_kind(archive_entry* entry, const std::string& name) const {
    const auto type = archive_entry_filetype(entry);
    // In a tar file a hard link has the type of a regular file.
    const bool is_link = type == AE_IFLNK || archive_entry_hardlink(entry) != nullptr ||
                         archive_entry_symlink(entry) != nullptr;
    if (is_link) return refuse("only files and folders", "a link, " + shown(name));
    if (type != AE_IFREG && type != AE_IFDIR) {
      return refuse("only files and folders", "a device, " + shown(name));
    }
    if (archive_entry_is_encrypted(entry) > 0) {
      return refuse("files without a password", shown(name));
    }
    return {};
  }

  /// The next bytes of the current file. The bytes are counted here, because the sizes in an
  /// archive may be wrong.
  Result<std::string_view> next_piece(const std::string& name) {
    const la_ssize_t got = archive_read_data(archive_.get(), piece_.data(), piece_.size());
    if (got < 0) {
      Error error = damage(shown(name));
      return Failure(std::move(error));
    }
    bytes_ += static_cast<std::uint64_t>(got);
    if (bytes_ > limits_.bytes) {
      return refuse(fmt::format("at most {} bytes in all files", limits_.bytes),
                    "more files, up to " + shown(name));
    }
    // A division is used, because the product of size and ratio could overflow.
    if (bytes_ > not_judged && (bytes_ - not_judged) / limits_.ratio > feed_.bytes.size) {
      return refuse(fmt::format("files at most {} times the archive's size", limits_.ratio),
                    "larger files, in " + shown(name));
    }
    return std::string_view(piece_.data(), static_cast<std::size_t>(got));
  }

  // libarchive keeps the address of feed_, so feed_ must not be moved.
  Feed feed_;
  const ArchiveLimits& limits_;
  Owned archive_;
  GivenNames given_;
  std::uint64_t bytes_ = 0;
  std::vector<char> piece_ = std::vector<char>(std::size_t{256} << 10);
};

// Marks and sizes of the end record and of an entry of the directory (APPNOTE 4.3.12 and 4.3.16).
constexpr std::string_view end_mark{"PK\5\6", 4}, entry_mark{"PK\1\2", 4};
constexpr std::size_t end_size = 22, entry_size = 46, longest_comment = 65535;

/// Reads a part of the archive. At the end of the archive the result is shorter than `size`.
Result<std::string> part(const ArchiveBytes& bytes, std::uint64_t at, std::uint64_t size) {
  std::string out(size, '\0');
  out.resize(KA_TRY(bytes.read_at(at, out)));
  return out;
}

struct Place {
  std::uint64_t at = 0, size = 0;
};

/// Finds the central directory of a ZIP file. It ends where the end record begins, and the end
/// record states its size. The result is empty for ZIP64, which has further records in between.
Result<std::optional<Place>> find_list(const ArchiveBytes& bytes) {
  // A comment of up to 65,535 bytes may follow the end record.
  const std::uint64_t tail = std::min<std::uint64_t>(bytes.size, end_size + longest_comment);
  const std::string text = KA_TRY(part(bytes, bytes.size - tail, tail));
  // The last match is used, because the mark may also occur in a file's contents.
  const auto at = text.rfind(end_mark);
  if (at == std::string::npos || text.size() - at < end_size) return std::nullopt;
  const std::uint64_t size = little_at<std::uint32_t>(octets(text), at + 12);
  const std::uint64_t end = bytes.size - tail + at;
  // This size means that the real size is in the ZIP64 records.
  constexpr std::uint64_t in_zip64 = 0xFFFFFFFF;
  if (size == in_zip64 || size > end) return std::nullopt;
  return Place{end - size, size};
}

/// Checks the names in the central directory of a ZIP file (APPNOTE 6.3.10, 4.3.12). libarchive
/// cuts a name at a NUL character, but other programs may use the whole name. If the directory
/// can't be found, the check passes, and libarchive reports the fault when it reads.
Result<void> check_zip_names(const ArchiveBytes& bytes) {
  const auto list = KA_TRY(find_list(bytes));
  if (!list) return {};
  std::uint64_t at = list->at;
  const std::uint64_t end = list->at + list->size;
  while (at + entry_size <= end) {
    const std::string head = KA_TRY(part(bytes, at, entry_size));
    // If the directory is not here, libarchive decides about the file.
    if (!head.starts_with(entry_mark) || head.size() < entry_size) return {};
    const std::uint64_t name_size = little_at<std::uint16_t>(octets(head), 28);
    const std::string name = KA_TRY(part(bytes, at + entry_size, name_size));
    if (name.find('\0') != std::string::npos) {
      return refuse(bytes.name, "names without a NUL in the archive", shown(name));
    }
    // Name, extra field and comment follow the fixed part of the entry.
    at += entry_size + name_size + little_at<std::uint16_t>(octets(head), 30) +
          little_at<std::uint16_t>(octets(head), 32);
  }
  return {};
}

// True for characters that could change a terminal when the name is printed.
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

Result<std::string> safe_archive_name(std::string_view name) {
  const auto refuse = [whole = name](std::string expected) {
    return kinalign::refuse(std::move(expected), shown(whole));
  };
  if (name.empty()) return refuse("names");
  if (name.size() > longest_name)
    return refuse(fmt::format("names of at most {} bytes", longest_name));
  // "C:name" is an absolute name on Windows.
  if (name.starts_with('/') || (name.size() > 1 && name[1] == ':')) return refuse("relative names");
  if (name.find('\\') != name.npos) return refuse("names without a backslash");
  if (std::any_of(name.begin(), name.end(), is_control)) {
    return refuse("names without control characters");
  }
  std::string out;
  while (!name.empty()) {
    // Each part of the path is checked. Empty parts and "." are removed.
    const std::string_view part = name.substr(0, name.find('/'));
    name.remove_prefix(std::min(name.size(), part.size() + 1));
    if (part.empty() || part == ".") continue;
    if (part == "..") return refuse("names without ..");
    if (part.size() > longest_part) {
      return refuse(fmt::format("folders and files of at most {} bytes", longest_part));
    }
    out += (out.empty() ? "" : "/") + std::string(part);
  }
  // For "./" and ".", no part is left.
  if (out.empty()) return refuse("names");
  return out;
}

bool looks_like_archive(std::string_view head, std::string_view path) {
  if (head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06")) return true;
  // A tar file has the mark "ustar" at byte 257.
  if (head.size() > 262 && head.substr(257, 5) == "ustar") return true;
  // A gzip file may contain anything, so its name decides.
  return head.starts_with("\x1f\x8b") && (path.ends_with(".tar.gz") || path.ends_with(".tgz"));
}

Result<void> read_archive(const ArchiveBytes& bytes, const ArchiveLimits& limits,
                          const UseArchiveFile& use) {
  // The names are checked before libarchive reads them, because libarchive cuts them at a NUL
  // character.
  KA_TRY(check_zip_names(bytes));
  const NamesInUtf8 locale;
  return ArchiveReader(bytes, limits).read(use);
}

}  // namespace kinalign
