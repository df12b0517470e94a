// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/build.h"

#include "kinalign/align/align.h"
#include "kinalign/core/file_version.h"
#include "kinalign/core/parallel.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/summarise.h"
#include "kinalign/dataset/take_inputs.h"
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/sources/open_recording.h"

#include <algorithm>
#include <mutex>
#include <optional>

namespace kinalign {

namespace {

/// A take of the data set that may have to be made.
struct Candidate {
  TakeName name;
  TakeFiles files;
  Manifest manifest;  // empty for a take without a manifest
  std::vector<TakeInput> inputs;
  std::optional<TakeSummary> summary;
  std::uint64_t bytes = 0;  // size of the inputs; the take's own size if it has none
};

/// Finds the reason why a take has to be made again, and the size of its inputs.
class Planner {
 public:
  Planner(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
          const BuildOptions& options, const Progress& progress)
      : files_(files),
        folder_(folder),
        catalogue_(catalogue),
        options_(options),
        progress_(progress) {}

  /// A take with the size of its inputs.
  Result<Candidate> look(const TakeName& name, const TakeFiles& there) const {
    Candidate out{name, there, {}, {}, there.summary ? known(name) : std::nullopt, 0};
    if (!there.manifest) {  // it was added without raw files
      out.bytes = size_of(path_of(folder_, name, TakeFile::take));
      return out;
    }
    out.manifest = KA_TRY(take_manifest(files_, folder_, catalogue_, name));
    // The inputs also include files that only the summary names, such as further files of a reader.
    out.inputs = inputs_of(files_, out.manifest, folder_of(folder_, name),
                           out.summary ? out.summary->inputs : std::vector<InputFacts>{});
    for (const TakeInput& input : out.inputs) out.bytes += size_of(input.path);
    return out;
  }

  // The checks that take the least time come first: files, parameters, size. The hashes of inputs
  // come last.
  Result<BuildReason> judge(const Candidate& one) const {
    // A take without a manifest can't be made again. At most its summary is missing.
    if (!one.files.manifest) {
      // Only the size is compared here. The command `verify` reads every byte.
      const bool same = one.summary && one.summary->bytes == one.bytes;
      return same ? BuildReason::up_to_date : BuildReason::no_summary;
    }
    if (!one.summary || !one.files.take) return BuildReason::first;
    // With the option `all`, every take that can be made is made.
    if (options_.all) return BuildReason::asked;
    if (recipe_of(one.manifest) != one.summary->recipe) return BuildReason::changed_parameters;
    // If the size differs, the take was replaced or truncated, so its summary is not valid any
    // more.
    if (size_of(path_of(folder_, one.name, TakeFile::take)) != one.summary->bytes) {
      return BuildReason::first;
    }
    // Inputs that are older than the summary have not changed since the take was made.
    const auto made = version_of(path_of(folder_, one.name, TakeFile::summary));
    const bool same = KA_TRY(
        same_inputs(files_, one.inputs, *one.summary, made ? made->changed_ns : 0, progress_));
    return same ? BuildReason::up_to_date : BuildReason::changed_inputs;
  }

 private:
  // The size of a file, bytes; 0 if it can't be found.
  static std::uint64_t size_of(const std::string& path) {
    const auto version = version_of(path);
    return version ? version->size : 0;
  }

  std::optional<TakeSummary> known(const TakeName& name) const {
    auto summary = read_summary(files_, folder_, name);
    return summary ? std::optional(*std::move(summary)) : std::nullopt;
  }

  FileSystem& files_;
  const std::string& folder_;
  const Catalogue& catalogue_;
  const BuildOptions& options_;
  const Progress& progress_;
};

/// Sums up the progress of all jobs in bytes of their inputs.
class BuildProgress {
 public:
  BuildProgress(const Progress& progress, const std::vector<BuildJob>& jobs)
      : progress_(progress), done_(jobs.size(), 0) {
    for (const BuildJob& job : jobs) all_ += job.input_bytes;
  }

  /// The progress of job i: reading is the first half, aligning the second.
  Progress part(std::size_t i, std::uint64_t bytes) {
    return [this, i, bytes](std::string_view what, std::uint64_t done, std::uint64_t total) {
      // If the length of a pass is not known, the pass counts as not begun.
      const double share =
          total == 0 ? 0.0 : static_cast<double>(done) / static_cast<double>(total);
      const double half = what == "aligning" ? 0.5 + 0.5 * share : 0.5 * share;
      return reach(i, static_cast<std::uint64_t>(half * static_cast<double>(bytes)));
    };
  }

