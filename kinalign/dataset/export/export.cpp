// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/export.h"

#include "kinalign/dataset/export/bids_export.h"
#include "kinalign/dataset/export/release.h"
#include "kinalign/dataset/export/shard_export.h"
#include "kinalign/dataset/export/take_files.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/summarise.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/guarded.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace kinalign {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Collects the results of an export. The child process then sends them to the parent process as
/// text.
struct Made {
  std::uint64_t files = 0;
  Json left_out = Json::array();
  Findings findings;

  /// Fails if no file was written, because an empty folder must not look like an export. `needs`:
  /// the content that a take must have for this format.
  Result<void> holds_something(const ExportJob& job, std::string_view needs) const {
    if (files > 0) return {};
    // The first fault is reported, because it explains the empty result best.
    if (!findings.empty()) return Failure(findings.front().what);
    return Failure(Error{job.folder, 0,
                         fmt::format("{} in at least one take, for {}", needs, job.format),
                         "no take with them"});
  }

  void add(const TakeName& name, const FilesMade& made) {
    files += made.paths.size();
    for (const std::string& why : made.left_out) left_out.push_back({to_string(name), why});
    for (const Error& error : made.failed) {
      findings.push_back({Severity::error, error, "this file was not written", ""});
    }
  }
};

/// Copies a take byte for byte, if nothing has to be hidden. Its hash stays the same.
Result<FilesMade> copy_take(FileSystem& files, const std::string& from, const std::string& to) {
  KA_TRY(copy_file(files, from, to));
  return FilesMade{{to}, {}, {}};
}

/// Writes the take again without names and dates.
Result<FilesMade> rewrite_take(ExportedTake& take, FileSystem& files, const std::string& to) {
  TakeHeader header = take.header();
  // The report is read back as data, because names and dates in it must change, too.
  AlignmentReport report = KA_TRY(parse_report_json(KA_TRY(take.report_json()), to));
  hide_names(header, report);
  move_dates(take.moved(), header, report);
  TakeWriter writer = KA_TRY(TakeWriter::create(files, to, Overwrite::no, header));
  KA_TRY(take.rows([&](const TakeSlab& slab) { return writer.append(slab); }));
  KA_TRY(writer.finish(report));
  return FilesMade{{to}, {"marks, and the names of raw files"}, {}};
}

/// Adds the summary of a written take. Without a summary, a data set does not list the take.
Result<FilesMade> with_summary(FilesMade made, FileSystem& files, const std::string& folder,
                               const TakeName& name) {
  TakeReader reader = KA_TRY(TakeReader::open(files, made.paths.front()));
  KA_TRY(keep_summary(files, folder, name, KA_TRY(summary_of(reader))));
  made.paths.push_back(path_of(folder, name, TakeFile::summary));
  return made;
}

/// One export in the child process. `folder` is the unfinished folder. The writers for whole data
/// sets exist in every export, but only the writer of the job's format is used.
class Exporting {
 public:
  Exporting(FileSystem& files, const Catalogue& catalogue, const ExportJob& job, std::string folder)
      : files_(files),
        catalogue_(catalogue),
        job_(job),
        folder_(std::move(folder)),
        bids_(files, folder_, catalogue, job.release),
        shards_(files, folder_) {}

  Result<void> run(const Progress& progress);
  Made made;

 private:
  Result<FilesMade> write(ExportedTake& take, const ExportTake& of, const std::string& path);
  Result<void> finish();

  FileSystem& files_;
  const Catalogue& catalogue_;
  const ExportJob& job_;
  std::string folder_;
  BidsExport bids_;
  ShardExport shards_;
};

/// Writes one take in the format of the job.
Result<FilesMade> Exporting::write(ExportedTake& take, const ExportTake& of,
                                   const std::string& path) {
  if (job_.format == "bids") return bids_.add(take);
  if (job_.format == "webdataset") {
    const Action* action = find_action(catalogue_, of.name.action);
    return shards_.add(take, {action == nullptr ? "" : action->class_id, of.part});
  }
  const std::string folder = folder_ + "/sub-" + of.name.subject;
  KA_TRY(make_folders(folder));
  if (job_.format == "take") {
    const std::string to = path_of(folder_, of.name, TakeFile::take);
    return with_summary(
        KA_TRY(job_.release ? rewrite_take(take, files_, to) : copy_take(files_, path, to)), files_,
        folder_, of.name);
  }
  // The format's name was checked before the job began, so the row exists.
  return find_take_format(job_.format)
      ->write(take, files_, path, folder + "/" + to_string(of.name));
}

Result<void> Exporting::finish() {
  if (job_.format == "bids") {
    // The files about the whole data set are written when all takes are known.
    for (Finding& finding : KA_TRY(bids_.finish())) made.findings.push_back(std::move(finding));
  }
  if (job_.format == "webdataset") made.add({}, KA_TRY(shards_.finish()));
  if (job_.format == "take") {
    constexpr std::size_t longest = std::size_t{64} << 20;
    const std::string toml(catalogue_file);
    // A released dataset.toml lists only people whose takes are in it.
    std::set<std::string> used;
    for (const ExportTake& take : job_.takes) used.insert(take.name.subject);
    const std::string text = job_.release
                                 ? released_catalogue(catalogue_, used)
                                 : KA_TRY(read_whole(files_, job_.folder + "/" + toml, longest));
    KA_TRY(write_whole(files_, folder_ + "/" + toml, text, Overwrite::no));
  }
  return {};
}

