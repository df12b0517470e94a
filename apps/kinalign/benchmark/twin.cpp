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

/// The path of the plan, relative to the twin's folder.
/// The plan's text is the identity of a twin: a folder is continued only if its plan is the same,
/// byte for byte.
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

/// The input for making all takes.
/// `o` must outlive the job. Takes have the order of the plan, and their index is their number.
struct TwinJob {
  const TwinVerb& o;
  std::string folder;
  std::vector<TwinTake> takes;
  std::vector<std::string> motions;  // paths of BVH files
  std::string plan;                  // the content of the plan's file
};

/// The BVH files of a folder, sorted by name. Fails if there is none.
Result<std::vector<std::string>> motions_in(const std::string& folder) {
  std::vector<std::string> out;
  if (folder.empty()) return out;
  const std::string below = folder + "/";
  for (const std::string& name : KA_TRY(names_in_folder(folder))) {
    // Names come sorted, so the take that gets a motion does not depend on the file system.
    if (name.ends_with(".bvh") || name.ends_with(".BVH")) out.push_back(below + name);
  }
  if (!out.empty()) return out;
  return Failure(Error{folder, 0, "a folder with BVH files", "no BVH file"});
}

/// The nearest parent folder of a path that exists.
/// The disk of a folder that does not exist yet is that of its nearest existing parent.
fs::path folder_that_is_there(fs::path path) {
  std::error_code fault;
  path = fs::absolute(path, fault);
  while (!fs::exists(path, fault) && path.has_relative_path()) path = path.parent_path();
  return path;
}

/// The free bytes on the disk of a folder that may not exist yet; 0 if they are not known.
std::uint64_t free_bytes(const std::string& folder) {
  std::error_code fault;
  const auto space = fs::space(folder_that_is_there(folder), fault);
  return fault ? 0 : space.available;
}

/// Fails if the folder holds anything but the same twin, or if the disk is too small.
Result<void> check_folder(const TwinJob& job, Call& call) {
  std::error_code fault;
  const std::string path = job.folder + "/" + plan_file;
  // A twin that is there already is continued. No space is checked then: only a part of it may be
  // missing.
  if (is_there(path)) {
    if (KA_TRY(read_whole(call.surroundings.files, path, longest_plan)) == job.plan) return {};
    return Failure(
        Error{path, 0, "a twin with the same scale, seed and motions", "a twin with other values"});
  }
  // A job that was stopped before it wrote its plan has made only this folder.
  const bool is_begun = fs::is_empty(job.folder + "/truth", fault) &&
                        std::distance(fs::directory_iterator(job.folder, fault), {}) == 1;
  if (is_there(job.folder) && !fs::is_empty(job.folder, fault) && !is_begun) {
    return Failure(
        Error{job.folder, 0, "a new folder, or an unfinished twin", "a folder with other files"});
  }
  const std::uint64_t wanted = bytes_of(job.takes), there = free_bytes(job.folder);
  // An unknown amount of free space must not stop the job.
  if (there == 0 || wanted < there) return {};
  return Failure(Error{job.folder, 0, size_text(wanted) + " of free disk space", size_text(there)});
}

/// Makes the folders, the plan and dataset.toml. Existing files stay, since a stopped job
/// continues.
Result<void> begin_folder(const TwinJob& job, FileSystem& files) {
  KA_TRY(make_folders(job.folder + "/truth"));
  // The plan is written first. check_folder() continues only a folder that has it.
  const std::string plan = job.folder + "/" + plan_file;
  if (!is_there(plan)) KA_TRY(write_whole(files, plan, job.plan, Overwrite::no));
  KA_TRY(make_folders(job.folder + "/splits"));
  const std::string catalogue = job.folder + "/" + std::string(catalogue_file);
  if (is_there(catalogue)) return {};
  // The catalogue's name is that of the folder, also if the user typed "." or a path with "..".
  std::error_code fault;
  const std::string name = fs::weakly_canonical(job.folder, fault).filename().string();
  return write_whole(files, catalogue, KA_TRY(twin_catalogue(name)), Overwrite::no);
}

/// The takes made from a plan, and those that failed.
struct TwinMade {
  TwinCounts counts;
  std::uint64_t made = 0, were_there = 0, bytes = 0;
  std::vector<std::pair<TakeName, Error>> failed;

  void add(const TwinTake& take, const TakeSummary& summary) {
    count(take, summary.frames, counts);
    bytes += summary.bytes;
  }
};

