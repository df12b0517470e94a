// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/new_folder.h"

#include "kinalign/core/numbers.h"
#include "kinalign/dataset/import/ids.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/sources/input_facts.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

/// Removes folders `parent`/LEAD-PID of import processes that have ended.
void remove_abandoned(const std::string& parent, const std::string& lead) {
  for (const std::string& name : names_in_folder(parent).value_or(std::vector<std::string>{})) {
    if (!name.starts_with(lead)) continue;
    pid_t process = 0;
    const std::string_view number = std::string_view(name).substr(lead.size());
    if (!parse_integer(number, process) || process <= 0) continue;
    // A process that exists but can't be signalled is still running. A folder with the id of this
    // process remains from an earlier process.
    const bool runs = process != ::getpid() && (::kill(process, 0) == 0 || errno != ESRCH);
    std::error_code ignored;
    if (!runs) fs::remove_all(fs::path(parent) / name, ignored);
  }
}

/// Moves files from one folder to another that lacks them.
Result<void> fill_in(const fs::path& from, const fs::path& to) {
  std::error_code fault;
  fs::recursive_directory_iterator at(from, fault);
  for (; !fault && at != fs::recursive_directory_iterator(); at.increment(fault)) {
    const fs::path target = to / at->path().lexically_relative(from);
    // A file that exists is kept, because a take may have been made from it.
    if (at->is_directory(fault) || is_there(target.string())) continue;
    KA_TRY(make_folders(target.parent_path().string()));
    fs::rename(at->path(), target, fault);
    if (fault) break;
  }
  if (!fault) return {};
  return Failure(Error{to.string(), 0, "a folder that can be filled", fault.message()});
}

}  // namespace

Result<std::string> unpacked_folder(FileSystem& files, const std::string& parent,
                                    const std::string& source, const FillFolder& fill) {
  const InputFacts facts = KA_TRY(facts_of(files, source, "hashing", {}));
  const std::string name(file_name(source));
  return filled_folder(files, parent, label_of(name.substr(0, name.find('.'))), facts.sha256, fill);
}

Result<std::string> filled_folder(FileSystem& files, const std::string& parent,
                                  const std::string& stem, const std::string& sha256,
                                  const FillFolder& fill) {
  // Eight digits of the hash distinguish sources; is_unpacked() recognises this form.
  const std::string own = stem + "-" + sha256.substr(0, 8);
  const fs::path to = fs::path(parent) / own;
  // The hidden name contains the process id, because another process may unpack the same source.
  const std::string lead = "." + own + "-";
  // An import process that was killed could not remove its folder, so it is removed here.
  remove_abandoned(parent, lead);
  const fs::path sibling = fs::path(parent) / (lead + std::to_string(::getpid()));
  UnfinishedFolder unfinished(sibling.string());
  KA_TRY(make_folders(sibling.string()));
  // The files are made in the folder with the hidden name, where no take looks for them.
  KA_TRY(fill([&](const std::string& file) -> Result<OutputFile> {
    const fs::path path = sibling / file;
    KA_TRY(make_folders(path.parent_path().string()));
    return OutputFile::create(files, path.string(), Overwrite::no);
  }));
  std::error_code fault;
  fs::rename(sibling, to, fault);
  // After the rename, the folder with the hidden name does not exist, so nothing has to be removed.
  if (!fault) unfinished.keep();
  // If the folder exists from an earlier import, only its missing files are added.
  if (fault && is_there(to.string())) {
    KA_TRY(fill_in(sibling, to));
  } else if (fault) {
    return Failure(Error{to.string(), 0, "a folder that can be named", fault.message()});
  }
  return to.string();
}

}  // namespace kinalign
