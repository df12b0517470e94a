// SPDX-License-Identifier: Apache-2.0
#include "kinalign/sources/open_recording.h"

#include "kinalign/core/parallel.h"
#include "kinalign/core/utf8.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/sources/stream_survey.h"
#include "kinalign/take/remembered_path.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

namespace kinalign {

namespace {

TimeModel clock_of(const StreamOptions& options, const StampSurvey& survey) {
  TimeModel model = options.clock == "shared" ? shared_clock() : TimeModel{};
  TimeModelPiece& piece = model.pieces.front();
  piece.begin = survey.first;
  piece.offset = Duration{std::llround(options.offset_ms * 1e6)};
  piece.drift_ppm = options.drift_ppm;
  if (options.interval_ms) piece.half_width = Duration{std::llround(*options.interval_ms * 1e6)};
  return model;
}

/// What a recording says of a clock, with a delay that its user knows.
TimeModel moved_by(TimeModel model, const StreamOptions& options) {
  const Duration by{std::llround(options.offset_ms * 1e6)};
  for (TimeModelPiece& piece : model.pieces) piece.offset += by;
  return model;
}

/// Files read side by side, told as one job.
class SharedProgress {
 public:
  SharedProgress(const Progress& progress, std::size_t parts)
      : progress_(progress), parts_(parts) {}

  Progress part(std::size_t i) {
    if (!progress_) return {};
    return [this, i](std::string_view what, std::uint64_t done, std::uint64_t total) {
      const std::lock_guard lock(mutex_);
      parts_[i] = {done, total};
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

/// A file of a stream.
struct NamedFile {
  const StreamOptions* options = nullptr;
  const StreamFile* file = nullptr;
  std::string name() const { return options->name + (file->node.empty() ? "" : " " + file->node); }
};

/// With paths as a manifest in `folder` has them.
Result<SurveyedFile> open_file(FileSystem& files, const std::string& folder, const NamedFile& named,
                               const Progress& progress) {
  StreamOptions options = *named.options;
  if (options.own_layout()) options.layout = path_in(folder, options.layout);
  if (!options.skeleton.empty()) options.skeleton = path_in(folder, options.skeleton);
  if (options.files.size() > 1) options.start_ns.reset();  // start_together
  const StreamFile file{path_in(folder, named.file->path), named.file->node};
  const SurveyJob job{&files, &options, &progress, version_of(file.path)};
  SurveyedFile out = KA_TRY(survey_file(job, file));
  for (std::size_t i = 0; i < out.paths.size(); ++i) {
    const std::string* as_named = &named.file->path;
    if (i > 0 && out.paths[i] == options.layout) as_named = &named.options->layout;
    if (i > 0 && out.paths[i] == options.skeleton) as_named = &named.options->skeleton;
    out.stream.files[i].name = remembered_path(folder, *as_named, out.paths[i]);
  }
  out.stream.clock =
      out.clock ? moved_by(*out.clock, options) : clock_of(options, out.stream.survey);
  return out;
}

/// Of two files that a take would call by one name, `rebuild` could not tell which is which, and a
/// name that is no text it could not find.
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
      if (fresh || at->second.facts->sha256 == facts.sha256) continue;
      return Failure(Error{each.paths[i], 0,
                           "files that a take can tell apart by name (below the manifest's folder: "
                           "by their paths), so rename one or move both there",
                           "'" + shown(facts.name) + "' again: " + *at->second.path});
    }
  }
  return {};
}

/// Files of one stream share an axis: where start_ns is given, the earliest sample of all has it.
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
    if (std::abs(shift) > furthest_stamp_ns ||
        last > furthest_stamp_ns - std::max<std::int64_t>(0, shift)) {
      return Failure(Error{each.paths.front(), 0, "a stamp inside +-4e18 ns",
                           std::to_string(last) + " ns, to be moved by " + std::to_string(shift)});
    }
    each.stream.clock.pieces.front().offset += Duration{shift};
  }
  return {};
}

/// What a user calls subject, action, streams and nodes stands in the take.
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

