// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/tables.h"

#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/dataset/table_output.h"
#include "apps/kinalign/verbs.h"

#include <array>
#include <utility>

namespace kinalign {

namespace {

/// The options of `kinalign dataset tables`.
struct Tables {
  std::vector<std::string> folder;
  std::string table = "all", format = "text";
};

// The tables in the order in which they are printed. Their names are the choices of --table and the
// members of the JSON.
using Make = Result<Table> (*)(const DatasetIndex&);
constexpr std::array<std::pair<const char*, Make>, 4> tables{{{"subjects", table_by_subject},
                                                              {"classes", table_by_class},
                                                              {"modalities", table_by_modalities},
                                                              {"data_sets", table_of_data_sets}}};

/// The command line of `kinalign dataset tables`.
Usage describe_tables(Tables& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {choice_flag("table", "which", &o.table,
                             {"all", "subjects", "classes", "modalities", "data_sets"}),
                 format_field(o.format)};
  return usage;
}

/// Prints one of the tables, or all of them.
Result<int> run_tables(Tables& o, Call& call) {
  const DatasetIndex index = KA_TRY(open_index(folder_of(o.folder), call));
  std::vector<NamedTable> chosen;
  for (const auto& [name, make] : tables) {
    if (o.table == "all" || o.table == name) chosen.push_back({name, KA_TRY(make(index))});
  }
  print_tables(chosen, o.format, call);
  if (o.format == "text") KA_TRY(print_not_built(index, folder_of(o.folder), call));
  return index.findings().empty() ? 0 : 1;
}

}  // namespace

/// The verb `kinalign dataset tables`.
Verb dataset_tables_verb() {
  return make_verb<Tables>(
      {.name = "dataset tables",
       .summary = "the paper's tables of a data set: frames by people and by classes",
       .text =
           "subjects is the paper's table 6, classes its table 7, data_sets its table 1 with this "
           "data set in the last row. modalities lists the modalities that were recorded together.",
       .examples = {{"kinalign dataset tables walks", "all four"},
                    {"kinalign dataset tables walks --table classes --format latex",
                     "for a paper"}},
       .common = {"json"}},
      describe_tables, run_tables);
}

}  // namespace kinalign
