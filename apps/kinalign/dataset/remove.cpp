// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/remove.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace kinalign {

namespace {

/// The options of `kinalign dataset rm`. `names` may contain takes and people in any order;
/// plan_removal() finds out which they are.
struct Remove {
  std::vector<std::string> folder, names;
  bool raw = false, yes = false;
};

Usage describe_remove(Remove& o) {
  Usage usage;
  usage.positionals = {
      folder_word(o.folder),
      {"NAME", "takes, or a person (sub-03) with all takes", &o.names, 1, 1'000'000}};
  usage.flags = {{"raw", "remove the raw files below sourcedata/, too", &o.raw},
                 {"yes", "remove without asking", &o.yes}};
  return usage;
}

constexpr std::size_t most_places = 5;  // further raw files are only counted

/// The line about raw files that stay because --raw was not given. A path that ends in '/' is the
/// take's own folder below sourcedata/. A file may also be an input of other takes.
std::string raw_left_text(const std::vector<std::string>& places) {
  std::vector<std::string> lines;
  for (const std::string& place : places) {
    lines.push_back("  " + place + " is kept; --raw removes it" +
                    (place.ends_with('/') ? "" : ", unless another take is made from it") + "\n");
  }
  return first_lines(lines, most_places, "  and {} more raw files or folders\n");
}

/// The line about raw files that stay although --raw was given: they were neither copied nor
/// unpacked for this take. --raw removes no files outside the data set and no targets of links.
std::string raw_kept_text(const std::vector<std::string>& places) {
  std::vector<std::string> lines;
  for (const std::string& place : places) {
    lines.push_back("  " + place + " is kept: it was not copied or unpacked for this take\n");
  }
  return first_lines(lines, most_places, "  and {} more that are kept\n");
}

/// The line about raw files that stay because other takes are built from them, too.
std::string raw_shared_text(const std::vector<std::string>& places) {
  if (places.empty()) return "";
  return "  " + counted(places.size(), "raw file") + " also used by other takes " +
         (places.size() == 1 ? "stays: " : "stay: ") + places.front() +
         (places.size() == 1 ? "\n" : ", ...\n");
}

/// The takes that will be removed, and the raw files that stay. The user reads this text before
/// confirming, so it names everything that will be lost.
std::string plan_text(const RemovalPlan& plan) {
  std::string out;
  for (const TakeName& name : plan.takes) out += to_string(name) + "\n";
  out += counted(plan.takes.size(), "take") + ", " + counted(plan.files.size(), "file") + ", " +
         size_text(plan.bytes) + "\n";
  for (const std::string& name : plan.unknown) out += "  " + name + ": not in the data set\n";
  return out + raw_left_text(plan.raw_left) + raw_kept_text(plan.raw_kept) +
         raw_shared_text(plan.raw_shared);
}

/// Asks on the terminal. Only the answers y and yes mean yes.
bool agreed(Call& call) {
  // The question goes to stderr, so that it appears even if stdout goes to a file.
  call.console.complain("remove these files permanently? [y/N]");
  std::string answer;
  // The answer is read byte by byte, so that only one line is taken from the terminal.
  for (char c = 0; ::read(STDIN_FILENO, &c, 1) == 1 && c != '\n';) answer += c;
  return answer == "y" || answer == "yes";
}

/// The plan as JSON.
nlohmann::ordered_json plan_json(const RemovalPlan& plan) {
  auto takes = nlohmann::ordered_json::array();
  for (const TakeName& name : plan.takes) takes.push_back(to_string(name));
  return {{"takes", takes},
          {"files", plan.files},
          {"bytes", plan.bytes},
          {"raw_left", plan.raw_left},
          {"raw_kept", plan.raw_kept},
          {"raw_shared", plan.raw_shared},
          {"unknown", plan.unknown}};
}

/// Removes takes after asking. Without a terminal --yes must be given.
Result<int> run_remove(Remove& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string folder = folder_of(o.folder);
  KA_TRY(load_catalogue(files, folder));
  const RemovalPlan plan = KA_TRY(plan_removal(files, folder, o.names, o.raw));
  auto json = plan_json(plan);
  // The member becomes true after the last file has been removed.
  json["removed"] = false;
  if (!o.yes && !call.common.dry_run) {
    // The answer needs a terminal on stdin, and the question needs one on stderr.
    const bool can_ask = ::isatty(STDIN_FILENO) == 1 && call.surroundings.err_is_terminal;
    if (!can_ask) {
      return call.console.refuse(
          Error{"--yes", 0, "--yes, because there is no terminal to ask on", "no --yes"});
    }
  }
  call.console.print(harmless(plan_text(plan)));
  // The plan is flushed before the question, so that the user can read it first.
  const bool stays = call.common.dry_run || (!o.yes && (call.console.flush(), !agreed(call)));
  if (stays) {
    call.console.print("nothing was removed\n");
    call.console.print_json(json_text(json));
    return 0;
  }
  // After a failure below, some files are already removed, so the advice changes here.
  call.console.advise("some files may be removed; run the same command again to continue");
  KA_TRY(remove_takes(files, folder, plan));
  // Opening the index deletes the rows of takes that no longer exist.
  KA_TRY(open_index(folder, call));
  // Splits that name removed takes are listed and not edited.
  const auto splits = splits_naming(files, folder, {plan.takes.begin(), plan.takes.end()});
  json["removed"] = true;
  json["splits"] = splits_json(splits);
  call.console.print(harmless("removed\n" + splits_text(splits)));
  call.console.print_json(json_text(json));
  // If some names are unknown, the exit code is 1, although the known takes were removed. If no
  // name is known, plan_removal() has failed above.
  return plan.unknown.empty() ? 0 : 1;
}

}  // namespace

/// The verb `kinalign dataset rm`.
Verb dataset_rm_verb() {
  return make_verb<Remove>(
      {.name = "dataset rm",
       .summary = "remove takes from a data set",
       .text =
           "Removes the take, its summary, its manifest and its page. With --raw it also removes "
           "raw files that were copied or unpacked below sourcedata/, unless another take is made "
           "from them. Your own raw files are never touched. The verb asks on a terminal; without "
           "a terminal it needs --yes. Exit code 1 if a name is not in the data set."
           "",
       .examples = {{"kinalign dataset rm walks sub-03_task-S2A03_run-01 --yes", "one take"},
                    {"kinalign dataset rm walks sub-03 --raw --dry-run",
                     "prints which files of a person would be removed"}},
       .common = {"json", "dry_run"}},
      describe_remove, run_remove);
}

}  // namespace kinalign
