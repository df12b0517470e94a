// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/verify.h"

#include "kinalign/core/find_named.h"
#include "kinalign/core/parallel.h"
#include "kinalign/dataset/build.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/summarise.h"
#include "kinalign/dataset/take_inputs.h"
#include "kinalign/sources/input_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>
#include <set>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

/// Names that may exist in the data set's folder in addition to the takes.
constexpr std::array<std::string_view, 11> known_names{
    "dataset.toml", "README.md", "LICENSE",     "LICENCE", "CHANGES", "sourcedata",
    "splits",       "windows",   "report.html", "report",  "truth"};

/// A file whose bytes are to be read.
struct ToHash {
  std::string path, sha256, name;  // `name`: for messages
  std::uint64_t bytes = 0;
};

/// One check of a data set; run() calls the steps in order. A child process first opens the takes,
/// while there is only one thread. At the end several threads compute the hashes.
class Verifier {
 public:
  Verifier(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
           const VerifyOptions& options, const Progress& progress)
      : files_(files),
        folder_(folder),
        catalogue_(catalogue),
        options_(options),
        progress_(progress) {}

  Result<Verified> run() {
    takes_ = KA_TRY(scan_takes(folder_));
    check_catalogue();
    // The summaries come first, because the later steps compare manifests and hashes with them.
    KA_TRY(check_summaries());
    for (const auto& [name, there] : takes_) check_take(name, there);
    KA_TRY(check_names());
    check_sourcedata();
    KA_TRY(check_hashes());
    sort_findings(out_.findings);
    return std::move(out_);
  }

 private:
  // Adds a finding about a file below the data set's folder.
  void report(Severity severity, const std::string& file, std::string expected, std::string found,
              std::string repair = "") {
    out_.findings.push_back(
        {severity, Error{file, 0, std::move(expected), std::move(found)}, "", std::move(repair)});
  }

  /// Adds notes about texts that dataset.toml does not state.
  void check_catalogue() {
    const std::string file(catalogue_file);
    const std::array<std::pair<const char*, const std::string*>, 3> texts{
        {{"licence", &catalogue_.licence},
         {"contact", &catalogue_.contact},
         {"description", &catalogue_.description}}};
    for (const auto& [key, text] : texts) {
      if (text->empty()) report(Severity::note, file, key, "none");
    }
    for (const Subject& one : catalogue_.subjects) {
      if (one.sex.empty() || !one.height_cm) {
        report(Severity::note, file, "sex and height_cm of subject " + one.id, "not both");
      }
    }
  }

