// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/verify.h"

#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/dataset/changes/split_files.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/documents/report_json.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// The options of `kinalign dataset verify`.
struct Verify {
  std::vector<std::string> folder;
  bool deep = false;
};

Usage describe_verify(Verify& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {
      {"deep", "also read every row of the takes and every byte of the raw files", &o.deep}};
  return usage;
}

/// Checks the splits of a data set against its takes. Takes whose summary can't be read have a
/// finding already and are left out. Each split with a problem gets one finding. The finding is a
/// note if all takes of the split exist and only their bytes have changed.
void check_splits(FileSystem& files, const std::string& folder, Findings& findings) {
  const auto splits = splits_in(files, folder);
  const auto there = scan_takes(folder);
  // Without splits there is nothing to check. If the folder can't be read, verify() has reported
  // it.
  if (splits.empty() || !there) return;
  std::vector<SplitTake> takes;
  for (const auto& [name, kinds] : *there) {
    // A take without a readable summary is skipped here; verify() has reported it.
    const auto summary = read_summary(files, folder, name);
    if (summary) takes.push_back({name, *summary});
  }
  for (const auto& [path, split] : splits) {
    Findings found = check_split(split, takes, path);
    // A note says that a person is in two parts. Many splits allow that, so notes are dropped.
    std::erase_if(found, [](const Finding& one) { return one.severity == Severity::note; });
    if (found.empty()) continue;
    // check_split() sorts findings by severity, so the first one is the worst.
    Finding& worst = found.front();
    // check_split() warns only about changed bytes. They are normal after a rebuild with a new
    // version, so the warning becomes a note.
    if (worst.severity == Severity::warning) worst.severity = Severity::note;
    if (found.size() > 1) worst.what.found += fmt::format(", and {} more", found.size() - 1);
    worst.repair = "make it again with kinalign dataset split and --force";
    findings.push_back(std::move(worst));
  }
  // The findings of the splits stand at the end of the list, so the list is sorted by severity
  // again.
  sort_findings(findings);
}

/// Verifies a data set and prints the findings. If there are only notes, the exit code is 0.
Result<int> run_verify(Verify& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  FileSystem& files = call.surroundings.files;
  const Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  // --jobs gives the number of threads that read and hash takes.
  Verified found =
      KA_TRY(verify(files, folder, catalogue, {call.jobs, o.deep}, call.console.progress()));
  check_splits(files, folder, found.findings);
  std::size_t serious = 0;
  for (const Finding& one : found.findings) {
    if (one.severity != Severity::note) ++serious;
    const std::string word(to_string(one.severity));
    call.console.print(
        call.console.paint(colour_of(one.severity), word) + "  " +
        harmless(to_string(one.what) + (one.repair.empty() ? "" : ": " + one.repair)) + "\n");
  }
  call.console.print(
      harmless(fmt::format("{}: {} takes, {:.1f} MB read, {}\n", folder, found.takes,
                           1e-6 * static_cast<double>(found.bytes),
                           serious == 0 ? "no faults" : fmt::format("{} faults", serious))));
  call.console.print_json(fmt::format("{{\"takes\": {}, \"bytes\": {}, \"findings\": {}}}",
                                      found.takes, found.bytes, findings_json(found.findings)));
  return serious == 0 ? 0 : 1;
}

}  // namespace

/// The verb `kinalign dataset verify`.
Verb dataset_verify_verb() {
  return make_verb<Verify>(
      {.name = "dataset verify",
       .summary = "check a data set: read every byte of its takes",
       .text = "Compares each take with its SHA-256 and its summary, names with dataset.toml, and "
               "manifests with the files that the takes were made from. Lists files that belong to "
               "no take. Exit code 1 if something is wrong; 0 if there are only notes.",
       .examples = {{"kinalign dataset verify walks", "after a copy, or once a year"},
                    {"kinalign dataset verify walks --deep",
                     "stamps, bones and units of every row, and the raw files"}},
       .common = {"json", "jobs"}},
      describe_verify, run_verify);
}

}  // namespace kinalign