  /// Adds the progress of job i. Returns false if the user stops the build.
  bool reach(std::size_t i, std::uint64_t bytes) {
    // Several threads call this function, and they share the sum and the user's callback.
    const std::lock_guard lock(mutex_);
    // Reading starts at 0 for each file, but the progress of a job must never decrease.
    sum_ += bytes - std::min(bytes, done_[i]);
    done_[i] = std::max(bytes, done_[i]);
    // When the user stops the build, each thread learns it at its next call.
    stopped_ = stopped_ || !go_on(progress_, "building", sum_, all_);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const Progress& progress_;
  std::mutex mutex_;
  std::vector<std::uint64_t> done_;
  std::uint64_t sum_ = 0, all_ = 0;
  bool stopped_ = false;
};

/// The summary of a take that was added without raw files. A child process reads the take, so no
/// other thread may run yet.
Result<TakeSummary> summarised(FileSystem& files, const std::string& folder, const TakeName& name) {
  return keep_summary(files, folder, name, KA_TRY(summarise_takes(files, folder, {name}).front()));
}

}  // namespace

Result<TakeSummary> TakeMaker::make(const TakeName& name, const Manifest& manifest,
                                    const std::string& base, const Progress& progress) {
  // Each take is made in one thread, because several takes are made at once.
  const Recording recording =
      KA_TRY(open_recording(files_, manifest, base, {progress, 1, nullptr}));
  const std::string path = path_of(folder_, name, TakeFile::take);
  std::optional<TakeWriter> writer;
  TakeHeader header;
  TakeSink sink;
  // The writer needs the take's header, which the aligner knows only after planning.
  sink.begin = [&](const TakeHeader& of_take) -> Result<void> {
    header = of_take;
    const std::lock_guard lock(hdf5_);
    writer.emplace(KA_TRY(TakeWriter::create(files_, path, Overwrite::yes, header)));
    return {};
  };
  sink.rows = [&](const TakeSlab& slab) { return writer->append(slab); };
  const AlignmentReport report = KA_TRY(align(recording, manifest, sink, progress, 1));
  {
    const std::lock_guard lock(hdf5_);
    // The file gets its final name only here, so an interrupted run leaves no incomplete take.
    KA_TRY(writer->finish(report));
  }
  TakeSummary summary = KA_TRY(summary_of(header, report_json(report)));
  // This program has made the take.
  summary.software = take_software();
  return keep_summary(files_, folder_, name, std::move(summary));
}

Result<Manifest> take_manifest(FileSystem& files, const std::string& folder,
                               const Catalogue& catalogue, const TakeName& name) {
  const std::string path = path_of(folder, name, TakeFile::manifest);
  Manifest manifest = KA_TRY(read_manifest(KA_TRY(read_whole(files, path, longest_manifest)),
                                           path_of(name, TakeFile::manifest), catalogue.align));
  // Subject and action come from the take's name, even if the manifest states others.
  manifest.subject = name.subject;
  manifest.action = name.action;
  return manifest;
}

Result<BuildPlan> plan_build(FileSystem& files, const std::string& folder,
                             const Catalogue& catalogue, const BuildOptions& options,
                             const Progress& progress) {
  const Planner planner(files, folder, catalogue, options, progress);
  std::vector<Candidate> takes;
  for (const auto& [name, there] : KA_TRY(scan_takes(folder))) {
    auto looked = planner.look(name, there);
    // A faulty manifest is reported when its take is made, so that other takes are still made.
    takes.push_back(looked ? *std::move(looked) : Candidate{name, there, {}, {}, {}, 0});
  }
  // The longest takes are made first. Short takes at the end keep all threads busy.
  std::stable_sort(takes.begin(), takes.end(),
                   [](const Candidate& a, const Candidate& b) { return a.bytes > b.bytes; });
  std::vector<std::uint64_t> loads(options.share.size, 0);
  BuildPlan plan;
  plan.at_once = options.jobs;
  // The number of takes compared so far, for the progress.
  std::uint64_t seen = 0;
  for (const Candidate& one : takes) {
    const auto least = std::min_element(loads.begin(), loads.end());
    // Each take counts one byte more than its size, so that takes of unknown size are shared
    // evenly, too.
    *least += one.bytes + 1;
    // Only this process's share is compared, because comparing may mean hashing large files.
    if (static_cast<std::size_t>(least - loads.begin()) != options.share.rank) continue;
    const BuildReason reason = KA_TRY(planner.judge(one));
    if (!go_on(progress, "comparing", ++seen, takes.size())) return Failure(interruption());
    if (reason == BuildReason::up_to_date) {
      ++plan.up_to_date;
    } else {
      plan.jobs.push_back({one.name, one.bytes, reason});
    }
  }
  return plan;
}

Result<void> build(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                   const BuildPlan& plan, const BuildWatch& watch) {
  const std::vector<BuildJob>& jobs = plan.jobs;
  TakeMaker maker(files, folder);
  const auto make = [&](const BuildJob& job, const Progress& progress) -> Result<TakeSummary> {
    const Manifest manifest = KA_TRY(take_manifest(files, folder, catalogue, job.name));
    return maker.make(job.name, manifest, folder_of(folder, job.name), progress);
  };
  BuildProgress all(watch.progress, jobs);
  for (std::size_t i = 0; i < jobs.size() && !all.stopped(); ++i) {
    // Takes that only lack a summary come first, while no other thread runs.
    if (jobs[i].reason != BuildReason::no_summary) continue;
    watch.done({jobs[i].name, summarised(files, folder, jobs[i].name)});
    all.reach(i, jobs[i].input_bytes);
  }
  // Finished takes are reported one at a time.
  std::mutex telling;
  parallel_for(jobs.size(), plan.at_once, [&](std::size_t i) {
    if (all.stopped() || jobs[i].reason == BuildReason::no_summary) return;
    Built built{jobs[i].name, make(jobs[i], all.part(i, jobs[i].input_bytes))};
    all.reach(i, jobs[i].input_bytes);
    // A take that was interrupted counts as neither made nor failed.
    if (!built.summary && is_interruption(built.summary.error())) return;
    const std::lock_guard lock(telling);
    watch.done(built);
  });
  return all.stopped() ? Failure(interruption()) : Result<void>{};
}

}  // namespace kinalign
