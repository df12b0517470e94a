// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/raw_files.h"

#include "kinalign/dataset/build.h"
#include "kinalign/dataset/scan.h"

#include <filesystem>
#include <system_error>

namespace kinalign {

namespace fs = std::filesystem;

std::optional<std::string> place_in_sourcedata(const std::string& folder, const std::string& path) {
  std::error_code fault;
  const fs::path root = fs::canonical(folder, fault);
  if (fault) return std::nullopt;
  const fs::path whole = fs::absolute(path, fault);
  const fs::path above = fs::canonical(whole.parent_path(), fault);
  if (fault) return std::nullopt;
  std::string place = (above / whole.filename()).lexically_relative(root).string();
  if (!place.starts_with(std::string(raw_files_folder) + "/")) return std::nullopt;
  return place;
}

Result<std::vector<TakeInput>> raw_files_of(FileSystem& files, const std::string& folder,
                                            const TakeName& name) {
  std::error_code fault;
  if (!fs::exists(folder + "/" + path_of(name, TakeFile::manifest), fault)) {
    return std::vector<TakeInput>{};
  }
  const Manifest manifest = KA_TRY(take_manifest(files, folder, Catalogue{}, name));
  const std::string base = folder + "/sub-" + name.subject + "/";
  const auto summary = read_summary(files, folder, name);
  return summary ? inputs_of(files, manifest, base, summary->inputs)
                 : inputs_of(files, manifest, base);
}

Result<std::vector<std::string>> files_in_sourcedata(const std::string& folder) {
  const std::string top = folder + "/" + std::string(raw_files_folder);
  std::vector<std::string> out;
  std::error_code fault;
  if (!fs::is_directory(fs::symlink_status(top, fault))) return out;
  // Filled by hand: a loop with `for` would throw where a folder below can't be read.
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
