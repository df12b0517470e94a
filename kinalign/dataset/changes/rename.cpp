// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/rename.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/dataset/build.h"
#include "kinalign/dataset/changes/toml_text.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/take_inputs.h"
#include "kinalign/documents/manifest_toml.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The journal's schema, and limits on the files that are read whole.
constexpr std::string_view schema = "kinalign.rename/1";
constexpr std::size_t longest_journal = std::size_t{64} << 20;
constexpr std::size_t longest_catalogue = std::size_t{16} << 20;
// The names of RenameKind in the journal, in the order of its values.
constexpr std::array<std::string_view, 3> kind_names{"take", "subject", "action"};

// ---- planning

std::string journal_path(const std::string& folder) {
  return folder + "/" + std::string(unfinished_rename_file);
}

/// The journal of a rename, from which a stopped run can be finished.
std::string journal_json(const RenamePlan& plan) {
  Json takes = Json::array();
  for (const auto& [from, to] : plan.takes) takes.push_back({to_string(from), to_string(to)});
  // The journal also lists the takes, because a later run can't find moved takes by their old
  // names.
  return Json{{"schema", schema},
              {"kind", kind_names[static_cast<std::size_t>(plan.kind)]},
              {"from", plan.from},
              {"to", plan.to},
              {"takes", takes}}
             .dump(1) +
         "\n";
}

/// Reads the journal of a stopped rename.
Result<RenamePlan> read_journal(FileSystem& files, const std::string& path) {
  const Failure broken(Error{path, 0, "the journal of a stopped rename", "other text"});
  const std::string text = KA_TRY(read_whole(files, path, longest_journal));
  try {
    const Json json = Json::parse(text);
    RenamePlan plan;
    const auto kind =
        std::find(kind_names.begin(), kind_names.end(), json.at("kind").get<std::string>());
    if (json.at("schema").get<std::string>() != schema || kind == kind_names.end()) return broken;
    plan.kind = static_cast<RenameKind>(kind - kind_names.begin());
    plan.from = json.at("from").get<std::string>();
    plan.to = json.at("to").get<std::string>();
    // A plan from the journal was begun before, so its journal must not be written again.
    plan.was_begun = true;
    for (const Json& pair : json.at("takes")) {
      const auto from = parse_take_name(pair.at(0).get<std::string>());
      const auto to = parse_take_name(pair.at(1).get<std::string>());
      if (!from || !to) return broken;
      plan.takes.emplace_back(*from, *to);
    }
    return plan;
  } catch (const Json::exception&) {
    return broken;
  }
}

/// A subject or an action: its prefix in names, its table in dataset.toml, its place in a name.
struct IdKind {
  RenameKind kind;
  const char *lead, *table;
  std::string TakeName::*part;
};
constexpr IdKind subjects{RenameKind::subject, "sub-", "subject", &TakeName::subject};
constexpr IdKind actions{RenameKind::action, "task-", "action", &TakeName::action};

bool is_described(const Catalogue& catalogue, const IdKind& kind, const std::string& id) {
  return kind.kind == RenameKind::subject ? find_subject(catalogue, id) != nullptr
                                          : find_action(catalogue, id) != nullptr;
}

/// The id without its prefix: "sub-03" gives "03", "task-S2A03" gives "S2A03".
std::string without(std::string_view lead, const std::string& word) {
  return word.starts_with(lead) ? word.substr(lead.size()) : word;
}

/// Checks a rename and lists the takes that it changes. Nothing is renamed here. All reasons to
/// refuse a rename are found here, so that a rename that was begun can also be finished.
class RenamePlanner {
 public:
  RenamePlanner(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                std::map<TakeName, TakeFiles> takes)
      : files_(files), folder_(folder), catalogue_(catalogue), takes_(std::move(takes)) {}

  Result<RenamePlan> plan(const std::string& from, const std::string& to) const {
    RenamePlan out;
    if (const auto name = parse_take_name(from)) {
      out = KA_TRY(plan_take(*name, to));
    } else {
      out = KA_TRY(plan_id(from, to));
    }
    // Every take is checked before the first one moves.
    for (const auto& [old, renamed] : out.takes) KA_TRY(check(old, renamed));
    return out;
  }

 private:
  // A single take may get any subject and action of dataset.toml, and any free run.
  Result<RenamePlan> plan_take(const TakeName& from, const std::string& to_text) const {
    const auto to = parse_take_name(to_text);
    if (!to)
      return fault(to_text, "the name of a take, such as sub-03_task-S2A03_run-01", shown(to_text));
    if (!takes_.contains(from)) {
      std::vector<std::string> known;
      for (const auto& [name, there] : takes_) known.push_back(to_string(name));
      return Failure(unknown_name(to_string(from), "a take of " + folder_, known));
    }
    if (find_subject(catalogue_, to->subject) == nullptr) {
      return fault(to_text, "a subject of dataset.toml", to->subject);
    }
    if (find_action(catalogue_, to->action) == nullptr) {
      return fault(to_text, "an action of dataset.toml", to->action);
    }
    return RenamePlan{RenameKind::take, to_string(from), to_string(*to), {{from, *to}}, false};
  }

