// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/export.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/core/find_named.h"
#include "kinalign/dataset/export/release.h"
#include "kinalign/documents/report_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <set>

namespace kinalign {

namespace {

/// The number of kinds of streams that are listed because they did not fit into the format.
constexpr std::size_t shown_streams = 8;

/// The options of `kinalign dataset export`. `split` is allowed only for a format that stores the
/// parts of a split.
struct Export {
  std::vector<std::string> folder;
  std::string format = "npz", where, split;
  bool release = false;
};

/// The choices of --format. They come from the library's list of formats, so a new format needs no
/// change here.
std::vector<std::string> format_names() {
  std::vector<std::string> out;
  for (const ExportFormat& one : export_formats()) out.push_back(one.name);
  return out;
}

/// The command line of `kinalign dataset export`.
Usage describe_export(Export& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {
      choice_flag("format", "format of the files", &o.format, format_names()),
      where_field(o.where),
      split_field(o.split),
      {"release",
       "for publication: without dates and names; refused if a text may identify a person",
       &o.release}};
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    if (common.out.empty())
      return Failure(Error{"-o", 0, "-o FOLDER, which must not exist yet", "none"});
    // Only WebDataset stores the parts of a split: each part has its own archives.
    if (o.split.empty() || o.format == "webdataset") return {};
    return Failure(
        Error{"--split", 0, "--format webdataset, the only format with parts", o.format});
  };
  return usage;
}

/// The takes to export, each with its part of the split. Takes that the split does not name are
/// left out.
Result<ExportJob> job_of(const Export& o, const DatasetIndex& index, Call& call) {
  FileSystem& files = call.surroundings.files;
  ExportJob job{folder_of(o.folder), call.common.out, o.format, o.release, {}};
  // A '/' at the end is removed, because paths are built from the folder's name.
  while (job.target.size() > 1 && job.target.ends_with('/')) job.target.pop_back();
  auto takes = KA_TRY(built_takes(files, job.folder, index, o.where));
  std::map<TakeName, std::string> part_of;
  if (!o.split.empty()) {
    // The split is checked against all takes, even those that --where leaves out. Otherwise each
    // take that is left out would be an error of the split.
    const auto all = o.where.empty() ? takes : KA_TRY(built_takes(files, job.folder, index, ""));
    const Split split = KA_TRY(read_good_split(files, o.split, all));
    for (const SplitPart& part : split.parts) {
      for (const TakeName& name : part.takes) part_of[name] = part.name;
    }
  }
  for (SplitTake& take : takes) {
    const auto part = part_of.find(take.name);
    if (!o.split.empty() && part == part_of.end()) continue;
    job.takes.push_back(
        // Without a split all takes are in one part, "takes".
        {take.name, std::move(take.summary), part == part_of.end() ? "takes" : part->second});
  }
  return job;
}

/// The names of streams and nodes, which every format writes into its files. Such a name may
/// contain a person's name, so --release checks them.
std::set<std::string> names_in(const ExportJob& job) {
  std::set<std::string> out;
  for (const ExportTake& take : job.takes) {
    for (const StreamSummary& stream : take.summary.streams) {
      out.insert(stream.name);
      out.insert(stream.nodes.begin(), stream.nodes.end());
    }
  }
  return out;
}

/// Prints why streams were left out: a line for each reason, with the number of takes. Returns the
/// complete list for the JSON.
nlohmann::ordered_json print_left_out(const ExportMade& made, Call& call) {
  std::map<std::string, std::vector<std::string>> takes;
  for (const LeftOutStream& one : made.left_out) takes[one.why].push_back(to_string(one.name));
  std::vector<std::string> lines;
  for (const auto& [why, names] : takes) {
    lines.push_back(fmt::format("lost   {} ({})\n", why, counted(names.size(), "take")));
  }
  call.console.print(
      harmless(first_lines(lines, shown_streams, "lost   {} more kinds (--json has them)\n")));
  return takes;
}

/// Exports the takes. With --release no file is written if a text could identify a person.
Result<int> run_export(Export& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const DatasetIndex index = KA_TRY(open_index(folder_of(o.folder), call));
  const ExportJob job = KA_TRY(job_of(o, index, call));
  // `findings` has two kinds: texts that may identify people, and findings of the export itself.
  Findings findings;
  if (o.release) {
    findings = look_for_people(index.catalogue(), job.folder + "/dataset.toml", names_in(job));
  }
  // Publication can't be undone, so one suspicious text stops the export before the first file.
  if (print_findings(findings, call)) {
    call.console.print("nothing was written: the texts listed as errors may identify a person\n");
    call.console.print_json(
        fmt::format("{{\"files\": 0, \"findings\": {}}}", findings_json(findings)));
    return 1;
  }
  KA_TRY(print_not_built(index, job.folder, call));
  const ExportMade made =
      KA_TRY(export_takes(files, index.catalogue(), job, call.console.progress()));
  call.console.print(harmless(fmt::format(
      "{}: {}, {}\n", job.target, counted(job.takes.size(), "take"), counted(made.files, "file"))));
  const auto formats = export_formats();
  const ExportFormat& format = *find_named(formats, o.format);
  // No format can store everything. The line "lost" states what this format leaves out.
  call.console.print(fmt::format("lost   {}\n", format.lost));
  const auto left_out = print_left_out(made, call);
  // The files have been written already, so an error among these findings changes only the exit
  // code.
  const bool has_error = print_findings(made.findings, call);
  findings.insert(findings.end(), made.findings.begin(), made.findings.end());
  call.console.print_json(json_text(
      nlohmann::ordered_json{{"takes", job.takes.size()},
                             {"files", made.files},
                             {"format", o.format},
                             {"lost", format.lost},
                             {"left_out", left_out},
                             {"findings", nlohmann::ordered_json::parse(findings_json(findings))}},
      1));
  return has_error ? 1 : 0;
}

/// The text about formats in the help page, made from the same list as the choices of --format.
std::string formats_text() {
  std::string out;
  for (const ExportFormat& one : export_formats()) {
    out += fmt::format("{}{}: {}", out.empty() ? "" : ". ", one.name, one.title);
  }
  return out + ". The program lists what a format can't hold.";
}

}  // namespace

/// The verb `kinalign dataset export`.
Verb dataset_export_verb() {
  return make_verb<Export>(
      {.name = "dataset export",
       .summary = "takes as files of other programs, in a new folder",
       .text = formats_text(),
       .examples =
           {{"kinalign dataset export walks -o walks_c3d --format c3d --where \"class = 'S1'\"",
             "points for a gait laboratory"},
            {"kinalign dataset export walks -o walks_bids --format bids --release",
             "for publication: no dates, no names of files"},
            {"kinalign dataset export walks -o shards --format webdataset --split "
             "walks/splits/people.json",
             "train-000000.tar, test-000000.tar"}},
       .common = {"out", "json"}},
      describe_export, run_export);
}

}  // namespace kinalign