  /// Checks that each summary agrees with its take.
  Result<void> check_summaries() {
    std::vector<TakeName> names;
    for (const auto& [name, there] : takes_) {
      if (there.take) names.push_back(name);
    }
    const auto made = summarise_takes(files_, folder_, names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!made[i]) {
        Error error = made[i].error();
        // Messages have paths below the data set's folder.
        error.file = path_of(names[i], TakeFile::take);
        out_.findings.push_back({Severity::error, std::move(error), "", ""});
      } else {
        compare_summary(names[i], *made[i]);
      }
      // The rows of each take are also read in a child process, one take after the other.
      if (options_.deep && made[i]) KA_TRY(check_contents(names[i], made[i]->rate_hz));
      if (!go_on(progress_, "comparing", i + 1, names.size())) return Failure(interruption());
    }
    return {};
  }

  // Checks the rows of a take. If they can't be read, this is an error of the take, unless the user
  // stopped the check.
  Result<void> check_contents(const TakeName& name, double rate_hz) {
    const auto found = check_rows(files_, folder_, name, rate_hz);
    if (found) {
      append(out_.findings, *found);
      return {};
    }
    if (is_interruption(found.error())) return Failure(found.error());
    report(Severity::error, path_of(name, TakeFile::take), found.error().expected,
           found.error().found);
    return {};
  }

  // Compares the stored summary with `made`, which was just made from the take.
  void compare_summary(const TakeName& name, TakeSummary made) {
    const std::string file = path_of(name, TakeFile::summary);
    const std::string again = "remove this file; kinalign dataset build makes it again";
    if (!takes_.at(name).summary) {
      report(Severity::error, file, "a summary next to the take", "no summary",
             "kinalign dataset build makes it");
      return;
    }
    const auto text = read_whole(files_, folder_ + "/" + file, longest_summary);
    const auto stored = text ? parse_summary_json(*text, file) : Failure(text.error());
    if (!stored) {
      report(Severity::error, file, "a summary that can be read: " + stored.error().expected,
             stored.error().found, again);
      return;
    }
    // The hash is checked later, with the hashes of all other files. Here it must not differ.
    made.sha256 = stored->sha256;
    std::error_code fault;
    made.bytes = std::filesystem::file_size(path_of(folder_, name, TakeFile::take), fault);
    // All values in a summary follow from the take's bytes, so the texts must be equal.
    if (summary_json(made) != *text) {
      report(Severity::error, file, "the contents of the take", "other values", again);
    }
    if (made.subject != name.subject || made.action != name.action) {
      report(Severity::error, path_of(name, TakeFile::take),
             "subject and action as in the take's name", made.subject + " and " + made.action);
    }
    hashes_.push_back({path_of(folder_, name, TakeFile::take), stored->sha256,
                       path_of(name, TakeFile::take), stored->bytes});
    // Manifests are compared only with good summaries.
    summaries_.emplace(name, *stored);
  }

  // Checks that the take exists, and that dataset.toml has its person and action.
  void check_take(const TakeName& name, const TakeFiles& there) {
    if (!there.take) {
      report(Severity::error,
             path_of(name, there.manifest ? TakeFile::manifest : TakeFile::summary),
             "a take with this name", "no take", there.manifest ? "kinalign dataset build" : "");
    }
    if (find_subject(catalogue_, name.subject) == nullptr) {
      report(Severity::warning, path_of(name, TakeFile::take), "a subject of dataset.toml",
             name.subject);
    }
    if (find_action(catalogue_, name.action) == nullptr) {
      report(Severity::warning, path_of(name, TakeFile::take), "an action of dataset.toml",
             name.action);
    }
    const auto summary = summaries_.find(name);
    if (there.manifest && summary != summaries_.end()) check_manifest(name, summary->second);
  }

  // Checks that the manifest would make the same take again: same parameters, same files.
  void check_manifest(const TakeName& name, const TakeSummary& summary) {
    const std::string file = path_of(name, TakeFile::manifest), build = "kinalign dataset build";
    const auto manifest = take_manifest(files_, folder_, catalogue_, name);
    if (!manifest) {
      out_.findings.push_back({Severity::error, manifest.error(), "", ""});
      return;
    }
    if (recipe_of(*manifest) != summary.recipe) {
      report(Severity::warning, file, "the parameters of the take", "other parameters", build);
    }
    for (const TakeInput& input :
         inputs_of(files_, *manifest, folder_of(folder_, name), summary.inputs)) {
      check_input(file, input, summary);
    }
  }

  // Sizes are always compared. Raw files are hashed only in a deep check, because they may be
  // large.
  void check_input(const std::string& manifest, const TakeInput& input,
                   const TakeSummary& summary) {
    const InputFacts* const known = find_named(summary.inputs, input.name);
    std::error_code fault;
    const auto size = fs::file_size(input.path, fault);
    if (fault) {
      report(Severity::warning, manifest, "the raw file " + input.name, "no such file",
             "the take can't be made again without this file");
    } else if (known == nullptr || known->bytes != size) {
      report(Severity::warning, manifest,
             "the raw file " + input.name + " that the take was made from", "another file",
             "kinalign dataset build");
    } else if (options_.deep) {
      hashes_.push_back({input.path, known->sha256, manifest, size});
    }
  }

  /// Adds notes about files that do not belong to the data set.
  Result<void> check_names() {
    const std::string root = folder_ + "/";
    for (const std::string& name : KA_TRY(names_in_folder(folder_))) {
      const bool is_known =
          std::find(known_names.begin(), known_names.end(), name) != known_names.end();
      // Hidden files belong to other programs, or to the index.
      if (is_known || name.starts_with('.')) continue;
      if (name == unfinished_rename_file) {
        report(Severity::error, name, "a finished rename", "a stopped rename",
               "run the same kinalign dataset rename again; this file names it");
        continue;
      }
      const std::string place = root + name, below = name + "/";
      std::error_code ignored;
      // Only a folder with a valid id can contain takes.
      const bool is_person =
          name.starts_with("sub-") && is_label(name.substr(4)) && fs::is_directory(place, ignored);
      if (!is_person) {
        report(Severity::note, name, "a file or folder of a data set", "an unknown file or folder");
        continue;
      }
      for (const std::string& file : KA_TRY(names_in_folder(place))) {
        const std::string path = below + file;
        if (!parse_take_path(path)) {
          report(Severity::note, path, "a file of a take", "an unknown file");
        }
      }
    }
    return {};
  }

  /// Reports raw files from which no take is made. This needs all manifests.
  void check_sourcedata() {
    const auto there = files_in_sourcedata(folder_);
    if (!there) {
      report(Severity::warning, std::string(raw_files_folder), there.error().expected,
             there.error().found, "files of no take could not be found");
      return;
    }
    if (there->empty()) return;
    // The raw files that a manifest names.
    std::set<std::string> named;
    for (const auto& [name, files] : takes_) {
      const auto inputs = raw_files_of(files_, folder_, name);
      // If a manifest can't be read, the files that it names are not known, so nothing is reported.
      if (!inputs) return;
      for (const TakeInput& input : *inputs) {
        if (const auto place = place_in_sourcedata(folder_, input.path)) named.insert(*place);
      }
    }
    std::set<std::string> others;
    for (const std::string& file : *there) {
      if (!named.contains(file)) others.insert(file);
    }
    if (others.empty()) return;
    std::vector<std::string> first(others.begin(), others.end());
    // The message names only a few files, from which the user can find the others.
    first.resize(std::min<std::size_t>(first.size(), 3));
    report(Severity::note, std::string(raw_files_folder), "only files that a manifest names",
           fmt::format("{} other files: {}{}", others.size(), fmt::join(first, ", "),
                       others.size() > first.size() ? ", ..." : ""));
  }

  // Reads all files that the steps before have noted, in parallel. The lock protects progress and
  // findings.
  Result<void> check_hashes() {
    std::uint64_t all = 0;
    for (const ToHash& one : hashes_) all += one.bytes;
    std::mutex mutex;
    std::uint64_t done = 0;
    bool is_stopped = false;
    parallel_for(hashes_.size(), options_.jobs, [&](std::size_t i) {
      const ToHash& one = hashes_[i];
      std::uint64_t before = 0;
      const Progress part = [&](std::string_view, std::uint64_t so_far, std::uint64_t) {
        const std::lock_guard lock(mutex);
        // Several files are read at the same time, so each adds its own progress.
        done += so_far - before;
        before = so_far;
        is_stopped = is_stopped || !go_on(progress_, "hashing", done, all);
        return !is_stopped;
      };
      const auto facts = facts_of(files_, one.path, "hashing", part);
      const std::lock_guard lock(mutex);
      if (facts) out_.bytes += facts->bytes;
      if (facts && facts->sha256 == one.sha256) return;
      if (!facts && is_interruption(facts.error())) return;
      report(Severity::error, one.name,
             one.name.ends_with(".toml") ? "the raw file that the take was made from: " + one.path
                                         : "bytes with SHA-256 " + one.sha256.substr(0, 12) + "...",
             facts ? "SHA-256 " + facts->sha256.substr(0, 12) + "..." : facts.error().found);
    });
    // All takes count, also those with findings.
    out_.takes = takes_.size();
    return is_stopped ? Failure(interruption()) : Result<void>{};
  }

  FileSystem& files_;
  const std::string& folder_;
  const Catalogue& catalogue_;
  const VerifyOptions& options_;
  const Progress& progress_;
  std::map<TakeName, TakeFiles> takes_;
  std::map<TakeName, TakeSummary> summaries_;
  std::vector<ToHash> hashes_;
  Verified out_;
};

}  // namespace

void sort_findings(Findings& findings) {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return a.severity != b.severity ? a.severity > b.severity : a.what.file < b.what.file;
  });
}

Result<Verified> verify(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                        const VerifyOptions& options, const Progress& progress) {
  return Verifier(files, folder, catalogue, options, progress).run();
}

}  // namespace kinalign