  /// Plans the rename of a subject or an action, whichever has the id `from`.
  Result<RenamePlan> plan_id(const std::string& from, const std::string& to) const {
    const std::string subject = without("sub-", from), action = without("task-", from);
    const bool is_subject = has(subjects, subject) || is_described(catalogue_, subjects, subject);
    const bool is_action = has(actions, action) || is_described(catalogue_, actions, action);
    if (is_subject && is_action) {
      return fault(from, "sub-" + subject + " or task-" + action,
                   "an id of a subject and of an action");
    }
    if (is_subject) return plan_ids(subjects, subject, without(subjects.lead, to));
    if (is_action) return plan_ids(actions, action, without(actions.lead, to));
    return fault(from, "a take, a subject (sub-03) or an action of " + folder_, shown(from));
  }

  // An id that only takes have may be renamed to an id of dataset.toml. Two ids of dataset.toml
  // can't be merged.
  Result<RenamePlan> plan_ids(const IdKind& kind, const std::string& from,
                              const std::string& to) const {
    const bool both = is_described(catalogue_, kind, from) && is_described(catalogue_, kind, to);
    KA_TRY(check_new_id(kind.lead + to, to, both || has(kind, to)));
    RenamePlan out{kind.kind, from, to, {}, false};
    for (const auto& [name, there] : takes_) {
      if (name.*kind.part != from) continue;
      TakeName renamed = name;
      renamed.*kind.part = to;
      out.takes.emplace_back(name, renamed);
    }
    return out;
  }

  // `word` is the id with its prefix, for messages.
  static Result<void> check_new_id(const std::string& word, const std::string& id, bool is_taken) {
    if (!is_label(id)) return fault(word, "an id of letters and digits", shown(id));
    if (is_taken) return fault(word, "an id that the data set does not have", "an id that it has");
    return {};
  }

  // True if a take has the id, even if dataset.toml lacks it.
  bool has(const IdKind& kind, const std::string& id) const {
    return std::any_of(takes_.begin(), takes_.end(),
                       [&](const auto& take) { return take.first.*kind.part == id; });
  }

  // Checks that the new name and its folder of raw files are free. If subject or action changes,
  // the take is made again, so its manifest and raw files must exist.
  Result<void> check(const TakeName& from, const TakeName& to) const {
    if (takes_.contains(to)) {
      return fault(path_of(folder_, to, TakeFile::take), "no take of the new name",
                   "an existing take");
    }
    std::error_code fault_code;
    if (fs::exists(folder_ + "/" + raw_folder(to), fault_code)) {
      return fault(folder_ + "/" + raw_folder(to), "no raw files of the new name", "a folder");
    }
    const bool same_bytes = from.subject == to.subject && from.action == to.action;
    return same_bytes || !takes_.at(from).take ? Result<void>{} : check_can_be_made(from);
  }

  Result<void> check_can_be_made(const TakeName& name) const {
    const std::string take = path_of(folder_, name, TakeFile::take);
    const std::string why =
        " (a take's file contains subject and action, so the take has to be made again)";
    // A take that was added without raw files has no manifest and can't be made again.
    if (!takes_.at(name).manifest) {
      return fault(take, "a take with a manifest" + why, "a take that was added as a take");
    }
    const Manifest manifest = KA_TRY(take_manifest(files_, folder_, catalogue_, name));
    for (const TakeInput& input : inputs_of(files_, manifest, folder_of(folder_, name), {})) {
      // One missing raw file is enough: the take can't be made again.
      std::error_code missing;
      if (fs::exists(input.path, missing)) continue;
      return fault(input.path, "the raw file of " + to_string(name) + why, "no such file");
    }
    return {};
  }

  static Failure fault(const std::string& where, const std::string& expected,
                       const std::string& found) {
    return Failure(Error{where, 0, expected, found});
  }

  FileSystem& files_;
  const std::string& folder_;
  const Catalogue& catalogue_;
  std::map<TakeName, TakeFiles> takes_;
};

// ---- renaming

/// Does the renaming. Each step checks what exists and does the rest, so the same calls continue a
/// run that was stopped at any step. The new file is always written before the old file is removed.
class Renamer {
 public:
  Renamer(FileSystem& files, const std::string& folder) : files_(files), folder_(folder) {}

  // The order is: manifest, raw files, take and summary. The old manifest is removed last, because
  // it shows a later run that the take has not moved completely.
  Result<void> move(const TakeName& from, const TakeName& to, Renamed& out) {
    KA_TRY(make_folders(folder_ + "/sub-" + to.subject));
    const bool same_name = from.subject == to.subject && from.action == to.action;
    bool same_recipe = true;
    if (is_there(path_of(folder_, from, TakeFile::manifest))) {
      same_recipe = KA_TRY(write_manifest(from, to));
    }
    KA_TRY(move_raw_files(from, to));
    const bool had_take = is_there(path_of(folder_, from, TakeFile::take));
    // A take whose bytes state the old name or recipe is removed; `dataset build` makes it again.
    for (const TakeFile file : {TakeFile::summary, TakeFile::take}) {
      KA_TRY(move_or_drop(path_of(folder_, from, file), path_of(folder_, to, file),
                          same_name && same_recipe));
    }
    KA_TRY(remove_file(files_, path_of(folder_, from, TakeFile::manifest)));
    KA_TRY(remove_file(files_, folder_ + "/report/" + to_string(from) + ".html"));
    if (had_take && same_name && same_recipe) ++out.moved;
    if (!is_there(path_of(folder_, to, TakeFile::take))) ++out.to_build;
    return {};
  }

