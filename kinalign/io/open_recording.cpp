// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/open_recording.h"

#include "kinalign/core/file_version.h"
#include "kinalign/core/hash.h"
#include "kinalign/core/parallel.h"
#include "kinalign/io/bvh_survey.h"
#include "kinalign/io/formats.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

namespace kinalign {

namespace {

ClipInput input_of(const Skeleton& header, Passes<ClipFrames> passes) {
  return {header, std::move(passes)};
}
PointInput input_of(const PointHeader& header, Passes<PointFrames> passes) {
  return {header.joint_names, std::move(passes)};
}
ImuInput input_of(const ImuHeader& header, Passes<ImuSamples> passes) {
  return {header.node_names, header.content, std::move(passes)};
}

using Version = std::optional<FileVersion>;

/// A take names its inputs' hashes: every pass has to see the bytes that were hashed.
Result<void> unchanged(const std::string& path, const Version& version) {
  if (version_of(path) == version) return {};
  return Failure(Error{path, 0, "a file that stays as it is while it is read", "one that changed"});
}

/// A file in the middle of a pass.
template <class R>
struct Reading {
  InputFile file;
  Version version;
  std::unique_ptr<R> reader;
  bool ended = false;

  Result<bool> next(typename R::Frames& block) {
    block = {};
    while (block.size() == 0 && !ended) {
      const std::string_view piece = KA_TRY(file.next());
      KA_TRY(unchanged(file.path(), version));
      if (piece.empty()) {
        ended = true;
        KA_TRY(reader->finish(block));
      } else {
        KA_TRY(reader->feed(piece, block));
      }
    }
    return block.size() > 0;
  }
};

template <class R>
Passes<typename R::Frames> passes_of(FileSystem& files, std::string path, const Version& version,
                                     MakeReader make) {
  using Frames = typename R::Frames;
  return
      [&files, path = std::move(path), version, make = std::move(make)]() -> Result<Pass<Frames>> {
        auto reader = KA_TRY(make());
        auto reading = std::make_shared<Reading<R>>(
            Reading<R>{KA_TRY(InputFile::open(files, path)), version,
                       std::get<std::unique_ptr<R>>(std::move(reader)), false});
        return Pass<Frames>([reading](Frames& block) { return reading->next(block); });
      };
}

struct Job {
  FileSystem* files = nullptr;
  const StreamOptions* options = nullptr;
  const Progress* progress = nullptr;
  Version version;  // of the file, before it was opened
};

/// The first pass: hashes the file and surveys its stamps, rows are thrown away.
template <class R>
Result<RecordedStream> survey(const Job& job, InputFile file, std::string_view head,
                              const FoundFormat& format, std::unique_ptr<R> reader) {
  Sha256 hash;
  StampSurveyor surveyor;
  typename R::Frames block;
  std::uint64_t bytes = 0;
  std::string_view piece = head;
  while (!piece.empty()) {
    bytes += piece.size();
    hash.update(piece);
    KA_TRY(reader->feed(piece, block));
    surveyor.add(block.stamps);
    block = {};
    if (!go_on(*job.progress, "reading", bytes, file.size())) {
      return Failure(interruption(file.path()));
    }
    piece = KA_TRY(file.next());
  }
  KA_TRY(reader->finish(block));
  surveyor.add(block.stamps);
  RecordedStream out;
  out.name = job.options->name;
  out.data =
      input_of(*reader->header(), passes_of<R>(*job.files, file.path(), job.version, format.make));
  out.survey = surveyor.result();
  out.files.push_back({std::string(file_name(file.path())), hash.hex(), bytes});
  out.findings = std::move(reader->findings);
  return out;
}

Result<InputFacts> facts_of(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  Sha256 hash;
  std::uint64_t bytes = 0;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    if (piece.empty()) return InputFacts{std::string(file_name(path)), hash.hex(), bytes};
    bytes += piece.size();
    hash.update(piece);
  }
}

/// A BVH stamped from a click on record and, where it is known, a click on stop.
Findings judge_clicks(const StreamOptions& options, const RecordedStream& s) {
  if (!options.start_ns || !options.end_ns || !s.step_ns) return {};
  const double between = 1e-9 * static_cast<double>(*options.end_ns - *options.start_ns);
  const double stated = 1e-9 * *s.step_ns * static_cast<double>(s.survey.samples);
  if (std::abs(between - stated) <= 2e-9 * *s.step_ns) return {};
  return {{Severity::warning,
           Error{s.files.front().name, 0, fmt::format("{:.3f} s between the clicks", between),
                 fmt::format("{} frames of {:.6g} s, {:.3f} s", s.survey.samples, 1e-9 * *s.step_ns,
                             stated)},
           "stamps are counted from the first click by the file's step",
           "the true step may differ from the file's, or frames are missing"}};
}

Result<RecordedStream> survey_file(const Job& job, const StreamFile& named) {
  InputFile file = KA_TRY(InputFile::open(*job.files, named.path));
  const std::string head(KA_TRY(file.next()));
  const FoundFormat format = KA_TRY(find_format(*job.files, *job.options, named, head));
  RecordedStream out;
  if (format.name == "bvh") {
    const BvhSurvey made =
        KA_TRY(survey_bvh(*job.files, named.path, bvh_options(*job.options), *job.progress));
    out.name = job.options->name;
    out.survey = made.survey;
    out.step_ns = made.step_ns;
    out.files.push_back(made.facts);
    out.findings = made.findings;
    out.data = input_of(made.skeleton,
                        passes_of<ClipReader>(*job.files, named.path, job.version, format.make));
    const Findings clicks = judge_clicks(*job.options, out);
    out.findings.insert(out.findings.end(), clicks.begin(), clicks.end());
  } else {
    AnyReader reader = KA_TRY(format.make());
    out = KA_TRY(std::visit(
        [&](auto& any) { return survey(job, std::move(file), head, format, std::move(any)); },
        reader));
  }
  for (const std::string& further : format.further_files) {
    out.files.push_back(KA_TRY(facts_of(*job.files, further)));
  }
  return out;
}

TimeModel clock_of(const StreamOptions& options, const StampSurvey& survey) {
  TimeModel model = options.clock == "shared" ? shared_clock() : TimeModel{};
  TimeModelPiece& piece = model.pieces.front();
  piece.begin = survey.first;
  piece.offset = Duration{std::llround(options.offset_ms * 1e6)};
  piece.drift_ppm = options.drift_ppm;
  if (options.interval_ms) piece.half_width = Duration{std::llround(*options.interval_ms * 1e6)};
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
};

Result<RecordedStream> open_file(FileSystem& files, const NamedFile& named,
                                 const Progress& progress) {
  const Job job{&files, named.options, &progress, version_of(named.file->path)};
  RecordedStream stream = KA_TRY(survey_file(job, *named.file));
  stream.clock = clock_of(*named.options, stream.survey);
  return stream;
}

}  // namespace

