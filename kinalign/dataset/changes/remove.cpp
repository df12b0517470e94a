// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/remove.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/dataset/changes/toml_text.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/take_inputs.h"
#include "kinalign/take/remembered_path.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

/// Collects the files of the takes to remove, in the order of their removal. This class only reads;
/// remove_takes() removes the files. If a stopped run has removed a part of a take, the take is
/// still found by its manifest or its raw files.
class RemovalPlanner {
 public:
  RemovalPlanner(FileSystem& files, const std::string& folder, bool with_raw,
                 std::map<TakeName, TakeFiles> takes)
      : files_(files), folder_(folder), with_raw_(with_raw), takes_(std::move(takes)) {}

  Result<RemovalPlan> plan(const std::vector<std::string>& words) {
    std::set<TakeName> wanted;
    for (const std::string& word : words) {
      std::set<TakeName> named = takes_named(word);
      if (named.empty()) plan_.unknown.push_back(word);
      wanted.merge(named);
    }
    if (wanted.empty()) return unknown(words.front());
    plan_.takes.assign(wanted.begin(), wanted.end());
    // Other takes need to be checked only if raw files are removed.
    if (with_raw_) KA_TRY(check_others(wanted));
    // Each person's folders are listed once, after all of its takes.
    std::set<std::string> people;
    for (const TakeName& name : plan_.takes) {
      KA_TRY(add_take(name));
      people.insert(name.subject);
    }
    for (const std::string& subject : people) {
      if (with_raw_) plan_.folders.push_back("sourcedata/sub-" + subject);
      // Folders of people come last. If such a folder still has files, it stays.
      plan_.folders.push_back("sub-" + subject);
    }
    // The list is sorted, and a folder's path begins with that of its parent. In reverse order
    // inner folders come first.
    plan_.folders.insert(plan_.folders.end(), folders_above_.rbegin(), folders_above_.rend());
    return std::move(plan_);
  }

 private:
  /// True if the take has copied raw files. If the check fails and raw files are to be removed, it
  /// also returns true: reading the files then reports the fault.
  bool has_raw(const TakeName& name) const {
    std::error_code fault;
    return fs::exists(folder_ + "/" + raw_folder(name), fault) || (with_raw_ && fault);
  }

  // The takes that the user's word names: one take, or all takes of a person.
  std::set<TakeName> takes_named(const std::string& word) const {
    std::set<TakeName> out;
    const auto name = parse_take_name(word);
    if (name && (takes_.contains(*name) || has_raw(*name))) out.insert(*name);
    for (const auto& [take, there] : takes_) {
      if (word == "sub-" + take.subject) out.insert(take);
    }
    if (with_raw_ && word.starts_with("sub-") && is_label(word.substr(4))) {
      out.merge(takes_with_raw(word));  // a stopped run may have left only raw files
    }
    return out;
  }

  Failure unknown(const std::string& word) const {
    std::vector<std::string> known;
    // The error suggests the most similar of these names.
    for (const auto& [take, there] : takes_) known.push_back(to_string(take));
    return Failure(
        unknown_name(word, "a take of " + folder_ + ", or a person such as sub-03", known));
  }

  // The takes of a person that have only copied raw files left.
  std::set<TakeName> takes_with_raw(const std::string& person) const {
    std::set<TakeName> out;
    const std::string folder = folder_ + "/sourcedata/" + person;
    for (const std::string& entry : names_in_folder(folder).value_or(std::vector<std::string>{})) {
      const auto name = parse_take_name(entry);
      if (name && "sub-" + name->subject == person) out.insert(*name);
    }
    return out;
  }

  /// Collects the inputs of the takes that stay. A user may have made another take by hand from the
  /// raw files of a removed one.
  Result<void> check_others(const std::set<TakeName>& wanted) {
    for (const auto& [name, there] : takes_) {
      if (!there.manifest || wanted.contains(name)) continue;
      for (const std::string& place : KA_TRY(raw_places(name))) {
        // An input of a take that stays is never removed.
        needed_.insert(place);
        for (const TakeName& going : wanted) {
          if (!place.starts_with(raw_folder(going))) continue;
          return Failure(Error{path_of(name, TakeFile::manifest), 0,
                               "no raw files of " + to_string(going) + ", which would be removed",
                               raw_folder(going)});
        }
      }
    }
    return {};
  }

  /// The inputs of a take below sourcedata/. If an input is a link, also the file that the link
  /// leads to.
  Result<std::vector<std::string>> raw_places(const TakeName& name) const {
    std::vector<std::string> out;
    for (const TakeInput& input : KA_TRY(raw_files_of(files_, folder_, name))) {
      const auto place = place_in_sourcedata(folder_, input.path);
      // The take that stays needs both the link and its target.
      if (place) out.push_back(*place);
      std::error_code fault;
      if (!fs::is_symlink(input.path, fault)) continue;
      const auto target = place_in_sourcedata(folder_, fs::canonical(input.path, fault).string());
      if (!fault && target) out.push_back(*target);
    }
    return out;
  }