Result<void> Exporting::run(const Progress& progress) {
  std::uint64_t done = 0, total = 0;
  // Progress counts frames, because takes have different lengths.
  for (const ExportTake& take : job_.takes) total += take.summary.frames;
  for (const ExportTake& of : job_.takes) {
    const std::string path = path_of(job_.folder, of.name, TakeFile::take);
    ExportedTake take =
        KA_TRY(ExportedTake::open(files_, path, of.name, of.summary.rate_hz, job_.release));
    // The first take that can't be written ends the export.
    made.add(of.name, KA_TRY(write(take, of, path)));
    done += of.summary.frames;
    if (!go_on(progress, "exporting", done, total)) return Failure(interruption());
  }
  return finish();
}

/// The child process can pass on text only; made_from() reads it in the parent.
std::string text_of(const Made& made) {
  return Json{{"files", made.files},
              {"left_out", made.left_out},
              {"findings", findings_json(made.findings)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

ExportMade made_from(const std::string& text) {
  const Json json = Json::parse(text);
  ExportMade made;
  made.files = json.at("files").get<std::uint64_t>();
  for (const Json& one : json.at("left_out")) {
    // A result about the whole data set has no take's name.
    made.left_out.push_back(
        {parse_take_name(one.at(0).get<std::string>()).value_or(TakeName{}), one.at(1)});
  }
  made.findings = parse_findings_json(json.at("findings").get<std::string>());
  return made;
}

/// The content that a format needs, in words, for the error of an empty export.
std::string_view needs_of(const std::string& name) {
  const TakeFormat* const format = find_take_format(name);
  return format == nullptr ? "a stream" : format->needs;
}

/// Makes the folder `target`.part, into which the export is written. One rename at the end makes
/// all files appear at once.
Result<std::string> make_part_folder(const std::string& target) {
  std::error_code failed;
  // A link counts as existing, even if it leads nowhere.
  if (fs::exists(fs::symlink_status(target, failed))) {
    return Failure(Error{target, 0, "a folder that does not exist yet", "an existing one"});
  }
  const auto above = fs::path(target).parent_path();
  if (!above.empty()) fs::create_directories(above, failed);
  std::string path = target + ".part";
  // An existing folder is never used, because another export may be writing into it.
  if (fs::exists(fs::symlink_status(path, failed))) {
    return Failure(Error{path, 0, "no unfinished export (if no export is running, remove it)",
                         "an existing folder"});
  }
  KA_TRY(make_new_folder(path));
  return path;
}

}  // namespace

/// The formats of single takes, then those of whole data sets.
std::vector<ExportFormat> export_formats() {
  std::vector<ExportFormat> out;
  for (const TakeFormat& one : take_formats()) {
    out.push_back({std::string(one.name), std::string(one.title), std::string(one.lost)});
  }
  out.push_back({"bids", "BIDS-Motion, checked after writing",
                 "bones and local rotations; inferred against tracked; intervals; gravity"});
  out.push_back(
      {"webdataset", "tar shards, a sample for each take", "the report and the parameters"});
  out.push_back(
      {"take", "a data set of its own: dataset.toml and the takes", "manifests and raw files"});
  return out;
}

Result<ExportMade> export_takes(FileSystem& files, const Catalogue& catalogue, const ExportJob& job,
                                const Progress& progress) {
  // Takes that were not built have nothing to export.
  if (job.takes.empty()) return Failure(Error{job.folder, 0, "takes that are built", "none"});
  const std::string path = KA_TRY(make_part_folder(job.target));
  UnfinishedFolder part(path);
  GuardLimits limits;
  // The limits of the child process grow with the work: ten minutes of computing and an hour of
  // waiting for each take.
  limits.cpu_seconds += 600 * job.takes.size();
  limits.wall_seconds += 3600.0 * static_cast<double>(job.takes.size());
  // The error if the child process crashes.
  const Error blame{job.folder, 0, "takes that HDF5 can read", ""};
  const std::string text = KA_TRY(run_guarded(
      limits, blame, progress, [&](const Progress& child_progress) -> Result<std::string> {
        // Takes are opened only in the child process.
        Exporting exporting(files, catalogue, job, path);
        KA_TRY(exporting.run(child_progress));
        KA_TRY(exporting.made.holds_something(job, needs_of(job.format)));
        return text_of(exporting.made);
      }));
  std::error_code failed;
  fs::rename(path, job.target, failed);
  if (failed) return Failure(Error{job.target, 0, "a folder that can be made", failed.message()});
  part.keep();
  return made_from(text);
}

}  // namespace kinalign
