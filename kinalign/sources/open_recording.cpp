// SPDX-License-Identifier: Apache-2.0
#include "kinalign/sources/open_recording.h"

#include "kinalign/core/parallel.h"
#include "kinalign/core/utf8.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/sources/stream_survey.h"
#include "kinalign/take/remembered_path.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

namespace kinalign {

namespace {

/// Makes the clock from the stream's options; offset and drift begin at the first stamp. The file
/// does not state its clock, and the user states a constant drift, so one piece suffices.
TimeModel clock_of(const StreamOptions& options, const StampSurvey& survey) {
  TimeModel model = options.clock == "shared" ? shared_clock() : TimeModel{};
  TimeModelPiece& piece = model.pieces.front();
  piece.begin = survey.first;
  piece.offset = Duration{std::llround(options.offset_ms * 1e6)};
  piece.drift_ppm = options.drift_ppm;
  if (options.interval_ms) piece.half_width = Duration{std::llround(*options.interval_ms * 1e6)};
  return model;
}

/// Adds the user's offset to the clock that a recording states. The other clock options are refused
/// (align/unused_options.h), because the recording's clock is more accurate.
TimeModel moved_by(TimeModel model, const StreamOptions& options) {
  const Duration by{std::llround(options.offset_ms * 1e6)};
  for (TimeModelPiece& piece : model.pieces) piece.offset += by;
  return model;
}

/// Adds up the progress of files that are read in parallel. The lock ensures that progress is never
/// called on two threads at once.
class SharedProgress {
 public:
  SharedProgress(const Progress& progress, std::size_t parts)
      : progress_(progress), parts_(parts) {}

  Progress part(std::size_t i) {
    if (!progress_) return {};
    return [this, i](std::string_view what, std::uint64_t done, std::uint64_t total) {
      const std::lock_guard lock(mutex_);
      parts_[i] = {done, total};
      // A total becomes known when its file is opened, so the sum of totals grows at first.
      Part sum;
      for (const Part& each : parts_) {
        sum.done += each.done;
        sum.total += each.total;
      }
      return progress_(what, sum.done, sum.total);
    };
  }

