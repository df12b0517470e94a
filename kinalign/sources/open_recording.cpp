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

/// The clock by the stream's options: offset and drift begin at the first stamp. A file states no
/// clock; the user does. One piece therefore describes it.
TimeModel clock_of(const StreamOptions& options, const StampSurvey& survey) {
  TimeModel model = options.clock == "shared" ? shared_clock() : TimeModel{};
  TimeModelPiece& piece = model.pieces.front();
  piece.begin = survey.first;
  piece.offset = Duration{std::llround(options.offset_ms * 1e6)};
  piece.drift_ppm = options.drift_ppm;
  if (options.interval_ms) piece.half_width = Duration{std::llround(*options.interval_ms * 1e6)};
  return model;
}

/// The clock that a recording states, moved by the user's offset. Its other options are refused
/// (align/unused_options.h), since the recording knows better.
TimeModel moved_by(TimeModel model, const StreamOptions& options) {
  const Duration by{std::llround(options.offset_ms * 1e6)};
  for (TimeModelPiece& piece : model.pieces) piece.offset += by;
  return model;
}

/// Sums up the progress of files that are read in parallel. The lock also keeps the promise that
/// progress is never called on two threads at once.
class SharedProgress {
 public:
  SharedProgress(const Progress& progress, std::size_t parts)
      : progress_(progress), parts_(parts) {}

  Progress part(std::size_t i) {
    if (!progress_) return {};
    return [this, i](std::string_view what, std::uint64_t done, std::uint64_t total) {
      const std::lock_guard lock(mutex_);
      parts_[i] = {done, total};
      // Totals become known when files are opened, so the sum of totals grows at first.
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

/// A file of a stream. The pointers lead into the manifest, which lives longer.
struct NamedFile {
  const StreamOptions* options = nullptr;
  const StreamFile* file = nullptr;
  std::string remembered;  // its name in the take
  // The name in messages: "mocap", "imu waist".
  std::string name() const { return options->name + (file->node.empty() ? "" : " " + file->node); }
};

/// A file with the options and paths as seen from the current folder. The manifest itself is not
/// changed: the take stores it as the user wrote it.
struct PlacedFile {
  StreamOptions options;
  StreamFile file;
};
PlacedFile place_of(const std::string& folder, const NamedFile& named) {
  PlacedFile place{*named.options, {path_in(folder, named.file->path), named.file->node}};
  StreamOptions& options = place.options;
  if (options.own_layout()) options.layout = path_in(folder, options.layout);
  if (!options.skeleton.empty()) options.skeleton = path_in(folder, options.skeleton);
  if (options.files.size() > 1) options.start_ns.reset();  // see start_together
  return place;
}

/// Gives the files their names in the take, and sets the clock. A file that all nodes of a stream
/// share, such as a layout, is kept with the first node only.
SurveyedFile named_as_said(SurveyedFile out, const std::string& folder, const NamedFile& named,
                           const StreamOptions& options) {
  for (std::size_t i = 0; i < out.paths.size(); ++i) {
    std::string& name = out.stream.files[i].name;
    // The order of the names is that of the paths: the stream's own file is first.
    if (i == 0) {
      name = named.remembered;
    } else if (out.paths[i] == options.layout) {
      name = remembered_path(folder, named.options->layout, out.paths[i]);
    } else if (out.paths[i] == options.skeleton) {
      name = remembered_path(folder, named.options->skeleton, out.paths[i]);
    } else {
      name = remembered_sibling(named.remembered, out.paths[0], out.paths[i]);
    }
  }
  // The files of the first node hold what all nodes share.
  if (named.file != &named.options->files.front()) {
    out.paths.resize(1);
    out.stream.files.resize(1);
  }
  out.stream.clock =
      out.clock ? moved_by(*out.clock, options) : clock_of(options, out.stream.survey);
  return out;
}

/// Opens a file that is no recording, or one that a layout reads as something else. Its version is
/// taken before it is opened. A change during the first pass is then noticed by the passes after
/// it.
Result<SurveyedFile> open_file(FileSystem& files, const std::string& folder, const NamedFile& named,
                               const Progress& progress) {
  const PlacedFile place = place_of(folder, named);
  const SurveyJob job{&files, &place.options, &progress, version_of(place.file.path)};
  return named_as_said(KA_TRY(survey_file(job, place.file)), folder, named, place.options);
}

/// Fails if two different files would have one name in the take, since `rebuild` could not tell
/// them apart, or if a name is not UTF-8, since `rebuild` could not find the file.
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
      // The same bytes under one name are no conflict: either file makes the same take.
      if (fresh || at->second.facts->sha256 == facts.sha256) continue;
      return Failure(Error{each.paths[i], 0,
                           "files that a take can tell apart by name (below the manifest's folder: "
                           "by their paths), so rename one or move both there",
                           "'" + shown(facts.name) + "' again: " + *at->second.path});
    }
  }
  return {};
}

