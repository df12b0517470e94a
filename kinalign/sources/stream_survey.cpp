// SPDX-License-Identifier: Apache-2.0
#include "kinalign/sources/stream_survey.h"

#include "kinalign/check/judge_survey.h"
#include "kinalign/check/value_survey.h"
#include "kinalign/core/file_version.h"
#include "kinalign/core/hash.h"
#include "kinalign/core/utf8.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/input_facts.h"

#include <memory>
#include <utility>

namespace kinalign {

namespace {

ClipInput input_of(const Skeleton& header, Passes<ClipFrames> passes) {
  return {header, std::move(passes)};
}
/// Converts names to UTF-8, because takes store UTF-8 and older files may have other encodings.
std::vector<std::string> all_as_utf8(std::vector<std::string> names) {
  for (std::string& name : names) name = as_utf8(name);
  return names;
}
PointInput input_of(const PointHeader& header, Passes<PointFrames> passes) {
  return {all_as_utf8(header.joint_names), std::move(passes)};
}
ImuInput input_of(const ImuHeader& header, Passes<ImuSamples> passes) {
  return {all_as_utf8(header.node_names), header.content, std::move(passes)};
}

using Version = std::optional<FileVersion>;

/// A file during a pass. All copies of a pass share one Reading, and thus the position in the file.
template <class R>
struct Reading {
  InputFile file;
  Version version;
  std::unique_ptr<R> reader;
  bool ended = false;