/// Makes the missing takes, several at once. A take that fails does not stop others.
/// Threads take the missing takes one by one. `output` guards the progress, the counts and the
/// list of failures.
Result<TwinMade> make_takes(const TwinJob& job, const Catalogue& catalogue, Call& call) {
  TwinMaker maker({call.surroundings.files, job.folder, catalogue, job.motions});
  const Progress progress = call.console.progress();
  TwinMade out;
  std::vector<std::size_t> missing;  // indices of takes in the plan
  std::uint64_t all = 0, done = 0;   // frames
  for (std::size_t number = 0; number < job.takes.size(); ++number) {
    const TwinTake& take = job.takes[number];
    // A take that exists counts without being made again, so a stopped job continues.
    if (const auto known = maker.known(take)) {
      ++out.were_there;
      out.add(take, *known);
    } else {
      missing.push_back(number);
      all += take.frames;
    }
  }
  // The progress function is not made for several threads, so only one may call it at a time.
  std::mutex output;
  bool stopped = false;
  const auto is_wanted = [&](std::uint64_t frames) {
    const std::lock_guard lock(output);
    done += frames;
    // Once it is false, it stays false: all threads end as soon as they ask again.
    stopped = stopped || !go_on(progress, "making takes", done, all);
    return !stopped;
  };
  parallel_for(missing.size(), call.jobs, [&](std::size_t i) {
    if (!is_wanted(0)) return;
    const TwinTake& take = job.takes[missing[i]];
    const auto summary =
        maker.make(take, missing[i],
                   // The progress inside a take only asks whether to go on. Frames are counted
                   // once, when the take is done.
                   [&](std::string_view, std::uint64_t, std::uint64_t) { return is_wanted(0); });
    // Ctrl-C makes the take fail as well. Such a failure is not one of the take.
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
  // The devices' files of takes that failed or were stopped go with the folder of the cache.
  fs::remove_all(job.folder + "/" + std::string(cache_folder) + "/twin", ignored);
  if (stopped) return Failure(interruption());
  return out;
}

/// Writes the splits of a twin. Existing ones stay.
Result<std::vector<std::string>> write_splits(const TwinJob& job, const DatasetIndex& index,
                                              Call& call) {
  FileSystem& files = call.surroundings.files;
  const auto takes = KA_TRY(built_takes(files, job.folder, index, ""));
  std::vector<std::string> out;
  for (const auto& [file, by] :
       // The first word is the file's name, the second the rule by which make_split() divides the
       // takes.
       {std::pair("people", "subject"), std::pair("denoise", "hfut-denoise"),
        std::pair("imu", "hfut-imu")}) {
    const std::string name = std::string("splits/") + file + ".json",
                      path = job.folder + "/" + name;
    // A split that can't be made is skipped: the data set is complete without it.
    const auto split = make_split(takes, index.catalogue(), {.by = by, .seed = job.o.seed});
    if (!split) continue;  // a small twin may have too few takes
    // An existing split is kept, because models may have been trained with it.
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

/// The takes by devices: "mocap + Kinect 13 takes, mocap + IMU 1 take, all three 10 takes".
/// Shows which devices recorded together, since a method needs certain pairs.
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

/// An empty table with the columns of the paper, of the plan and of the takes made.
Table table_with(const std::string& key, const std::string& caption) {
  Table table;
  table.caption = caption;
  table.has_sum = true;
  table.columns = {{key, key}};
  for (const std::string whose : {"paper", "asked", "made"}) {
    // The keys name the origin for programs. Only the first title of three names it for people.
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

/// The people of one row of the paper's table 6, as that table writes them.
std::string ids_of(const PaperPeople& people) {
  return fmt::format(
      "{}", fmt::join(people.ids.begin(),
                      people.ids.begin() + static_cast<std::ptrdiff_t>(people.count()), ", "));
}

/// Frames by people (the paper's table 6), by classes (table 7) and by devices. Each table compares
/// the paper, the scale's plan and the takes made.
/// The plan can't meet the paper's counts exactly at a small scale, so all three are shown next to
/// each other.
std::vector<Table> twin_tables(double scale, const TwinCounts& made) {
  // A scale of 1 gives the paper's own counts.
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
  // All three tables end with the same sums.
  for (Table& table : out) add_row("sum", {paper.sum(), asked.sum(), made.sum()}, table);
  return out;
}

std::string tables_text(const std::vector<Table>& tables) {
  std::string text;
  for (const Table& table : tables) text += written(table, TableFormat::text) + "\n";
  return text;
}

/// Prints the plan of --dry-run with the room that it needs.
/// Uses the same counting as the finished twin, with the plan's frames in place of the takes'.
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
      // The last line is a command that works on the new data set as it stands.
      "  next    kinalign eval raw offset ridge --data {} -o results --folds people\n",
      job.folder, counted(made.made + made.were_there, "take"), hours_of(made.counts.sum().mocap),
      size_text(made.bytes),
      made.were_there > 0 ? fmt::format("; {} existed before", made.were_there) : "",
      counted(people.size(), "person", "people"), counted(actions.size(), "action"),
      pairs_text(made.counts), splits.empty() ? "none" : fmt::format("{}", fmt::join(splits, ", ")),
      job.folder)));
  // A failed take is listed with its reason; running the command again tries it again.
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

/// The plan is made from the options alone; motion files enter it by name only.
Result<TwinJob> job_of(const TwinVerb& o, const Call& call) {
  auto motions = KA_TRY(motions_in(o.motion));
  TwinJob job{o, folder_of({call.common.out}), plan_twin(o.options()), std::move(motions), ""};
  std::vector<std::string> names;
  for (const std::string& path : job.motions) names.emplace_back(file_name(path));
  job.plan = twin_json(o.options(), names, job.takes);
  return job;
}

/// Makes a twin. The folder is begun only after all checks.
Result<int> run_twin(TwinVerb& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  call.console.advise("nothing was written");
  const TwinJob job = KA_TRY(job_of(o, call));
  KA_TRY(check_folder(job, call));
  if (call.common.dry_run) return show_twin_plan(job, call);
  call.console.detail(fmt::format("{} to make: about {}", counted(job.takes.size(), "take"),
                                  size_text(bytes_of(job.takes))));
  // From here on files exist, so the advice changes from "nothing was written".
  call.console.advise("run the same command again to continue");
  KA_TRY(begin_folder(job, files));
  const std::string path = job.folder + "/" + std::string(catalogue_file);
  const Catalogue catalogue =
      // The catalogue is read from the disk, since begin_folder() keeps an existing one.
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
