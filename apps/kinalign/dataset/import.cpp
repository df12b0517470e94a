// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/import.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/dataset/import/corpora.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

/// The options of `kinalign dataset import`. An empty text or 0 means that the corpus or its files
/// decide.
struct Import {
  std::vector<std::string> folder, sources;
  std::string from = "auto", subject, action, up;
  double metres_per_unit = 0.0;  // 0: as the file format states it
  bool copy = false;
};

/// The command line of `kinalign dataset import`.
Usage describe_import(Import& o) {
  // The library's list of corpora does not contain "auto"; an empty kind stands for it there.
  std::vector<std::string> kinds{"auto"};
  for (const std::string& name : corpus_kind_names()) kinds.push_back(name);
  Usage usage;
  usage.positionals = {folder_word(o.folder),
                       {"SOURCE", "folders, files or archives (.zip, .tar, .tar.gz) of a corpus",
                        &o.sources, 1, 1'000'000}};
  usage.flags = {
      choice_flag("from", "kind of corpus; auto: recognised by its files", &o.from, kinds),
      text_flag("subject", "id of the person, if neither folders nor names state it", &o.subject,
                "ID"),
      text_flag("action", "id of the action, instead of the names of single files", &o.action,
                "ID"),
      {"metres_per_unit",
       "length of the unit of BVH, C3D or TRC files, m; 0: the format's own (BVH: 0.01)",
       &o.metres_per_unit, 0.0, 1000.0},
      choice_flag("up", "the up axis of BVH, C3D or TRC files (default: the format's own)", &o.up,
                  {"", "y", "z"}),
      {"copy", "copy the raw files into the data set, below sourcedata/", &o.copy}};
  return usage;
}

/// The first `most` words, joined by commas, and the end of the line.
std::string first_words(const std::vector<std::string>& words, std::size_t most) {
  const auto end = words.begin() + static_cast<std::ptrdiff_t>(std::min(most, words.size()));
  return fmt::format("{}{}\n", fmt::join(words.begin(), end, ", "),
                     words.size() > most ? ", ..." : "");
}

/// A line for each reason why files were left out: "10 without Vicon left out: m03_s03_e01,
/// m03_s03_e02, m03_s03_e03, ...". A corpus may have thousands of such files, so each line names
/// three of them. The JSON names all.
std::string left_out_lines(const std::vector<LeftOut>& all) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const LeftOut& one : all) by_reason[one.why].push_back(one.what);
  std::string text;
  for (const auto& [why, what] : by_reason) {
    text += fmt::format("  left out, {}: {}: {}", why, what.size(), first_words(what, 3));
  }
  return text;
}

/// Names in the corpus, each with the id that it got in the data set.
using Changed = std::vector<std::pair<std::string, std::string>>;

/// The line about names that became other ids. Many names of a corpus are not allowed as ids, and
/// the user must be able to find them again. `what`: "people" or "actions".
std::string changed_line(std::string_view what, const Changed& changed) {
  if (changed.empty()) return "";
  std::vector<std::string> words;
  for (const auto& [word, id] : changed) words.push_back(word + " is " + id);
  return fmt::format("  {} renamed to ids of letters and digits: {}", what, first_words(words, 5));
}

nlohmann::ordered_json json_of(const Changed& changed) {
  auto out = nlohmann::ordered_json::object();
  for (const auto& [word, id] : changed) out[word] = id;
  return out;
}

/// Prints the result of an import as JSON. made.takes also counts takes that were there before;
/// "added" counts only new ones.
void print_json(const Imported& made, Console& console) {
  auto left_out = nlohmann::ordered_json::array();
  for (const LeftOut& one : made.left_out) {
    left_out.push_back({{"what", one.what}, {"why", one.why}});
  }
  console.print_json(json_text(nlohmann::ordered_json{{"corpus", made.kind},
                                                      {"takes", made.takes},
                                                      {"added", made.takes - made.were_there},
                                                      {"were_there", made.were_there},
                                                      {"subjects", made.subjects},
                                                      {"actions", made.actions},
                                                      {"new_data_set", made.is_new},
                                                      {"left_out", left_out},
                                                      {"subject_ids", json_of(made.subject_ids)},
                                                      {"action_ids", json_of(made.action_ids)}},
                               1));
}

/// Imports a corpus. The advice to run the command again is set once a take has been added.
Result<int> run_import(Import& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  Console& console = call.console;
  const ImportRequest request{o.sources,
                              o.from == "auto" ? "" : o.from,
                              o.subject,
                              o.action,
                              o.metres_per_unit,
                              o.up,
                              o.copy,
                              call.jobs};
  const Imported made =
      KA_TRY(import_corpus(call.surroundings.files, folder, request, console.progress(),
                           [&](std::uint64_t done, std::uint64_t takes) {
                             // This function is called after each take. A line for every hundredth
                             // take shows that a long import goes on, also in a log file. Before
                             // the first take the data set is unchanged, so no advice is needed.
                             if (done == 1) {
                               console.advise(
                                   "some takes are in the data set; run the same command again to "
                                   "continue");
                             }
                             if (done % 100 == 0 && done < takes)
                               console.print(fmt::format("{} of {}\n", done, takes));
                           }));
  console.print(harmless(
      fmt::format("{}: {} of {}, {}{}\n", made.kind, counted(made.takes, "take"),
                  counted(made.subjects, "person", "people"), counted(made.actions, "action"),
                  made.were_there > 0 ? fmt::format("; {} existed before", made.were_there) : "")));
  console.print(harmless(left_out_lines(made.left_out) + changed_line("people", made.subject_ids) +
                         changed_line("actions", made.action_ids)));
  console.print("see    kinalign dataset build " + harmless(folder) + "\n");
  print_json(made, console);
  return 0;
}

}  // namespace

/// The verb `kinalign dataset import`.
Verb dataset_import_verb() {
  return make_verb<Import>(
      {.name = "dataset import",
       .summary = "add a published corpus to a data set",
       .text = "Recognises a corpus by its folders and names, adds its people and actions to "
               "dataset.toml, and adds its takes as `dataset add` does. If FOLDER is no data set "
               "yet, it becomes one. Running the same import again adds nothing twice. "
               "docs/dataset_import.md lists the contents of each corpus.",
       .examples =
           {{"kinalign dataset import prmd ui_prmd.zip", "an archive, unpacked below sourcedata/"},
            {"kinalign dataset import dances bvh/ --from bvh --copy",
             "a folder of BVH files with a folder per person, copied"},
            {"kinalign dataset import dances bvh/ --metres-per-unit 1 --up z",
             "the same in metres, with z up"},
            {"kinalign dataset import pairs ui_prmd/ --from ui-prmd-joints",
             "UI-PRMD for learning: joints of both devices on the Kinect's frames"},
            {"kinalign dataset import walks walk_01.bvh walk_02.bvh --subject 07 --action walk",
             "single files of one person"}},
       .common = {"json", "jobs"}},
      describe_import, run_import);
}

}  // namespace kinalign