  /// Adds the files of one take. The manifest comes last, so that a stopped removal can be run
  /// again.
  Result<void> add_take(const TakeName& name) {
    // The page of a take is useless without the take.
    add_file("report/" + to_string(name) + ".html");
    if (has_raw(name)) {
      if (with_raw_) {
        KA_TRY(add_raw(name));
      } else {
        plan_.raw_left.push_back(raw_folder(name));
      }
    }
    KA_TRY(add_inputs(name));
    for (const TakeFile file : {TakeFile::take, TakeFile::summary, TakeFile::manifest}) {
      add_file(path_of(name, file));
    }
    return {};
  }

  /// Adds inputs outside the take's own folder of raw files. Files that an import unpacked are
  /// removed; the user's own files stay. Further files of a reader come first, because they are
  /// found through the file that they belong to.
  Result<void> add_inputs(const TakeName& name) {
    auto inputs = raw_files_of(files_, folder_, name);
    if (!inputs && with_raw_) {
      return Failure(Error{
          path_of(name, TakeFile::manifest), 0,
          "a manifest that lists the raw files to remove (without --raw only the take is removed)",
          to_string(inputs.error())});
    }
    if (!inputs) return {};  // the take is removed anyway; `verify` reports raw files that are left
    std::reverse(inputs->begin(), inputs->end());
    for (const TakeInput& input : *inputs) {
      const auto place = place_in_sourcedata(folder_, input.path);
      std::error_code fault;
      const bool is_own = place && place->starts_with(raw_folder(name));
      if (!place || is_own || !fs::exists(fs::symlink_status(input.path, fault))) continue;
      // Several takes may share an input, which is looked at only once.
      if (!seen_.insert(*place).second) continue;
      // Only files that an import unpacked can be made again, so only these are removed.
      if (!is_unpacked(*place)) {
        plan_.raw_kept.push_back(*place);
      } else if (!with_raw_) {
        plan_.raw_left.push_back(*place);
      } else if (needed_.contains(*place)) {
        plan_.raw_shared.push_back(*place);
      } else {
        add_file(*place);
        add_folders_above(*place);
      }
    }
    return {};
  }

  // Notes the folders that may become empty when the file is removed. If one of them is noted
  // already, so are all folders above it.
  void add_folders_above(const std::string& place) {
    for (fs::path above = fs::path(place).parent_path(); !above.empty();
         above = above.parent_path()) {
      if (!folders_above_.insert(above.string()).second) return;
    }
  }

  // Adds a file or a link, if it exists. For a link, the size of the target does not count, because
  // the target stays.
  void add_file(const std::string& path) {
    std::error_code fault;
    const fs::path whole = folder_ + "/" + path;
    const auto kind = fs::symlink_status(whole, fault).type();
    if (kind != fs::file_type::regular && kind != fs::file_type::symlink) return;
    plan_.files.push_back(path);
    if (kind == fs::file_type::regular) plan_.bytes += fs::file_size(whole, fault);
  }

  /// Adds the take's copied raw files. Links are not followed, because they lead to files
  /// elsewhere.
  Result<void> add_raw(const TakeName& name) {
    std::string folder = raw_folder(name);
    folder.pop_back();
    std::error_code fault;
    for (const std::string& part :
         {std::string("sourcedata"), "sourcedata/sub-" + name.subject, folder}) {
      if (!fs::is_symlink(folder_ + "/" + part, fault)) continue;
      return Failure(Error{folder_ + "/" + part, 0,
                           "raw files within the data set; other raw files are not removed",
                           "a link to another place"});
    }
    std::vector<std::string> inner;
    fs::recursive_directory_iterator entry(folder_ + "/" + folder, fault);
    for (; !fault && entry != fs::recursive_directory_iterator(); entry.increment(fault)) {
      const std::string path = entry->path().lexically_relative(folder_).string();
      if (fs::is_directory(entry->symlink_status(fault))) {
        inner.push_back(path);
      } else {
        add_file(path);
      }
    }
    if (fault)
      return Failure(
          Error{folder_ + "/" + folder, 0, "a folder that can be read", fault.message()});
    // Folders were listed from the outside in, so they are removed in reverse order.
    plan_.folders.insert(plan_.folders.end(), inner.rbegin(), inner.rend());
    plan_.folders.push_back(folder);
    return {};
  }

  FileSystem& files_;
  const std::string& folder_;
  bool with_raw_;
  std::map<TakeName, TakeFiles> takes_;
  std::set<std::string> needed_;         // inputs of the takes that stay
  std::set<std::string> seen_;           // raw files checked already
  std::set<std::string> folders_above_;  // parent folders of removed raw files
  RemovalPlan plan_;
};

}  // namespace

Result<RemovalPlan> plan_removal(FileSystem& files, const std::string& folder,
                                 const std::vector<std::string>& names, bool with_raw) {
  return RemovalPlanner(files, folder, with_raw, KA_TRY(scan_takes(folder))).plan(names);
}

Result<void> remove_takes(FileSystem& files, const std::string& folder, const RemovalPlan& plan) {
  const std::string root = folder + "/";
  for (const std::string& file : plan.files) {
    // A missing file is no error, because this run may continue a stopped one.
    KA_TRY(remove_file(files, path_in(root, file)));
  }
  for (const std::string& inner : plan.folders) remove_if_empty(path_in(root, inner));
  return {};
}

}  // namespace kinalign