/// The files of one stream share an axis: if start_ns is given, it is the stamp of the earliest
/// sample of all files.
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
    // Stamps far from 1970 could leave 64 bits when they are moved.
    if (std::abs(shift) > largest_stamp_ns ||
        last > largest_stamp_ns - std::max<std::int64_t>(0, shift)) {
      return Failure(Error{each.paths.front(), 0, "a stamp inside +-4e18 ns",
                           std::to_string(last) + " ns, to be moved by " + std::to_string(shift)});
    }
    each.stream.clock.pieces.front().offset += Duration{shift};
  }
  return {};
}

/// Fails if the subject, the action or a name is not UTF-8: a take stores them.
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

/// The files of all streams, with their names in the take. Names depend on all paths together,
/// since equal file names get their folders.
Result<std::vector<NamedFile>> named_files(const std::vector<StreamOptions>& streams) {
  std::vector<std::string> paths;
  for (const StreamOptions& options : streams) {
    for (const StreamFile& file : options.files) paths.push_back(file.path);
  }
  const auto remembered = remembered_paths(paths);
  std::vector<NamedFile> named;
  for (const StreamOptions& options : streams) {
    if (options.files.empty()) {
      return Failure(Error{"", 0, "a file for stream '" + options.name + "'", "none"});
    }
    for (const StreamFile& file : options.files) {
      named.push_back({&options, &file, remembered.at(file.path)});
    }
  }
  return named;
}

/// Files that are opened together: the streams of one recording, or a single file.
struct Group {
  std::string path;                // in the spelling of the first file
  std::filesystem::path one_path;  // the same for ./a.mcap and a.mcap
  bool is_recording = false;
  std::vector<std::size_t> named;  // indices of the files
};

/// Links are not followed: the same file under two names is read twice, which costs only time.
std::filesystem::path normal_path(const std::string& path) {
  std::error_code fault;
  const auto whole = std::filesystem::absolute(path, fault);
  return fault ? std::filesystem::path(path) : whole.lexically_normal();
}

/// Streams without a layout that name one recording form a group, so that it is read once. A layout
/// states another reader, so such a file is opened by itself.
std::vector<Group> groups_of(FileSystem& files, const std::string& folder,
                             const std::vector<NamedFile>& named) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::string path = path_in(folder, named[i].file->path);
    const std::filesystem::path one_path = normal_path(path);
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.is_recording && g.one_path == one_path && named[i].options->layout.empty();
    });
    if (known != groups.end()) {
      known->named.push_back(i);
      continue;
    }
    const auto recording = is_recording(files, path);  // opening reports a fault
    groups.push_back(
        {path, one_path, named[i].options->layout.empty() && recording && *recording, {i}});
  }
  return groups;
}

/// Opens groups and stores the result of each file. Groups run in parallel; each writes only the
/// results of its own files.
struct Opening {
  FileSystem* files = nullptr;
  const std::string* folder = nullptr;
  const std::vector<NamedFile>* named = nullptr;
  std::shared_ptr<RecordingSource> given;
  std::vector<Result<SurveyedFile>> opened;

  void open_group(const Group& group, const Progress& progress) {
    if (!group.is_recording) {
      const std::size_t i = group.named.front();
      opened[i] = open_file(*files, *folder, (*named)[i], progress);
      return;
    }
    // A recording is opened once for all of its streams.
    std::vector<PlacedFile> places;
    std::vector<StreamOptions> wanted;
    for (const std::size_t i : group.named) {
      places.push_back(place_of(*folder, (*named)[i]));
      wanted.push_back(places.back().options);
      wanted.back().files = {places.back().file};
    }
    // A source that the caller has opened already is used if it is this recording.
    const auto source =
        given && given->path() == group.path
            ? given
            : RecordingSource::open(*files, group.path, RecordingSource::Devices::learned, wanted,
                                    progress);
    // If the recording can't be opened, each of its streams gets that error.
    for (std::size_t k = 0; k < group.named.size(); ++k) {
      const std::size_t i = group.named[k];
      opened[i] = source ? open_device(places[k], (*named)[i], *source, progress)
                         : Result<SurveyedFile>(Failure(source.error()));
    }
  }

