// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/json_text.h"
#include "apps/kinalign/benchmark/twin_maker.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/core/parallel.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/twin/twin_actions.h"
#include "kinalign/view/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <iterator>
#include <mutex>
#include <set>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The path of the plan, relative to the folder of the simulated data set (the twin). The plan
/// identifies a twin: making is continued only in a folder whose plan has the same bytes.
constexpr const char* plan_file = "truth/twin.json";
constexpr std::size_t longest_plan = std::size_t{16} << 20;

/// The options of `kinalign benchmark twin`. Scale, seed and motions determine every byte of the
/// takes.
struct TwinVerb {
  double scale = 0.02;
  std::int64_t seed = 1;
  std::string motion;

  TwinOptions options() const { return {scale, static_cast<std::uint64_t>(seed)}; }
};

/// The command line of `kinalign benchmark twin`.
Usage describe_twin(TwinVerb& o) {
  Usage usage;
  usage.flags = {
      {"scale", "fraction of the paper's frames; 1: 13.7 hours of motion", &o.scale, 1e-6, 1.0},
      {"seed", "seed of all random numbers", &o.seed, 0.0, 9e15},
      text_flag("motion", "BVH files of a Perception Neuron or CMU skeleton for every second take",
                &o.motion, "FOLDER")};
  usage.check = [](const Common& common, const Sources&) -> Result<void> {
    return check_out(common, {}, "-o FOLDER for the data set");
  };
  return usage;
}

/// Everything that is needed to make all takes. The number of a take is its index in `takes`. `o`
/// must live longer than the job.
struct TwinJob {
  const TwinVerb& o;
  std::string folder;
  std::vector<TwinTake> takes;
  std::vector<std::string> motions;  // paths of BVH files
  std::string plan;                  // the text of the plan
};

/// The BVH files of a folder, sorted by name. Fails if there is none.
Result<std::vector<std::string>> motions_in(const std::string& folder) {
  std::vector<std::string> out;
  if (folder.empty()) return out;
  const std::string below = folder + "/";
  for (const std::string& name : KA_TRY(names_in_folder(folder))) {
    // Names are sorted, so the motion of a take does not depend on the file system.
    if (name.ends_with(".bvh") || name.ends_with(".BVH")) out.push_back(below + name);
  }
  if (!out.empty()) return out;
  return Failure(Error{folder, 0, "a folder with BVH files", "no BVH file"});
}

/// The nearest existing folder on a path. A new folder will be on the same disk.
fs::path folder_that_is_there(fs::path path) {
  std::error_code fault;
  path = fs::absolute(path, fault);
  while (!fs::exists(path, fault) && path.has_relative_path()) path = path.parent_path();
  return path;
}

/// The free bytes on the disk of a folder that may not exist yet. 0 if they are not known.
std::uint64_t free_bytes(const std::string& folder) {
  std::error_code fault;
  const auto space = fs::space(folder_that_is_there(folder), fault);
  return fault ? 0 : space.available;
}

/// Fails if the folder contains anything but the same twin, or if the disk has too little room.
Result<void> check_folder(const TwinJob& job, Call& call) {
  std::error_code fault;
  const std::string path = job.folder + "/" + plan_file;
  // The same twin is continued. Its disk space is not checked, because only a part of it may be
  // missing.
  if (is_there(path)) {
    if (KA_TRY(read_whole(call.surroundings.files, path, longest_plan)) == job.plan) return {};
    return Failure(
        Error{path, 0, "a twin with the same scale, seed and motions", "a twin with other values"});
  }
  // If an earlier run was stopped before it wrote its plan, there is only the empty folder truth/.
  const bool is_begun = fs::is_empty(job.folder + "/truth", fault) &&
                        std::distance(fs::directory_iterator(job.folder, fault), {}) == 1;
  if (is_there(job.folder) && !fs::is_empty(job.folder, fault) && !is_begun) {
    return Failure(
        Error{job.folder, 0, "a new folder, or an unfinished twin", "a folder with other files"});
  }
  const std::uint64_t wanted = bytes_of(job.takes), there = free_bytes(job.folder);
  // If the free space is not known, the run goes on.
  if (there == 0 || wanted < there) return {};
  return Failure(Error{job.folder, 0, size_text(wanted) + " of free disk space", size_text(there)});
}