 private:
  struct Part {
    std::uint64_t done = 0, total = 0;
  };
  const Progress& progress_;
  std::mutex mutex_;
  std::vector<Part> parts_;
};

/// A file of a stream. Its options and paths are relative to the current folder. The manifest
/// itself is not changed, because the take stores the user's text. `stated` points into the
/// manifest, which must outlive this object.
struct NamedFile {
  const StreamOptions* stated = nullptr;
  StreamOptions options;
  StreamFile file;
  std::string remembered;  // the file's name in the take
  bool is_first = true;    // it is the first file of its stream
  // The name in messages, such as "mocap" or "imu waist".
  std::string name() const { return options.name + (file.node.empty() ? "" : " " + file.node); }
};

/// Returns the files of all streams with their names in the take. If two files have the same name,
/// their folders are added, so the names depend on all paths.
Result<std::vector<NamedFile>> named_files(const std::vector<StreamOptions>& streams,
                                           const std::string& folder) {
  std::vector<std::string> paths;
  for (const StreamOptions& stated : streams) {
    if (stated.files.empty()) {
      return Failure(Error{"", 0, "a file for stream '" + stated.name + "'", "none"});
    }
    for (const StreamFile& file : stated.files) paths.push_back(file.path);
  }
  const auto remembered = remembered_paths(paths);
  std::vector<NamedFile> named;
  for (const StreamOptions& stated : streams) {
    StreamOptions options = stated;
    if (options.own_layout()) options.layout = path_in(folder, options.layout);
    if (!options.skeleton.empty()) options.skeleton = path_in(folder, options.skeleton);
    if (options.files.size() > 1) options.start_ns.reset();  // see start_together
    for (const StreamFile& file : stated.files) {
      named.push_back({&stated,
                       options,
                       {path_in(folder, file.path), file.node},
                       remembered.at(file.path),
                       &file == &stated.files.front()});
    }
  }
  return named;
}

/// Opens a file, gives the stream's files their names in the take, and sets the clock. If the file
/// is a recording, `recording` is the opened recording with its stream.
Result<SurveyedFile> open_file(FileSystem& files, const std::string& folder, const NamedFile& named,
                               const std::shared_ptr<RecordingSource>& recording,
                               const Progress& progress) {
  const StreamOptions& options = named.options;
  SurveyedFile out =
      KA_TRY(recording ? survey_device(files, options, named.file, recording, progress)
                       : survey_file(files, options, named.file, progress));
  // Files that all nodes share, such as a layout, are listed only with the first node.
  if (!named.is_first) {
    out.paths.resize(1);
    out.stream.files.resize(1);
  }
  // Names and paths have the same order: the stream's own file is first.
  out.stream.files.front().name = named.remembered;
  for (std::size_t i = 1; i < out.paths.size(); ++i) {
    const std::string& path = out.paths[i];
    std::string& name = out.stream.files[i].name;
    if (path == options.layout) {
      name = remembered_path(folder, named.stated->layout, path);
    } else if (path == options.skeleton) {
      name = remembered_path(folder, named.stated->skeleton, path);
    } else {
      name = remembered_sibling(named.remembered, out.paths[0], path);
    }
  }
  out.stream.clock =
      out.clock ? moved_by(*out.clock, options) : clock_of(options, out.stream.survey);
  return out;
}

/// Fails if two different files have the same name in the take, because `rebuild` could not
/// distinguish them. Also fails if a name is not UTF-8, because `rebuild` could not find the file.
Result<void> check_names(const std::vector<SurveyedFile>& opened) {
  struct Place {
    const std::string* path;
    const InputFacts* facts;
  };
  std::map<std::string_view, Place> seen;
  for (const SurveyedFile& each : opened) {
    for (std::size_t i = 0; i < each.paths.size(); ++i) {
      const InputFacts& facts = each.stream.files[i];
      if (!is_utf8(facts.name)) {
        return Failure(Error{each.paths[i], 0,
                             "a file name in UTF-8, which a take can hold, so rename the file",
                             "'" + shown(facts.name) + "'"});
      }
      const auto [at, fresh] = seen.try_emplace(facts.name, Place{&each.paths[i], &facts});
      // If both files have the same bytes, either file makes the same take.
      if (fresh || at->second.facts->sha256 == facts.sha256) continue;
      return Failure(Error{each.paths[i], 0,
                           "files that a take can tell apart by name (below the manifest's folder: "
                           "by their paths), so rename one or move both there",
                           "'" + shown(facts.name) + "' again: " + *at->second.path});
    }
  }
  return {};
}

/// All files of one stream have one time axis. If start_ns is given, it is the stamp of the
/// earliest sample of all files.
Result<void> start_together(const StreamOptions& options, std::vector<SurveyedFile>& opened) {
  if (!options.start_ns || options.files.size() < 2) return {};
  std::optional<std::int64_t> first;
  for (const SurveyedFile& each : opened) {
    const RecordedStream& s = each.stream;
    if (s.name != options.name || s.survey.kept() == 0) continue;
    first = std::min(first.value_or(to_ns(s.survey.first)), to_ns(s.survey.first));
  }
  for (SurveyedFile& each : opened) {
    if (!first || each.stream.name != options.name) continue;
    const std::int64_t shift = *options.start_ns - *first;
    const std::int64_t last = to_ns(each.stream.survey.last);
    // A stamp far from 1970 could overflow 64 bits when it is shifted.
    if (std::abs(shift) > largest_stamp_ns ||
        last > largest_stamp_ns - std::max<std::int64_t>(0, shift)) {
      return Failure(Error{each.paths.front(), 0, "a stamp inside +-4e18 ns",
                           std::to_string(last) + " ns, to be moved by " + std::to_string(shift)});
    }
    each.stream.clock.pieces.front().offset += Duration{shift};
  }
  return {};
}

/// Fails if the subject, the action or a name is not UTF-8, because a take stores them as UTF-8.
Result<void> check_texts(const Manifest& manifest) {
  std::vector<std::string> texts{manifest.subject, manifest.action};
  for (const StreamOptions& stream : manifest.streams) {
    texts.push_back(stream.name);
    for (const StreamFile& file : stream.files) texts.push_back(file.node);
  }
  for (const std::string& text : texts) {
    if (is_utf8(text)) continue;
    return Failure(Error{"", 0, "subject, action and names in UTF-8, as a take holds them",
                         "'" + shown(text) + "'"});
  }
  return {};
}

/// Files that are opened together: the files of all streams of one recording, or a single file.
struct Group {
  std::string path;                // path as written for the first file
  std::filesystem::path one_path;  // normalised path; the same for ./a.mcap and a.mcap
  bool is_recording = false;
  std::vector<std::size_t> named;  // indices of the files
};

/// Links are not resolved. The same file under two names is read twice, which only costs time.
std::filesystem::path normal_path(const std::string& path) {
  std::error_code fault;
  const auto whole = std::filesystem::absolute(path, fault);
  return fault ? std::filesystem::path(path) : whole.lexically_normal();
}

/// Streams that name one recording and no layout form a group, so that the recording is read once.
/// A layout requires another reader, so a file with a layout is opened alone.
std::vector<Group> groups_of(FileSystem& files, const std::vector<NamedFile>& named) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::string& path = named[i].file.path;
    const bool has_layout = !named[i].options.layout.empty();
    const std::filesystem::path one_path = normal_path(path);
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.is_recording && g.one_path == one_path && !has_layout;
    });
    if (known != groups.end()) {
      known->named.push_back(i);
      continue;
    }
    const auto recording = is_recording(files, path);  // opening the file later reports a fault
    groups.push_back({path, one_path, !has_layout && recording && *recording, {i}});
  }
  return groups;
}

