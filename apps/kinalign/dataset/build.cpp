// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/build.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/dataset/share.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// The options of `kinalign dataset build`. On a cluster, environment variables and no flag say
/// which part of the takes this process builds.
struct Build {
  std::vector<std::string> folder;  // one word
  bool all = false;
  std::int64_t index_offset = 0;  // added to the job's number in a Slurm array
};

Usage describe_build(Build& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {{"all", "make every take again", &o.all},
                 {"index_offset",
                  "added to the job's number in a Slurm array, because these numbers are limited",
                  &o.index_offset, 0.0, 1e9}};
  return usage;
}

/// The reason why a take is built, in words. Text and JSON use the same words, since programs may
/// depend on them.
std::string_view words_of(BuildReason reason) {
  switch (reason) {
    case BuildReason::first:
      return "new";
    case BuildReason::changed_parameters:
      return "its parameters changed";
    case BuildReason::changed_inputs:
      return "its raw files changed";
    case BuildReason::asked:
      return "--all";
    case BuildReason::no_summary:
      return "no summary yet";
    case BuildReason::up_to_date:
      break;
  }
  return "up to date";
}

/// Prints the plan of --dry-run: the takes that would be built, the longest first. Takes that are
/// up to date are not listed.
Result<int> show_plan(const BuildPlan& plan, Call& call) {
  auto json = nlohmann::ordered_json::array();
  for (const BuildJob& job : plan.jobs) {
    call.console.print(fmt::format("{}  {}\n", to_string(job.name), words_of(job.reason)));
    json.push_back({{"name", to_string(job.name)},
                    {"reason", words_of(job.reason)},
                    {"bytes", job.input_bytes}});
  }
  call.console.print(fmt::format("{} to make, {} up to date\n", counted(plan.jobs.size(), "take"),
                                 plan.up_to_date));
  call.console.print_json(
      nlohmann::ordered_json{{"to_make", json}, {"up_to_date", plan.up_to_date}}.dump());
  return 0;
}

/// Counts the built takes. `usable` and `bad` count only the takes built in this run. The JSON
/// lists every take, in the order in which the takes were finished.
struct Tally {
  std::size_t made = 0, failed = 0, usable = 0, bad = 0;
  nlohmann::ordered_json takes = nlohmann::ordered_json::array();

  void add(const Built& one, Console& console) {
    const std::string name = to_string(one.name);
    // A take that can't be built gets one line. The other takes are still built, and the exit code
    // is 1.
    if (!one.summary) {
      ++failed;
      console.print(
          harmless(fmt::format("failed  {}: {}\n", name, to_string(one.summary.error()))));
      takes.push_back({{"name", name}, {"failed", to_string(one.summary.error())}});
      return;
    }
    ++made;
    usable += one.summary->quality == Quality::usable ? 1 : 0;
    bad += one.summary->quality == Quality::bad ? 1 : 0;
    // A build may have thousands of takes, so good ones are listed only with --verbose.
    console.detail(
        fmt::format("{}: {} frames, {}", name, one.summary->frames, one.summary->verdict()));
    takes.push_back(
        {{"name", name}, {"frames", one.summary->frames}, {"verdict", one.summary->verdict()}});
  }
};

/// Builds the takes that fall to this process. Only a process that builds all takes updates the
/// index.
Result<int> run_build(Build& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string folder = folder_of(o.folder);
  const Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  // share_of() reads the environment variables of a cluster. Without them this process builds all
  // takes.
  const BuildOptions options{call.jobs,
                             KA_TRY(share_of(call.surroundings.variable, o.index_offset)), o.all};
  Tally tally;
  // The build calls both functions from its threads, but never two at the same time. The tally
  // therefore needs no lock.
  const BuildWatch watch{call.console.progress(),
                         [&](const Built& one) { tally.add(one, call.console); }};
  const BuildPlan plan = KA_TRY(plan_build(files, folder, catalogue, options, watch.progress));
  if (call.common.dry_run) return show_plan(plan, call);
  KA_TRY(build(files, folder, catalogue, plan, watch));
  // Several processes would write the index at the same time, so they leave it. The next verb that
  // opens the index reads the new summaries.
  if (options.share.size == 1) KA_TRY(open_index(folder, call));
  const std::string share =
      options.share.size == 1
          ? ""
          : fmt::format(", share {} of {}", options.share.rank + 1, options.share.size);
  call.console.print(harmless(fmt::format(
      "{}: {} made{}, {} up to date{}\n", folder, counted(tally.made, "take"),
      tally.failed > 0 ? fmt::format(", {} failed", tally.failed) : "", plan.up_to_date, share)));
  // The last line is a command that lists the takes to look at, the worst first.
  if (tally.bad + tally.usable > 0) {
    call.console.print(
        fmt::format("  {} bad, {} usable: kinalign dataset list {} --columns name,verdict,worst "
                    "--sort verdict\n",
                    tally.bad, tally.usable, harmless(folder)));
  }
  call.console.print(fmt::format("see    kinalign dataset tables {}\n", harmless(folder)));
  call.console.print_json(json_text(nlohmann::ordered_json{{"made", tally.made},
                                                           {"failed", tally.failed},
                                                           {"up_to_date", plan.up_to_date},
                                                           {"takes", tally.takes}},
                                    1));
  return tally.failed > 0 ? 1 : 0;
}

}  // namespace

/// The verb `kinalign dataset build`.
Verb dataset_build_verb() {
  return make_verb<Build>(
      {.name = "dataset build",
       .summary = "align all new or changed takes of a data set",
       .text = "A take is made again if its manifest, [align] of dataset.toml or the bytes of a "
               "raw file changed. The same command continues a stopped build. Under Slurm or MPI "
               "each process makes its share (docs/formats/dataset.md).",
       .examples = {{"kinalign dataset build walks", "with all processors"},
                    {"kinalign dataset build walks --dry-run",
                     "prints what would be made, and why"},
                    {"srun -n 8 kinalign dataset build walks --jobs 1",
                     "eight processes on a cluster"}},
       .common = {"json", "dry_run", "jobs"}},
      describe_build, run_build);
}

}  // namespace kinalign
