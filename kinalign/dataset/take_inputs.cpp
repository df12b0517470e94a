// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/take_inputs.h"

#include "kinalign/core/file_version.h"
#include "kinalign/core/find_named.h"
#include "kinalign/dataset/build.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/input_facts.h"
#include "kinalign/take/remembered_path.h"

#include <filesystem>
#include <limits>
#include <map>
#include <system_error>

namespace kinalign {

namespace fs = std::filesystem;

std::vector<std::string> further_files_of(FileSystem& files, const StreamOptions& options,
                                          const StreamFile& file) {
  auto opened = InputFile::open(files, file.path);
  if (!opened) return {};
  const auto head = opened->next();
  if (!head) return {};
  // If no reader is found, or if the reader refuses the file, there are no further files.
  const auto format = find_format(files, options, file, *head);
  return format ? format->further_files : std::vector<std::string>{};
}

namespace {

/// Adds an input only once, because several streams may read the same file.
void add_input(const TakeInput& input, std::vector<TakeInput>& out) {
  if (find_named(out, input.name) == nullptr) out.push_back(input);
}

using Names = std::map<std::string, std::string>;  // by path as in the manifest

/// Adds the further files that the stream's reader opens.
void add_further(FileSystem& files, StreamOptions stream, const std::string& base,
                 const Names& names, std::vector<TakeInput>& out) {
  if (stream.own_layout()) stream.layout = path_in(base, stream.layout);
  for (const StreamFile& file : stream.files) {
    const StreamFile placed{path_in(base, file.path), file.node};
    for (const std::string& one : further_files_of(files, stream, placed)) {
      // The layout is already in the list.
      if (one == stream.layout) continue;
      add_input({remembered_sibling(names.at(file.path), placed.path, one), one}, out);
    }
  }
}

/// The files that a manifest names. If these are fewer than `expected`, the further files of their
/// readers are added.
std::vector<TakeInput> named_inputs(FileSystem& files, Manifest& manifest, const std::string& base,
                                    std::size_t expected) {
  std::vector<std::string> paths;
  for (const std::string* path : paths_in(manifest)) paths.push_back(*path);
  const Names names = remembered_paths(paths);
  std::vector<TakeInput> out;
  for (const std::string& path : paths) add_input({names.at(path), path_in(base, path)}, out);
  // Every file must be opened to find its further files. This is slow, so it is done only if files
  // are missing in the list.
  if (expected <= out.size()) return out;
  for (const StreamOptions& stream : manifest.streams) {
    add_further(files, stream, base, names, out);
  }
  return out;
}

}  // namespace

std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base) {
  return named_inputs(files, manifest, base, std::numeric_limits<std::size_t>::max());
}

std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base,
                                 const std::vector<InputFacts>& known) {
  std::vector<TakeInput> out = named_inputs(files, manifest, base, known.size());
  // Files that only the take names are beside its first input.
  const std::string default_folder(out.empty() ? base : kinalign::folder(out.front().path));
  for (const InputFacts& input : known) {
    add_input({input.name, default_folder + std::string(file_name(input.name))}, out);
  }
  return out;
}

Result<bool> same_inputs(FileSystem& files, const std::vector<TakeInput>& inputs,
                         const TakeSummary& summary, std::int64_t made_ns,
                         const Progress& progress) {
  // With more or fewer files another take would be made.
  if (inputs.size() != summary.inputs.size()) return false;
  for (const TakeInput& input : inputs) {
    const InputFacts* const known = find_named(summary.inputs, input.name);
    const auto version = version_of(input.path);
    if (known == nullptr || !version || version->size != known->bytes) return false;
    // A file that is older than the summary and has the same length counts as unchanged.
    if (version->changed_ns < made_ns) continue;
    if (KA_TRY(facts_of(files, input.path, "hashing", progress)).sha256 != known->sha256)
      return false;
  }
  return true;
}

std::optional<std::string> place_in_sourcedata(const std::string& folder, const std::string& path) {
  std::error_code fault;
  const fs::path root = fs::canonical(folder, fault);
  if (fault) return std::nullopt;
  const fs::path whole = fs::absolute(path, fault);
  // Only links in the path above the file are followed, because the file itself may be a link that
  // is to be removed.
  const fs::path above = fs::canonical(whole.parent_path(), fault);
  if (fault) return std::nullopt;
  // The file's own name is kept, so a link stays a link.
  std::string place = (above / whole.filename()).lexically_relative(root).string();
  if (!place.starts_with(std::string(raw_files_folder) + "/")) return std::nullopt;
  return place;
}

bool is_unpacked(const std::string& place) {
  // This is the form of the folder names of filled_folder() (import/new_folder.cpp).
  constexpr std::size_t hash_digits = 8;
  const std::size_t begin = raw_files_folder.size() + 1, end = place.find('/', begin);
  if (end == std::string::npos || end - begin < hash_digits + 2) return false;
  const std::size_t dash = end - hash_digits - 1;
  return place[dash] == '-' && is_label(place.substr(begin, dash - begin)) &&
         place.find_first_not_of("0123456789abcdef", dash + 1) == end;
}

Result<std::vector<TakeInput>> raw_files_of(FileSystem& files, const std::string& folder,
                                            const TakeName& name) {
  std::error_code fault;
  if (!fs::exists(path_of(folder, name, TakeFile::manifest), fault)) {
    return std::vector<TakeInput>{};
  }
  // The defaults in dataset.toml have no influence on the files that a manifest names.
  const Manifest manifest = KA_TRY(take_manifest(files, folder, Catalogue{}, name));
  const std::string base = folder_of(folder, name);
  const auto summary = read_summary(files, folder, name);
  // The summary of a built take lists its further files. Without a summary the readers are asked.
  return summary ? inputs_of(files, manifest, base, summary->inputs)
                 : inputs_of(files, manifest, base);
}

Result<std::vector<std::string>> files_in_sourcedata(const std::string& folder) {
  const std::string top = folder + "/" + std::string(raw_files_folder);
  std::vector<std::string> out;
  std::error_code fault;
  // If the folder is a link, its files are not in the data set.
  if (!fs::is_directory(fs::symlink_status(top, fault))) return out;
  // The loop is written by hand, because a range-based `for` throws at a folder that can't be read.
  fs::recursive_directory_iterator entry(top, fault);
  while (!fault && entry != fs::recursive_directory_iterator{}) {
    if (!fs::is_directory(entry->symlink_status(fault))) {
      out.push_back(entry->path().lexically_relative(folder).string());
    }
    entry.increment(fault);
  }
  if (fault) return Failure(Error{top, 0, "folders that can be read", fault.message()});
  return out;
}

}  // namespace kinalign