/// Makes the folders, the plan and dataset.toml. Existing files stay, so that a run that was
/// stopped can continue.
Result<void> begin_folder(const TwinJob& job, FileSystem& files) {
  KA_TRY(make_folders(job.folder + "/truth"));
  // The plan is written first, because check_folder() continues only a folder with a plan.
  const std::string plan = job.folder + "/" + plan_file;
  if (!is_there(plan)) KA_TRY(write_whole(files, plan, job.plan, Overwrite::no));
  KA_TRY(make_folders(job.folder + "/splits"));
  const std::string catalogue = job.folder + "/" + std::string(catalogue_file);
  if (is_there(catalogue)) return {};
  // The data set is named after its folder, even if the user typed "." or "..".
  std::error_code fault;
  const std::string name = fs::weakly_canonical(job.folder, fault).filename().string();
  return write_whole(files, catalogue, KA_TRY(twin_catalogue(name)), Overwrite::no);
}

/// The takes that were made from a plan, and those that failed.
struct TwinMade {
  TwinCounts counts;
  std::uint64_t made = 0, were_there = 0, bytes = 0;
  std::vector<std::pair<TakeName, Error>> failed;

  void add(const TwinTake& take, const TakeSummary& summary) {
    count(take, summary.frames, counts);
    bytes += summary.bytes;
  }
};

/// Makes the missing takes in several threads. If a take fails, the others are still made. The lock
/// `output` protects the progress, the counts and the list of failures.
Result<TwinMade> make_takes(const TwinJob& job, const Catalogue& catalogue, Call& call) {
  TwinMaker maker({call.surroundings.files, job.folder, catalogue, job.motions});
  const Progress progress = call.console.progress();
  TwinMade out;
  std::vector<std::size_t> missing;  // their indices in the plan
  std::uint64_t all = 0, done = 0;   // frames
  for (std::size_t number = 0; number < job.takes.size(); ++number) {
    const TwinTake& take = job.takes[number];
    // An existing take is not made again, so that a run that was stopped can continue.
    if (const auto known = maker.known(take)) {
      ++out.were_there;
      out.add(take, *known);
    } else {
      missing.push_back(number);
      all += take.frames;
    }
  }
  // Only one thread at a time may call the progress function.
  std::mutex output;
  bool stopped = false;
  const auto is_wanted = [&](std::uint64_t frames) {
    const std::lock_guard lock(output);
    done += frames;
    // Once `stopped` is true, it stays true, and all threads end at their next call.
    stopped = stopped || !go_on(progress, "making takes", done, all);
    return !stopped;
  };
  parallel_for(missing.size(), call.jobs, [&](std::size_t i) {
    if (!is_wanted(0)) return;
    const TwinTake& take = job.takes[missing[i]];
    const auto summary =
        maker.make(take, missing[i],
                   // Within a take this function only asks whether to go on. The frames are counted
                   // when the take is finished.
                   [&](std::string_view, std::uint64_t, std::uint64_t) { return is_wanted(0); });
    // After Ctrl-C the take fails, too; that is no fault of the take.
    if (!is_wanted(take.frames) && !summary) return;
    const std::lock_guard lock(output);
    if (summary) {
      ++out.made;
      out.add(take, *summary);
    } else {
      out.failed.emplace_back(take.name, summary.error());
    }
  });
  std::error_code ignored;
  // The devices' files of takes that failed or were stopped lie in this folder and are removed with
  // it.
  fs::remove_all(job.folder + "/" + std::string(cache_folder) + "/twin", ignored);
  if (stopped) return Failure(interruption());
  return out;
}

/// Writes the splits of a twin. Existing files stay.
Result<std::vector<std::string>> write_splits(const TwinJob& job, const DatasetIndex& index,
                                              Call& call) {
  FileSystem& files = call.surroundings.files;
  const auto takes = KA_TRY(built_takes(files, job.folder, index, ""));
  std::vector<std::string> out;
  for (const auto& [file, by] :
       // The first word is the name of the file. The second word is the rule by which make_split()
       // divides the takes.
       {std::pair("people", "subject"), std::pair("denoise", "hfut-denoise"),
        std::pair("imu", "hfut-imu")}) {
    const std::string name = std::string("splits/") + file + ".json",
                      path = job.folder + "/" + name;
    // A split that can't be made is left out; the data set is complete without it.
    const auto split = make_split(takes, index.catalogue(), {.by = by, .seed = job.o.seed});
    if (!split) continue;  // a small twin may have too few takes
    // Models may have been trained with an existing split, so it is kept.
    if (!is_there(path)) {
      KA_TRY(write_whole(files, path, split_json(*split, takes), Overwrite::no));
    }
    out.push_back(name);
  }
  return out;
}

double hours_of(std::uint64_t frames) {
  return static_cast<double>(frames) / twin_rate_hz / 3600.0;
}