/// Nodes' files share a layout: one stream names it once.
void drop_repeated(std::vector<SurveyedFile>& opened) {
  for (std::size_t i = 0; i < opened.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (opened[k].stream.name != opened[i].stream.name) continue;
      const auto& before = opened[k].stream.files;
      const auto repeated = [&before](const InputFacts& facts) {
        const auto same = [&](const InputFacts& other) { return other.name == facts.name; };
        return std::any_of(before.begin(), before.end(), same);
      };
      auto& files = opened[i].stream.files;
      files.erase(std::remove_if(files.begin() + 1, files.end(), repeated), files.end());
    }
  }
}

/// Their files.
Result<std::vector<NamedFile>> named_files(const std::vector<StreamOptions>& streams) {
  std::vector<NamedFile> named;
  for (const StreamOptions& options : streams) {
    if (options.files.empty()) {
      return Failure(Error{"", 0, "a file for stream '" + options.name + "'", "none"});
    }
    for (const StreamFile& file : options.files) named.push_back({&options, &file});
  }
  return named;
}

/// Side by side; what becomes of each.
std::vector<Result<SurveyedFile>> open_each(FileSystem& files, const std::string& folder,
                                            const std::vector<NamedFile>& named,
                                            const Progress& progress, std::size_t jobs) {
  SharedProgress shared(progress, named.size());
  std::vector<Result<SurveyedFile>> opened(named.size());
  parallel_for(named.size(), jobs, [&](std::size_t i) {
    opened[i] = open_file(files, folder, named[i], shared.part(i));
  });
  return opened;
}

Result<std::vector<SurveyedFile>> open_all(FileSystem& files, const std::string& folder,
                                           const std::vector<StreamOptions>& streams,
                                           const Progress& progress, std::size_t jobs) {
  auto opened = open_each(files, folder, KA_TRY(named_files(streams)), progress, jobs);
  std::vector<SurveyedFile> out;
  out.reserve(opened.size());
  for (auto& one : opened) out.push_back(KA_TRY(std::move(one)));
  for (const StreamOptions& options : streams) KA_TRY(start_together(options, out));
  return out;
}

std::vector<RecordedStream> streams_of(std::vector<SurveyedFile> opened) {
  drop_repeated(opened);
  std::vector<RecordedStream> out;
  out.reserve(opened.size());
  for (SurveyedFile& one : opened) out.push_back(std::move(one.stream));
  return out;
}

/// Fails where a take could not name the files.
Result<Recording> recording_of(const Manifest& manifest, std::vector<SurveyedFile> opened) {
  KA_TRY(check_names(opened));
  return Recording{manifest.subject, manifest.action, streams_of(std::move(opened))};
}

}  // namespace

Result<std::vector<RecordedStream>> open_streams(FileSystem& files,
                                                 const std::vector<StreamOptions>& streams,
                                                 const Progress& progress, std::size_t jobs) {
  return streams_of(KA_TRY(open_all(files, "", streams, progress, jobs)));
}

Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const Progress& progress,
                                 std::size_t jobs) {
  KA_TRY(check_texts(manifest));
  auto opened = KA_TRY(open_all(files, folder, manifest.streams, progress, jobs));
  return recording_of(manifest, std::move(opened));
}

Result<OpenedInPart> open_what_can_be(FileSystem& files, const Manifest& manifest,
                                      const std::string& folder, const Progress& progress,
                                      std::size_t jobs) {
  KA_TRY(check_texts(manifest));
  const std::vector<NamedFile> named = KA_TRY(named_files(manifest.streams));
  auto each = open_each(files, folder, named, progress, jobs);
  std::vector<SurveyedFile> opened;
  Findings left_out;
  for (std::size_t i = 0; i < each.size(); ++i) {
    if (each[i]) {
      opened.push_back(*std::move(each[i]));
    } else if (is_interruption(each[i].error())) {
      return Failure(each[i].error());
    } else {
      left_out.push_back(
          {Severity::warning, each[i].error(), named[i].name() + " is left out", ""});
    }
  }
  for (const StreamOptions& options : manifest.streams) KA_TRY(start_together(options, opened));
  return OpenedInPart{KA_TRY(recording_of(manifest, std::move(opened))), std::move(left_out)};
}

}  // namespace kinalign
