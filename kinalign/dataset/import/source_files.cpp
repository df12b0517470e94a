// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/source_files.h"

#include "kinalign/dataset/import/new_folder.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view mac_folder = "__MACOSX";

Failure unreadable_folder(const std::string& path, const std::error_code& fault) {
  return Failure(Error{path, 0, "a folder that can be read", fault.message()});
}

/// Lists the files in a folder. Links to folders are not followed, because they may form a circle.
Result<void> list_folder(const fs::path& top, std::vector<SourceFile>& out) {
  std::error_code fault;
  fs::recursive_directory_iterator at(top, fault);
  for (; !fault && at != fs::recursive_directory_iterator(); at.increment(fault)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with('.') || name == mac_folder) {
      // Hidden folders are not entered.
      at.disable_recursion_pending();
      continue;
    }
    std::error_code gone;
    // A file that disappears meanwhile is skipped.
    if (!at->is_regular_file(gone)) continue;
    out.push_back({at->path().string(), at->path().lexically_relative(top).generic_string()});
  }
  if (fault) return unreadable_folder(top.string(), fault);
  return {};
}

/// True for an archive, which is recognised by its first bytes. A gzip must also have the ending of
/// a packed tar.
Result<bool> is_archive(FileSystem& files, const std::string& path) {
  // An NPZ is a ZIP, too, but importers read it as a whole.
  if (has_ending(path, ".npz")) return false;
  const InputFile file = KA_TRY(InputFile::open(files, path, 1));
  std::array<char, 512> head{};
  return looks_like_archive({head.data(), KA_TRY(file.read_at(0, head))}, path);
}

/// Unpacks an archive into a separate folder and returns the folder.
Result<std::string> unpack(FileSystem& files, const std::string& path,
                           const std::string& raw_folder, const Progress& progress) {
  // Files are unpacked one by one, block by block, so a large archive needs little memory.
  const ArchiveBytes bytes = KA_TRY(archive_bytes(files, path));
  return unpacked_folder(files, raw_folder, path, [&](const PutFile& put) {
    std::uint64_t done = 0;
    return read_archive(bytes, ArchiveLimits{},
                        [&](const std::string& name, const ArchivePieces& next) -> Result<void> {
                          OutputFile out = KA_TRY(put(name));
                          for (;;) {
                            const std::string_view piece = KA_TRY(next());
                            if (piece.empty()) return out.commit();
                            done += piece.size();
                            if (!go_on(progress, "unpacking", done, 0))
                              return Failure(interruption(path));
                            KA_TRY(out.write(piece));
                          }
                        });
  });
}

}  // namespace

Result<ArchiveBytes> archive_bytes(FileSystem& files, const std::string& path) {
  // The reader of the archive reads at any place of the file, so the file stays open.
  const auto file = std::make_shared<InputFile>(KA_TRY(InputFile::open(files, path, 1)));
  return ArchiveBytes{path, file->size(), [file](std::uint64_t at, std::span<char> to) {
                        return file->read_at(at, to);
                      }};
}

Result<std::vector<SourceFile>> list_sources(FileSystem& files,
                                             const std::vector<std::string>& sources,
                                             const std::string& raw_folder,
                                             const Progress& progress) {
  std::vector<SourceFile> out;
  for (const std::string& source : sources) {
    std::error_code ignored;  // opening the file reports the fault
    if (fs::is_directory(source, ignored)) {
      KA_TRY(list_folder(source, out));
    } else if (KA_TRY(is_archive(files, source))) {
      KA_TRY(list_folder(KA_TRY(unpack(files, source, raw_folder, progress)), out));
    } else {
      // A single file has no folder in its name.
      out.push_back({source, std::string(file_name(source))});
    }
  }
  std::sort(out.begin(), out.end(), [](const SourceFile& a, const SourceFile& b) {
    // Sources may have files with the same name; then the paths decide the order.
    return a.name != b.name ? a.name < b.name : a.path < b.path;
  });
  return out;
}

std::string_view stem_of(std::string_view name) {
  name = file_name(name);
  return name.substr(0, name.rfind('.'));
}

bool has_ending(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  return std::equal(ending.begin(), ending.end(),
                    name.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b + 32 : b); });
}

}  // namespace kinalign
