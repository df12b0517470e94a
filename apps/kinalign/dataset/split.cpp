// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/split.h"

#include "apps/cli/field_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/documents/report_json.h"
#include "kinalign/view/table.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

namespace kinalign {

namespace {

/// The options of `kinalign dataset split`. If `check` names an existing split, that split is
/// checked and no new one is made.
struct SplitVerb {
  std::vector<std::string> folder;
  SplitOptions options;
  std::string test_people, check;
};

/// The command line of `kinalign dataset split`, with checks that concern several flags.
Usage describe_split(SplitVerb& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {
      choice_flag("by", "how to divide takes", &o.options.by, split_methods()),
      {"test", "fraction of the frames for the test", &o.options.test, 0.0, 1.0},
      text_flag("test-people",
                "people of the test part, instead of --by and --test; all others are for training",
                &o.test_people, "ID,ID,..."),
      {"validation", "fraction of the frames for validation", &o.options.validation, 0.0, 1.0},
      {"stratified", "with --by take: divide each class by itself", &o.options.stratified},
      {"seed", "seed of the random numbers", &o.options.seed, 0.0, 9e15},
      text_flag("check", "check an existing split instead", &o.check, "FILE")};
  usage.check = [&o](const Common& common, const Sources& given) -> Result<void> {
    // If the user names the people of the test part, flags that choose people have no meaning.
    for (const char* name : {"by", "test", "validation", "stratified", "seed"}) {
      if (o.test_people.empty() || given.count(name) == 0) continue;
      return Failure(Error{"--test-people", 0, std::string("no --") + name + " with it", "both"});
    }
    // Some takes must be left for training. make_split() checks this again with the real takes.
    if (o.options.test + o.options.validation >= 1.0) {
      return Failure(Error{"--test", 0, "fractions that leave takes for training",
                           "fractions of 1 or more together"});
    }
    if (o.options.stratified && o.options.by != "take") {
      return Failure(Error{"--stratified", 0, "--by take, the only way that can divide each class",
                           "--by " + o.options.by});
    }
    // Exactly one of -o and --check must be given.
    if (!o.check.empty() == common.out.empty()) return {};
    return Failure(Error{"-o", 0, "-o FILE for a new split, or --check FILE",
                         o.check.empty() ? "neither" : "both"});
  };
  return usage;
}

/// The number of takes, people and frames in each part. The summaries give the frames. A take that
/// is missing in the data set counts with 0 frames.
Table table_of(const Split& split, const std::vector<SplitTake>& takes) {
  std::map<TakeName, std::uint64_t> frames;
  for (const SplitTake& take : takes) frames[take.name] = take.summary.frames;
  Table table;
  table.columns = {
      {"part", "part"}, {"takes", "takes"}, {"people", "people"}, {"frames", "frames"}};
  for (const SplitPart& part : split.parts) {
    std::uint64_t sum = 0;
    std::map<std::string, int> people;
    for (const TakeName& name : part.takes) {
      sum += frames[name];
      ++people[name.subject];
    }
    table.rows.push_back({part.name, static_cast<std::int64_t>(part.takes.size()),
                          static_cast<std::int64_t>(people.size()),
                          static_cast<std::int64_t>(sum)});
  }
  return table;
}

/// Writes the file of -o, and makes its folder if needed.
Result<void> write_split(const std::string& json, Call& call) {
  const std::string& file = call.common.out;
  // The file's folder is made, too, as for -o splits/people.json in a new data set.
  std::error_code ignored;  // a fault shows when the file is created
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), ignored);
  KA_TRY(write_whole(call.surroundings.files, file, json, call.common.overwrite()));
  call.console.wrote(file);
  return {};
}

/// Makes or checks a split. A split with an error, such as the same data in two parts, is not
/// written.
Result<int> run_split(SplitVerb& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string folder = folder_of(o.folder);
  const DatasetIndex index = KA_TRY(open_index(folder, call));
  const std::vector<SplitTake> takes = KA_TRY(built_takes(files, folder, index, ""));
  const std::string file = o.check.empty() ? call.common.out : o.check;
  Split split;
  if (o.check.empty()) {
    // Empty ids between commas stay in the list. make_split() refuses them as people without takes.
    if (!o.test_people.empty()) o.options.test_people = split_at_commas(o.test_people);
    split = KA_TRY(make_split(takes, index.catalogue(), o.options));
  } else {
    split = KA_TRY(read_split(files, o.check));
  }
  // A new split is checked like an old one: two takes with different names may come from the same
  // raw bytes.
  const Findings findings = check_split(split, takes, file);
  const bool leaks = print_findings(findings, call);
  if (leaks && o.check.empty()) call.console.print("nothing was written\n");
  // With the same data in two parts, results look better than they are. Such a split is never
  // written.
  if (!leaks && o.check.empty()) {
    KA_TRY(write_split(split_json(split, takes), call));
  }
  KA_TRY(print_not_built(index, folder, call));
  const Table table = table_of(split, takes);
  call.console.print(written(table, TableFormat::text));
  call.console.print_json(fmt::format("{{\"parts\": {}, \"findings\": {}}}",
                                      written(table, TableFormat::json), findings_json(findings)));
  return leaks ? 1 : 0;
}

}  // namespace

/// The verb `kinalign dataset split`.
Verb dataset_split_verb() {
  return make_verb<SplitVerb>(
      {.name = "dataset split",
       .summary = "divide takes for training and test, and look for leaks",
       .text = "subject: no person is in two parts. take: whole takes at random. leave-one-out: a "
               "part for each person. hfut-denoise and hfut-imu are the paper's two splits. A "
               "split is refused with exit code 1 if two parts have the same take, or the same "
               "bytes under two names, or, for splits by person, the same person.",
       .examples = {{"kinalign dataset split walks --by subject --test 0.2 --seed 7 -o "
                     "walks/splits/people.json",
                     "a fifth of the frames, from people who are not in the training part"},
                    {"kinalign dataset split walks --test-people 1 -o walks/splits/first.json",
                     "one person for the test, all others for training"},
                    {"kinalign dataset split walks --check walks/splits/people.json",
                     "checks whether the split still fits the data set"}},
       .common = {"out", "force", "json"}},
      describe_split, run_split);
}

}  // namespace kinalign
