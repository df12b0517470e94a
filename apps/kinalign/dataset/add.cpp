// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/add.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/verbs.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// The options of `kinalign dataset add`. If subject or action is empty, the id in the file counts.
struct Add {
  std::vector<std::string> folder, files;  // `folder` has one word
  std::string subject, action;
  bool copy = false;
};  // --copy: raw files are copied below sourcedata/

/// The command line of `kinalign dataset add`.
Usage describe_add(Add& o) {
  Usage usage;
  usage.positionals = {
      folder_word(o.folder),
      {"FILE", "recordings, recording.toml files or takes", &o.files, 1, 1'000'000}};
  usage.flags = {
      text_flag("subject", "id of the person (default: as in the file)", &o.subject, "ID"),
      text_flag("action", "id of the action (default: as in the file)", &o.action, "ID"),
      {"copy", "copy the raw files into the data set, below sourcedata/", &o.copy}};
  return usage;
}

/// Adds each file in turn. If one fails, the takes that were added before stay in the data set.
Result<int> run_add(Add& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  FileSystem& files = call.surroundings.files;
  // dataset.toml is read once for all files.
  const Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  call.console.advise(
      "files before this one were added; run the same command again after the repair");
  // All files use the same adder, because it remembers the takes that were added before.
  TakeAdder adder(files, folder, catalogue);
  auto json = nlohmann::ordered_json::array();
  for (const std::string& path : o.files) {
    const AddRequest request{path, o.subject, o.action, o.copy};
    const Added added = KA_TRY(adder.add(request, call.console.progress()));
    // A file that is already in the data set is no error, so that the same command may be repeated
    // after a failure.
    call.console.print(harmless(path + (added.was_there ? " was already added: " : ": ") +
                                to_string(added.name) + "\n"));
    json.push_back(
        {{"file", path}, {"name", to_string(added.name)}, {"was_there", added.was_there}});
  }
  call.console.print("see    kinalign dataset build " + harmless(folder) + "\n");
  call.console.print_json(json_text(nlohmann::ordered_json{{"added", json}}, 1));
  return 0;
}

}  // namespace

/// The verb `kinalign dataset add`.
Verb dataset_add_verb() {
  return make_verb<Add>(
      {.name = "dataset add",
       .summary = "add recordings, manifests or takes to a data set",
       .text =
           "Each gets the next free run of its subject and action. Raw files stay where they are; "
           "--copy copies them into the data set. `kinalign dataset build` makes the takes.",
       .examples =
           {{"kinalign dataset add walks takes/03_S1A02_01.mcap", "a file that `record` wrote"},
            {"kinalign dataset add walks demo/recording.toml --subject 01 --action S1A01 --copy",
             "raw files of other programs, copied"}},
       .common = {"json"}},
      describe_add, run_add);
}

}  // namespace kinalign