  Result<void> edit_catalogue(const RenamePlan& plan) {
    // The name of a single take does not occur in dataset.toml.
    if (plan.kind == RenameKind::take) return {};
    const std::string path = folder_ + "/" + std::string(catalogue_file);
    const std::string toml = KA_TRY(read_whole(files_, path, longest_catalogue));
    const Catalogue now = KA_TRY(read_catalogue(toml, path));
    const IdKind& kind = plan.kind == RenameKind::subject ? subjects : actions;
    // If the old id is missing, the stopped run has edited dataset.toml already.
    if (!is_described(now, kind, plan.from)) return {};
    const std::string text = KA_TRY(with_id_renamed(toml, kind.table, plan.from, plan.to, path));
    return write_whole(files_, path, text, Overwrite::yes);
  }

 private:
  /// Writes the manifest under its new name. Returns true if the parameters of the take are
  /// unchanged.
  Result<bool> write_manifest(const TakeName& from, const TakeName& to) {
    const std::string path = path_of(folder_, from, TakeFile::manifest);
    const std::string toml = KA_TRY(read_whole(files_, path, longest_manifest));
    const std::string text = KA_TRY(manifest_of_renamed(toml, from, to, path));
    KA_TRY(write_whole(files_, path_of(folder_, to, TakeFile::manifest), text, Overwrite::yes));
    // Equal recipes show that the edit changed no parameter of the take.
    return recipe_of(KA_TRY(read_manifest(toml, path))) ==
           recipe_of(KA_TRY(read_manifest(text, path)));
  }

  // The folder of raw files is renamed in one step of the file system.
  Result<void> move_raw_files(const TakeName& from, const TakeName& to) {
    const std::string old = folder_ + "/" + raw_folder(from),
                      renamed = folder_ + "/" + raw_folder(to);
    std::error_code fault;
    if (!fs::exists(old, fault)) return {};
    KA_TRY(make_folders(folder_ + "/sourcedata/sub-" + to.subject));
    return move_path(old.substr(0, old.size() - 1), renamed.substr(0, renamed.size() - 1));
  }

  // Moves a file, or removes it unless `keeps_bytes`. A missing file was moved or removed before.
  Result<void> move_or_drop(const std::string& from, const std::string& to, bool keeps_bytes) {
    if (!is_there(from)) return {};
    return keeps_bytes ? move_path(from, to) : remove_file(files_, from);
  }

  Result<void> move_path(const std::string& from, const std::string& to) {
    if (files_.rename(from.c_str(), to.c_str()) == 0) return {};
    return Failure(Error{from, 0, "a file that can become " + to, std::strerror(errno)});
  }

  FileSystem& files_;
  const std::string& folder_;
};

}  // namespace

Result<RenamePlan> plan_rename(FileSystem& files, const std::string& folder,
                               const Catalogue& catalogue, const std::string& from,
                               const std::string& to) {
  const std::string journal = journal_path(folder);
  if (!is_there(journal)) {
    return RenamePlanner(files, folder, catalogue, KA_TRY(scan_takes(folder))).plan(from, to);
  }
  const RenamePlan begun = KA_TRY(read_journal(files, journal));
  const std::string lead = begun.kind == RenameKind::subject  ? "sub-"
                           : begun.kind == RenameKind::action ? "task-"
                                                              : "";
  // The same request continues the stopped rename.
  if (without(lead, from) == begun.from && without(lead, to) == begun.to) return begun;
  return Failure(Error{journal, 0,
                       "the stopped rename to be finished first: kinalign dataset rename " +
                           folder + " " + lead + begun.from + " " + lead + begun.to,
                       shown(from) + " to " + shown(to)});
}

Result<Renamed> rename_takes(FileSystem& files, const std::string& folder, const RenamePlan& plan) {
  Renamer renamer(files, folder);
  if (!plan.was_begun) {
    KA_TRY(write_whole(files, journal_path(folder), journal_json(plan), Overwrite::no));
  }
  // dataset.toml is edited first, so that no moved take has an id that dataset.toml lacks.
  KA_TRY(renamer.edit_catalogue(plan));
  Renamed out;
  for (const auto& [from, to] : plan.takes) KA_TRY(renamer.move(from, to, out));
  for (const auto& [from, to] : plan.takes) {
    remove_if_empty(folder + "/sub-" + from.subject);
    remove_if_empty(folder + "/sourcedata/sub-" + from.subject);
  }
  // The journal is removed last. Until then every step can be repeated.
  KA_TRY(remove_file(files, journal_path(folder)));
  return out;
}

}  // namespace kinalign