/// The number of takes by devices: "mocap + Kinect 13 takes, mocap + IMU 1 take, all three 10
/// takes". A method needs takes with certain devices.
std::string pairs_text(const TwinCounts& counts) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < device_choices.size(); ++i) {
    words.push_back(fmt::format("{} {}", device_choices[i], counted(counts.takes[i], "take")));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

Json json_of(const TwinCounts& counts) {
  const ModalityFrames sum = counts.sum();
  Json takes;
  for (std::size_t i = 0; i < device_choices.size(); ++i) {
    takes[std::string(device_choices[i])] = counts.takes[i];
  }
  return {{"frames", {{"mocap", sum.mocap}, {"kinect", sum.kinect}, {"imu", sum.imu}}},
          {"takes_by_devices", takes}};
}

/// An empty table with columns for three counts: of the HFUT-MMD paper, of the plan, and of the
/// takes made.
Table table_with(const std::string& key, const std::string& caption) {
  Table table;
  table.caption = caption;
  table.has_sum = true;
  table.columns = {{key, key}};
  for (const std::string whose : {"paper", "asked", "made"}) {
    // For people only the first of three titles names the origin; for programs each key names it.
    table.columns.push_back({whose + "_mocap", whose + ": mocap"});
    table.columns.push_back({whose + "_kinect", "Kinect"});
    table.columns.push_back({whose + "_imu", "IMU"});
  }
  return table;
}

void add_row(const std::string& name, const std::vector<ModalityFrames>& values, Table& table) {
  std::vector<Cell> row{name};
  for (const ModalityFrames& one : values) {
    for (const std::uint64_t frames : {one.mocap, one.kinect, one.imu}) {
      row.emplace_back(static_cast<std::int64_t>(frames));
    }
  }
  table.rows.push_back(std::move(row));
}

/// The ids of the people in one row of table 6 in the HFUT-MMD paper, as that table writes them.
std::string ids_of(const PaperPeople& people) {
  return fmt::format(
      "{}", fmt::join(people.ids.begin(),
                      people.ids.begin() + static_cast<std::ptrdiff_t>(people.count()), ", "));
}

/// The numbers of frames by people (table 6 of the HFUT-MMD paper), by classes (table 7) and by
/// devices. Each table compares the paper, the plan and the takes made, because a small plan can't
/// meet the paper's numbers exactly.
std::vector<Table> twin_tables(double scale, const TwinCounts& made) {
  // With a scale of 1 paper_counts() returns the numbers of the HFUT-MMD paper.
  const TwinCounts paper = paper_counts(1.0), asked = paper_counts(scale);
  Table people = table_with("people", "Frames by people (the paper's table 6)");
  for (std::size_t i = 0; i < paper_people.size(); ++i) {
    add_row(ids_of(paper_people[i]), {paper.people[i], asked.people[i], made.people[i]}, people);
  }
  Table classes = table_with("class", "Frames by classes (the paper's table 7)");
  for (std::size_t i = 0; i < paper_classes.size(); ++i) {
    add_row(std::string(paper_classes[i].id), {paper.classes[i], asked.classes[i], made.classes[i]},
            classes);
  }
  Table choices = table_with("devices", "Frames by devices that recorded together");
  for (std::size_t i = 0; i < device_choices.size(); ++i) {
    add_row(std::string(device_choices[i]), {paper.choices[i], asked.choices[i], made.choices[i]},
            choices);
  }
  std::vector<Table> out{std::move(people), std::move(classes), std::move(choices)};
  // The last row of each table is the sum, which is the same in all three.
  for (Table& table : out) add_row("sum", {paper.sum(), asked.sum(), made.sum()}, table);
  return out;
}

std::string tables_text(const std::vector<Table>& tables) {
  std::string text;
  for (const Table& table : tables) text += written(table, TableFormat::text) + "\n";
  return text;
}

/// Prints the plan of --dry-run with the disk space that it needs. The frames of the plan are
/// counted like those of finished takes.
Result<int> show_twin_plan(const TwinJob& job, Call& call) {
  TwinCounts counts;
  for (const TwinTake& take : job.takes) count(take, take.frames, counts);
  call.console.print(tables_text(twin_tables(job.o.scale, counts)));
  call.console.print(harmless(fmt::format(
      "{}: {} to make, {:.2f} h\n  pairs  {}\n  disk   about {}; {} free\n", job.folder,
      counted(job.takes.size(), "take"), hours_of(counts.sum().mocap), pairs_text(counts),
      size_text(bytes_of(job.takes)), size_text(free_bytes(job.folder)))));
  Json json = json_of(counts);
  json["to_make"] = job.takes.size();
  json["bytes"] = bytes_of(job.takes);
  call.console.print_json(json.dump());
  return 0;
}

/// Prints the tables and counts of a finished twin.
void print_made(const TwinJob& job, const TwinMade& made, const std::vector<std::string>& splits,
                Call& call) {
  std::set<std::string> people, actions;
  for (const TwinTake& take : job.takes) {
    people.insert(take.name.subject);
    actions.insert(take.name.action);
  }
  call.console.print(tables_text(twin_tables(job.o.scale, made.counts)));
  call.console.print(harmless(fmt::format(
      "{}: {}, {:.2f} h, {}{}\n  people  {}, {}\n  pairs   {}\n  splits  {}\n"
      // The last line is a command that works on the new data set.
      "  next    kinalign eval raw offset ridge --data {} -o results --folds people\n",
      job.folder, counted(made.made + made.were_there, "take"), hours_of(made.counts.sum().mocap),
      size_text(made.bytes),
      made.were_there > 0 ? fmt::format("; {} existed before", made.were_there) : "",
      counted(people.size(), "person", "people"), counted(actions.size(), "action"),
      pairs_text(made.counts), splits.empty() ? "none" : fmt::format("{}", fmt::join(splits, ", ")),
      job.folder)));
  // Each failed take is listed with the reason. The same command tries these takes again.
  for (const auto& [name, error] : made.failed) {
    call.console.print(
        harmless(fmt::format("failed  {}: {}\n", to_string(name), to_string(error))));
  }
  Json json = json_of(made.counts);
  json["made"] = made.made;
  json["were_there"] = made.were_there;
  json["failed"] = made.failed.size();
  json["people"] = people.size();
  json["bytes"] = made.bytes;
  json["splits"] = splits;
  call.console.print_json(json_text(json, 1));
}

/// The plan depends on the options and on the names of the motion files, not on their content.
Result<TwinJob> job_of(const TwinVerb& o, const Call& call) {
  auto motions = KA_TRY(motions_in(o.motion));
  TwinJob job{o, folder_of({call.common.out}), plan_twin(o.options()), std::move(motions), ""};
  std::vector<std::string> names;
  for (const std::string& path : job.motions) names.emplace_back(file_name(path));
  job.plan = twin_json(o.options(), names, job.takes);
  return job;
}

/// Makes a twin. All checks come before the folder is made.
Result<int> run_twin(TwinVerb& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  call.console.advise("nothing was written");
  const TwinJob job = KA_TRY(job_of(o, call));
  KA_TRY(check_folder(job, call));
  if (call.common.dry_run) return show_twin_plan(job, call);
  call.console.detail(fmt::format("{} to make: about {}", counted(job.takes.size(), "take"),
                                  size_text(bytes_of(job.takes))));
  // Files exist from here on, so the advice "nothing was written" would be wrong.
  call.console.advise("run the same command again to continue");
  KA_TRY(begin_folder(job, files));
  const std::string path = job.folder + "/" + std::string(catalogue_file);
  const Catalogue catalogue =
      // dataset.toml is read from the disk, because begin_folder() keeps an existing one.
      KA_TRY(read_catalogue(KA_TRY(read_whole(files, path, longest_manifest)), path));
  const TwinMade made = KA_TRY(make_takes(job, catalogue, call));
  const DatasetIndex index = KA_TRY(open_index(job.folder, call));
  const auto splits = KA_TRY(write_splits(job, index, call));
  print_made(job, made, splits, call);
  return made.failed.empty() ? 0 : 1;
}

}  // namespace

/// The verb `kinalign benchmark twin`.
Verb benchmark_twin_verb() {
  return make_verb<TwinVerb>(
      {.name = "benchmark twin",
       .summary = "a simulated twin of the paper's data set",
       .text = "Makes a data set of the paper's 12 people, 6 classes and combinations of devices, "
               "each take by simulation and alignment. --scale is the fraction of the paper's "
               "frames. With --motion every second take has a recorded motion on the body of its "
               "person. The same seed gives the same takes. The same command continues a stopped "
               "job. --dry-run prints the disk space needed.",
       .examples = {{"kinalign benchmark twin --scale 0.01 -o twin",
                     "10 minutes of motion, then: kinalign eval raw offset ridge --data twin -o "
                     "results"},
                    {"kinalign benchmark twin --scale 1 -o whole --dry-run",
                     "the disk space for as much data as the paper has"}},
       .common = {"out", "json", "dry_run", "jobs"},
       .out_is_folder = true},
      describe_twin, run_twin);
}

}  // namespace kinalign