Result<std::vector<RecordedStream>> open_streams(FileSystem& files,
                                                 const std::vector<StreamOptions>& streams,
                                                 const Progress& progress, std::size_t jobs) {
  std::vector<NamedFile> named;
  for (const StreamOptions& options : streams) {
    if (options.files.empty()) {
      return Failure(Error{"", 0, "a file for stream '" + options.name + "'", "none"});
    }
    for (const StreamFile& file : options.files) named.push_back({&options, &file});
  }
  SharedProgress shared(progress, named.size());
  std::vector<Result<RecordedStream>> opened(named.size());
  parallel_for(named.size(), jobs,
               [&](std::size_t i) { opened[i] = open_file(files, named[i], shared.part(i)); });
  std::vector<RecordedStream> out;
  out.reserve(opened.size());
  for (auto& stream : opened) out.push_back(KA_TRY(std::move(stream)));
  return out;
}

Result<Recording> open_recording(FileSystem& files, const Manifest& manifest,
                                 const std::string& folder, const Progress& progress,
                                 std::size_t jobs) {
  std::vector<StreamOptions> streams = manifest.streams;
  for (StreamOptions& options : streams) {
    for (StreamFile& file : options.files) {
      if (!file.path.starts_with('/')) file.path = folder + file.path;
    }
    if (options.layout.ends_with(".toml") && !options.layout.starts_with('/')) {
      options.layout = folder + options.layout;
    }
  }
  Recording recording;
  recording.subject = manifest.subject;
  recording.action = manifest.action;
  recording.streams = KA_TRY(open_streams(files, streams, progress, jobs));
  return recording;
}

}  // namespace kinalign
