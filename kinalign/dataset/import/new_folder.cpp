// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/new_folder.h"

#include "kinalign/dataset/import/ids.h"
#include "kinalign/sources/input_facts.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

}  // namespace

UnfinishedFolder::UnfinishedFolder(std::string path) : path_(std::move(path)) {
  for (fs::path up = fs::path(path_).parent_path(); !up.empty() && !fs::exists(up);
       up = up.parent_path()) {
    above_.push_back(up.string());
  }
}

UnfinishedFolder::~UnfinishedFolder() {
  if (kept_) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  for (const std::string& one : above_) fs::remove(one, ignored);  // where nothing else is in it
}

Result<std::string> unpacked_folder(FileSystem& files, const std::string& parent,
                                    const std::string& source, const FillFolder& fill) {
  const InputFacts facts = KA_TRY(facts_of(files, source, "hashing", {}));
  const std::string name(file_name(source));
  return filled_folder(files, parent, label_of(name.substr(0, name.find('.'))), facts.sha256, fill);
}

Result<std::string> filled_folder(FileSystem& files, const std::string& parent,
                                  const std::string& stem, const std::string& sha256,
                                  const FillFolder& fill) {
  const std::string own = stem + "-" + sha256.substr(0, 8);
  const fs::path to = fs::path(parent) / own;
  if (fs::is_directory(to)) return to.string();
  // Another process may unpack the same source.
  const fs::path beside = fs::path(parent) / ("." + own + "-" + std::to_string(::getpid()));
  std::error_code fault;
  fs::remove_all(beside, fault);  // of a run that was killed
  UnfinishedFolder unfinished(beside.string());
  KA_TRY(make_folders(beside.string()));
  KA_TRY(fill([&](const std::string& file) -> Result<OutputFile> {
    const fs::path path = beside / file;
    KA_TRY(make_folders(path.parent_path().string()));
    return OutputFile::create(files, path.string(), Overwrite::no);
  }));
  fs::rename(beside, to, fault);
  if (fault && fs::is_directory(to)) return to.string();  // the other one was faster
  if (fault) return Failure(Error{to.string(), 0, "a folder that can be named", fault.message()});
  unfinished.keep();
  return to.string();
}

}  // namespace kinalign
