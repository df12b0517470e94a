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

/// Checks splits against the takes whose summaries can be read; the others have a finding already.
/// Gives one finding for each split: a note if all its takes exist and only their bytes changed.
void check_splits(FileSystem& files, const std::string& folder, Findings& findings) {
  const auto splits = splits_in(files, folder);
  const auto there = scan_takes(folder);
  // Without splits there is nothing to check. A folder that can't be read has a finding of verify()
  // already.
  if (splits.empty() || !there) return;
  std::vector<SplitTake> takes;
  for (const auto& [name, kinds] : *there) {
    // A take without a readable summary can't be checked. It is skipped here, and verify() has
    // reported it.
    const auto summary = read_summary(files, folder, name);
    if (summary) takes.push_back({name, *summary});
  }
  for (const auto& [path, split] : splits) {
    Findings found = check_split(split, takes, path);
    // Notes of a split are about people in two parts, which many splits allow.
    std::erase_if(found, [](const Finding& one) { return one.severity == Severity::note; });
    if (found.empty()) continue;
    // check_split() sorts its findings, so the first one is the most severe.
    Finding& worst = found.front();
    // The only warning is about changed bytes. After a rebuild with a new version this is normal,
    // so it becomes a note.
    if (worst.severity == Severity::warning) worst.severity = Severity::note;
    if (found.size() > 1) worst.what.found += fmt::format(", and {} more", found.size() - 1);
    worst.repair = "make it again with kinalign dataset split and --force";
    findings.push_back(std::move(worst));
  }
  // The splits' findings were appended at the end; the list must be sorted by severity again.
  sort_findings(findings);
}

/// Verifies a data set and prints the findings. Notes alone give exit code 0.
Result<int> run_verify(Verify& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  FileSystem& files = call.surroundings.files;
  const Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  // The jobs are threads: takes are hashed or read in parallel.
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