  Result<bool> next(typename R::Frames& block) {
    // A piece of a file may contain no complete row. A pass must not return an empty block, so
    // several pieces may be read.
    block = {};
    while (block.size() == 0 && !ended) {
      const std::string_view piece = KA_TRY(file.next());
      // The version is checked after each piece, because the file may change while it is read.
      KA_TRY(unchanged(file.path(), version));
      if (!piece.empty()) {
        KA_TRY(reader->feed(piece, block));
      } else {
        ended = true;
        KA_TRY(reader->finish(block));
      }
    }
    return block.size() > 0;
  }
};

/// Returns a function that starts passes over a file, each with a new reader. A pass fails if the
/// file has changed since the survey.
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

/// The first pass: hashes the file and surveys stamps and values. Rows are not stored.
template <class R>
Result<RecordedStream> survey(InputFile& file, std::string_view head, std::unique_ptr<R> reader,
                              Passes<typename R::Frames> passes, const Progress& progress) {
  Sha256 hash;
  StampSurveyor surveyor;
  typename R::Frames block;
  auto sizes = sizes_of(block);
  const auto take_block = [&] {
    // The block is emptied after each piece, so memory does not grow with the file.
    surveyor.add(block.stamps);
    sizes.add(block);
    block = {};
  };
  std::uint64_t bytes = 0;
  // The first piece was already read to find the format. The pass begins with it.
  std::string_view piece = head;
  while (!piece.empty()) {
    bytes += piece.size();
    hash.update(piece);
    KA_TRY(reader->feed(piece, block));
    take_block();
    if (!go_on(progress, "reading", bytes, file.size())) {
      return Failure(interruption(file.path()));
    }
    piece = KA_TRY(file.next());
  }
  KA_TRY(reader->finish(block));
  take_block();
  RecordedStream out;
  // Whether the file has stamps, and what its header states, is known only after reading.
  out.counted = reader->counted;
  out.data = input_of(*reader->header(), std::move(passes));
  out.survey = surveyor.result();
  out.files.push_back({std::string(file_name(file.path())), hash.hex(), bytes});
  out.findings = std::move(reader->findings);
  append(out.findings, sizes.judge(*reader->header(), file.path()));
  return out;
}

/// Returns the stream of a skeleton format that has its own first pass. A BVH has no stamps, so
/// stamps are counted by its frame time.
RecordedStream clip_stream(const StreamOptions& options, const ClipSurvey& made,
                           Passes<ClipFrames> passes) {
  RecordedStream out;
  out.survey = made.survey;
  out.counted = true;
  out.step_ns = made.step_ns;
  out.files.push_back(made.facts);
  out.findings = made.findings;
  out.data = input_of(made.skeleton, std::move(passes));
  // The clicks are in the user's manifest, which the reader does not know, so they are judged here.
  append(out.findings, judge_survey(made, options));
  return out;
}

/// Returns passes over a device's stream. The first pass that reaches the end stores the findings
/// about values.
template <class Frames>
Passes<Frames> device_passes(DevicePasses<Frames> passes,
                             typename DevicePass<Frames>::Header header, std::string path,
                             const std::shared_ptr<std::optional<Findings>>& late) {
  struct Reading {
    DevicePass<Frames> pass;
    decltype(sizes_of(Frames())) sizes;
  };
  return [=]() -> Result<Pass<Frames>> {
    auto reading = std::make_shared<Reading>(Reading{passes(), sizes_of(Frames())});
    return Pass<Frames>([=](Frames& block) -> Result<bool> {
      if (KA_TRY(reading->pass.next(block))) {
        reading->sizes.add(block);
        return true;
      }
      // Several passes may reach the end. All have the same findings, so only the first ones are
      // stored.
      if (*late) return false;
      Findings found = reading->pass.findings();
      append(found, reading->sizes.judge(header, path));
      *late = std::move(found);
      return false;
    });
  };
}

}  // namespace

Result<SurveyedFile> survey_file(FileSystem& files, const StreamOptions& options,
                                 const StreamFile& named, const Progress& progress) {
  // The version is read before the file is opened, so that later passes notice a change during the
  // first pass.
  const Version version = version_of(named.path);
  InputFile file = KA_TRY(InputFile::open(files, named.path));
  const std::string head(KA_TRY(file.next()));
  const FoundFormat format = KA_TRY(find_format(files, options, named, head));
  SurveyedFile out;
  out.paths = {named.path};
  if (format.survey) {
    out.stream = clip_stream(options, KA_TRY(format.survey(progress)),
                             passes_of<ClipReader>(files, named.path, version, format.make));
  } else {
    AnyReader any = KA_TRY(format.make());
    out.stream = KA_TRY(std::visit(
        [&]<class R>(std::unique_ptr<R>& reader) {
          return survey(file, head, std::move(reader),
                        passes_of<R>(files, named.path, version, format.make), progress);
        },
        any));
  }
  out.stream.name = options.name;
  out.stream.format = format.name;
  // Files that the reader opens itself are inputs too, so the take stores their names and hashes.
  for (const std::string& further : format.further_files) {
    out.stream.files.push_back(KA_TRY(facts_of(files, further, "reading", progress)));
    out.paths.push_back(further);
  }
  return out;
}

Result<SurveyedFile> survey_device(FileSystem& files, const StreamOptions& options,
                                   const StreamFile& named,
                                   const std::shared_ptr<RecordingSource>& recording,
                                   const Progress& progress) {
  DeviceStream made = KA_TRY(recording->stream(options, named, progress));
  SurveyedFile out;
  out.recording = recording;
  out.clock = std::move(made.clock);
  RecordedStream& stream = out.stream;
  stream.name = options.name;
  stream.format = "recording";
  stream.survey = made.survey;
  // The stamps are needed to count the rows of the take's grid (align/plan.cpp). A stream of nodes
  // is never the grid.
  if (!std::holds_alternative<ImuHeader>(made.header)) stream.stamps = std::move(made.stamps);
  stream.findings = std::move(made.findings);
  stream.late_findings = std::make_shared<std::optional<Findings>>();
  std::visit(
      // The call is made for the kind of the stream; passes and header have the same kind.
      [&]<class Frames>(const DevicePasses<Frames>& passes) {
        const auto& header = std::get<typename DevicePass<Frames>::Header>(made.header);
        stream.data = input_of(
            header, device_passes<Frames>(passes, header, named.path, stream.late_findings));
      },
      made.passes);
  // An empty stream is read to its end now, because its findings tell why it is empty.
  if (stream.survey.samples == 0) {
    KA_TRY(std::visit(
        [&stream](const auto& input) -> Result<void> {
          std::uint64_t rows = 0;
          const ReadNext next = read_on(KA_TRY(input.passes()), stream.clock, rows);
          while (KA_TRY(next())) {
          }
          return {};
        },
        stream.data));
  }
  for (std::size_t i = 0; i < recording->facts().size(); ++i) {
    stream.files.push_back(recording->facts()[i]);
    out.paths.push_back(recording->parts()[i].path);
  }
  if (!options.skeleton.empty()) {
    stream.files.push_back(KA_TRY(facts_of(files, options.skeleton, "reading", progress)));
    out.paths.push_back(options.skeleton);
  }
  return out;
}

}  // namespace kinalign
