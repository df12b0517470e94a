// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/core/files.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

/// The options of `kinalign dataset init`.
struct Init {
  std::vector<std::string> folder;
  std::string template_name = "empty", name;
};

/// The command line of `kinalign dataset init`.
Usage describe_init(Init& o) {
  Usage usage;
  usage.positionals = {{"FOLDER", "folder of the new data set; it may exist", &o.folder}};
  usage.flags = {
      choice_flag("template", "first content of dataset.toml", &o.template_name,
                  catalogue_template_names()),
      text_flag("name", "name of the data set (default: the folder's name)", &o.name, "NAME")};
  return usage;
}

/// Writes dataset.toml. An existing file is never overwritten.
Result<int> run_init(Init& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  KA_TRY(make_folders(folder));
  // The data set is named after its folder. weakly_canonical() replaces "." and ".." by the real
  // name.
  std::error_code fault;
  const std::string own = std::filesystem::weakly_canonical(folder, fault).filename().string();
  const std::string path = folder + "/" + std::string(catalogue_file);
  const std::string text =
      KA_TRY(catalogue_template(o.template_name, o.name.empty() ? own : o.name));
  // People edit this file by hand, so it must not be overwritten: a second call fails.
  KA_TRY(write_whole(call.surroundings.files, path, text, Overwrite::no));
  call.console.print(harmless(
      path +
      ": a new data set. Describe the people and the actions in it; then\n  kinalign dataset add " +
      folder + " TAKE.mcap ...\n"));
  call.console.print_json(nlohmann::ordered_json{{"written", path}}.dump());
  return 0;
}

}  // namespace

/// The verb `kinalign dataset init`.
Verb dataset_init_verb() {
  return make_verb<Init>(
      {.name = "dataset init",
       .summary = "make a folder a data set",
       .text = "Writes dataset.toml: the name, the licence, people by pseudonyms, classes of "
               "actions and actions. "
               "The template hfut-mmd has the paper's 12 people, 6 classes and 34 actions.",
       .examples = {{"kinalign dataset init walks", "an empty data set"},
                    {"kinalign dataset init hfut --template hfut-mmd",
                     "with the paper's catalogue"}},
       .common = {"json"}},
      describe_init, run_init);
}

}  // namespace kinalign