 private:
  Result<SurveyedFile> open_device(const PlacedFile& place, const NamedFile& one,
                                   const std::shared_ptr<RecordingSource>& source,
                                   const Progress& progress) const {
    const SurveyJob job{files, &place.options, &progress, {}};
    return named_as_said(KA_TRY(survey_device(job, place.file, source)), *folder, one,
                         place.options);
  }
};

/// Opens all groups in parallel and returns the result of each file. Failures stay at their files,
/// so both callers can treat them as they need.
std::vector<Result<SurveyedFile>> open_each(FileSystem& files, const std::string& folder,
                                            const std::vector<NamedFile>& named,
                                            const OpenWith& with) {
  const std::vector<Group> groups = groups_of(files, folder, named);
  SharedProgress shared(with.progress, groups.size());
  Opening opening{&files, &folder, &named, with.recording,
                  std::vector<Result<SurveyedFile>>(named.size())};
  parallel_for(groups.size(), with.jobs,
               [&](std::size_t g) { opening.open_group(groups[g], shared.part(g)); });
  return std::move(opening.opened);
}

/// Opens all files; the first failure in their order is returned.
Result<std::vector<SurveyedFile>> open_all(FileSystem& files, const std::string& folder,
                                           const std::vector<StreamOptions>& streams,
                                           const OpenWith& with) {
  auto opened = open_each(files, folder, KA_TRY(named_files(streams)), with);
  std::vector<SurveyedFile> out;
  out.reserve(opened.size());
  for (auto& one : opened) out.push_back(KA_TRY(std::move(one)));
  // Only with all files open is the earliest stamp of a stream known.
  for (const StreamOptions& options : streams) KA_TRY(start_together(options, out));
  return out;
}

/// The recording of these files. Streams of one recording refer to it as a shared file, so that its
/// findings and marks are reported once.
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

/// The same, but fails if a take could not name the files.
Result<Recording> recording_of(const Manifest& manifest, std::vector<SurveyedFile> opened) {
  KA_TRY(check_names(opened));
  return joined(manifest, std::move(opened));
}

}  // namespace

/// Streams without a manifest are not stored in a take, so their names need not differ.
Result<Recording> open_streams(FileSystem& files, const std::vector<StreamOptions>& streams,
                               const OpenWith& with) {
  return joined({}, KA_TRY(open_all(files, "", streams, with)));
}

Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const OpenWith& with) {
  KA_TRY(check_texts(manifest));
  auto opened = KA_TRY(open_all(files, folder, manifest.streams, with));
  return recording_of(manifest, std::move(opened));
}

/// Opens what can be opened. A file that fails gives a warning and stops no other.
Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const OpenWith& with) {
  KA_TRY(check_texts(manifest));
  const std::vector<NamedFile> named = KA_TRY(named_files(manifest.streams));
  auto each = open_each(files, folder, named, with);
  std::vector<SurveyedFile> opened;
  Findings left_out;
  for (std::size_t i = 0; i < each.size(); ++i) {
    if (each[i]) {
      opened.push_back(*std::move(each[i]));
    } else if (is_interruption(each[i].error())) {
      // An interruption concerns all files, so it ends the whole call.
      return Failure(each[i].error());
    } else {
      left_out.push_back(
          {Severity::warning, each[i].error(), named[i].name() + " is left out", ""});
    }
  }
  for (const StreamOptions& options : manifest.streams) KA_TRY(start_together(options, opened));
  return OpenedInPart{KA_TRY(recording_of(manifest, std::move(opened))), std::move(left_out)};
}

Result<void> read_through(const Recording& recording, const Progress& progress) {
  std::vector<ReadNext> passes;
  std::uint64_t rows = 0, all = 0;
  for (const RecordedStream& stream : recording.streams) {
    // Streams whose findings are known were read to their ends already.
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