/// Opens the recording of a group once for all its streams. Returns nullptr for another kind of
/// file. `given`: a recording that the caller has already opened.
Result<std::shared_ptr<RecordingSource>> recording_of(FileSystem& files, const Group& group,
                                                      const std::vector<NamedFile>& named,
                                                      const std::shared_ptr<RecordingSource>& given,
                                                      const Progress& progress) {
  if (!group.is_recording) return std::shared_ptr<RecordingSource>();
  if (given && given->path() == group.path) return given;
  std::vector<StreamOptions> wanted;
  for (const std::size_t i : group.named) {
    wanted.push_back(named[i].options);
    wanted.back().files = {named[i].file};
  }
  return RecordingSource::open(files, group.path, RecordingSource::Devices::learned, wanted,
                               progress);
}

/// Opens all files, groups in parallel. Failures become warnings in `left_out`. If that is nullptr,
/// the failure of the first failing file is returned.
Result<std::vector<SurveyedFile>> open_all(FileSystem& files, const std::string& folder,
                                           const std::vector<StreamOptions>& streams,
                                           const OpenWith& with, Findings* left_out = nullptr) {
  const std::vector<NamedFile> named = KA_TRY(named_files(streams, folder));
  const std::vector<Group> groups = groups_of(files, named);
  std::vector<Result<SurveyedFile>> opened(named.size());
  SharedProgress shared(with.progress, groups.size());
  parallel_for(groups.size(), with.jobs, [&](std::size_t g) {
    const Progress progress = shared.part(g);
    const auto source = recording_of(files, groups[g], named, with.recording, progress);
    // If the recording can't be opened, each of its streams gets the error.
    for (const std::size_t i : groups[g].named) {
      opened[i] = source ? open_file(files, folder, named[i], *source, progress)
                         : Result<SurveyedFile>(Failure(source.error()));
    }
  });
  std::vector<SurveyedFile> out;
  for (std::size_t i = 0; i < opened.size(); ++i) {
    // An interruption by the user ends the whole call.
    if (opened[i] || left_out == nullptr || is_interruption(opened[i].error())) {
      out.push_back(KA_TRY(std::move(opened[i])));
    } else {
      left_out->push_back(
          {Severity::warning, opened[i].error(), named[i].name() + " is left out", ""});
    }
  }
  // The earliest stamp of a stream is known only after all its files were opened.
  for (const StreamOptions& options : streams) KA_TRY(start_together(options, out));
  return out;
}

/// Makes the Recording of the opened files. Streams of one recording refer to a shared file, so
/// that its findings and marks are reported once.
Recording joined(const Manifest& manifest, std::vector<SurveyedFile> opened) {
  Recording out{manifest.subject, manifest.action, {}, {}};
  std::vector<const RecordingSource*> sources;
  for (SurveyedFile& one : opened) {
    if (one.recording) {
      const auto known = std::find(sources.begin(), sources.end(), one.recording.get());
      one.stream.shared_file = static_cast<std::size_t>(known - sources.begin());
      if (known == sources.end()) {
        sources.push_back(one.recording.get());
        out.shared_files.push_back(one.recording->shared());
      }
    }
    out.streams.push_back(std::move(one.stream));
  }
  return out;
}

/// Opens all files of a manifest. Fails if a take can't store the names of the manifest or of the
/// files.
Result<Recording> open_manifest(FileSystem& files, const Manifest& manifest,
                                const std::string& folder, const OpenWith& with,
                                Findings* left_out) {
  KA_TRY(check_texts(manifest));
  auto opened = KA_TRY(open_all(files, folder, manifest.streams, with, left_out));
  KA_TRY(check_names(opened));
  return joined(manifest, std::move(opened));
}

}  // namespace

/// Streams without a manifest are not stored in a take, so several may have the same name.
Result<Recording> open_streams(FileSystem& files, const std::vector<StreamOptions>& streams,
                               const OpenWith& with) {
  return joined({}, KA_TRY(open_all(files, "", streams, with)));
}

Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const OpenWith& with) {
  return open_manifest(files, manifest, folder, with, nullptr);
}

Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const OpenWith& with) {
  OpenedInPart out;
  out.recording = KA_TRY(open_manifest(files, manifest, folder, with, &out.left_out));
  return out;
}

Result<void> read_through(const Recording& recording, const Progress& progress) {
  std::vector<ReadNext> passes;
  std::uint64_t rows = 0, all = 0;
  for (const RecordedStream& stream : recording.streams) {
    // If the findings of a stream are known, the stream was already read to its end.
    if (!stream.late_findings || *stream.late_findings) continue;
    all += stream.survey.samples;
    KA_TRY(std::visit(
        [&](const auto& input) -> Result<void> {
          passes.push_back(read_on(KA_TRY(input.passes()), stream.clock, rows));
          return {};
        },
        stream.data));
  }
  return read_side_by_side(passes, [&]() -> Result<void> {
    if (go_on(progress, "reading", rows, all)) return {};
    return Failure(interruption());
  });
}

}  // namespace kinalign
