// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/rename.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// The options of `kinalign dataset rename`: one old and one new name of the same kind.
struct Rename {
  std::vector<std::string> folder, from, to;
};

Usage describe_rename(Rename& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder),
                       {"OLD", "a take, a person (sub-03) or an action", &o.from},
                       {"NEW", "the new name", &o.to}};
  return usage;
}

// The old and the new name of every take, for programs that keep lists of takes.
nlohmann::ordered_json takes_json(const RenamePlan& plan) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& [from, to] : plan.takes) {
    json.push_back({{"from", to_string(from)}, {"to", to_string(to)}});
  }
  return json;
}

/// Prints the plan of --dry-run. plan_rename() has made all checks, so a real call would do the
/// same.
Result<int> show_plan(const RenamePlan& plan, Call& call) {
  for (const auto& [from, to] : plan.takes) {
    call.console.print(to_string(from) + " -> " + to_string(to) + "\n");
  }
  call.console.print(counted(plan.takes.size(), "take") + " to rename\n");
  call.console.print_json(json_text(nlohmann::ordered_json{{"takes", takes_json(plan)}}));
  return 0;
}

/// Renames a take, a person or an action. If it was stopped, the same command finishes the work.
Result<int> run_rename(Rename& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string folder = folder_of(o.folder), from = o.from.front(), to = o.to.front();
  const Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  // plan_rename() finds all conflicts. After it only a fault of the disk can stop the rename.
  const RenamePlan plan = KA_TRY(plan_rename(files, folder, catalogue, from, to));
  if (call.common.dry_run) return show_plan(plan, call);
  // The advice repeats the exact command, because only the same rename continues a stopped one.
  call.console.advise(
      "some files may be renamed; run the same command again to continue: kinalign dataset "
      "rename " +
      folder + " " + from + " " + to);
  const Renamed done = KA_TRY(rename_takes(files, folder, plan));
  KA_TRY(open_index(folder, call));
  std::set<TakeName> old;
  // Old splits contain the old names, so these are searched.
  for (const auto& take : plan.takes) old.insert(take.first);
  const auto splits = splits_naming(files, folder, old);
  std::string text =
      fmt::format("{}: {} is now {}, {}\n", folder, from, to, counted(plan.takes.size(), "take"));
  // The bytes of a take contain the names, so each renamed take must be built again.
  if (done.to_build > 0) {
    text +=
        fmt::format("  {} to be made again, because a take's file contains subject and action\n",
                    counted(done.to_build, "take"));
  }
  text += splits_text(splits);
  if (done.to_build > 0) text += fmt::format("see    kinalign dataset build {}\n", folder);
  call.console.print(harmless(text));
  call.console.print_json(json_text(nlohmann::ordered_json{{"takes", takes_json(plan)},
                                                           {"moved", done.moved},
                                                           {"to_build", done.to_build},
                                                           {"splits", splits_json(splits)}}));
  return 0;
}

}  // namespace

/// The verb `kinalign dataset rename`.
Verb dataset_rename_verb() {
  return make_verb<Rename>(
      {.name = "dataset rename",
       .summary = "give a take, a person or an action another name",
       .text = "Renames files, raw files below sourcedata/, manifests and ids in dataset.toml; "
               "comments are kept. If the subject or action of a take changes, the take is removed "
               "and has to be built again from its raw files. Nothing is overwritten. The same "
               "command finishes a stopped rename.",
       .examples = {{"kinalign dataset rename walks sub-03 sub-13", "a person"},
                    {"kinalign dataset rename walks sub-03_task-S2A03_run-01 "
                     "sub-03_task-S2A04_run-01",
                     "a take that was filed under the wrong action"},
                    {"kinalign dataset rename walks S2A03 S2A09 --dry-run",
                     "prints what would be renamed"}},
       .common = {"json", "dry_run"}},
      describe_rename, run_rename);
}

}  // namespace kinalign
