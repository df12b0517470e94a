// SPDX-License-Identifier: Apache-2.0
// Streams that are read from a recording of tests/recording/recorded_lab.h, and the errors of their
// stamps against the true times in their samples.
#pragma once

#include "tests/folder.h"
#include "tests/recording/recorded_lab.h"

#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace kinalign {

inline StreamOptions stream_named(const std::string& name, const std::string& path,
                                  const std::string& node = "") {
  StreamOptions options;
  options.name = name;
  options.files = {{path, node}};
  return options;
}

/// One stream, read once from beginning to end, with its late findings at the end of the others.
inline RecordedStream read_through_once(Recording recording) {
  REQUIRE(recording.streams.size() == 1);
  REQUIRE(read_through(recording));
  RecordedStream& stream = recording.streams.front();
  stream.findings = all_findings(stream);
  return std::move(stream);
}

inline RecordedStream opened(FileSystem& files, const StreamOptions& options) {
  auto recording = open_streams(files, {options});
  INFO(options.name);
  if (!recording) FAIL(recording.error().expected, ", found ", recording.error().found);
  return read_through_once(*std::move(recording));
}

/// The recording's file as a whole.
inline SharedFile opened_file(FileSystem& files, const StreamOptions& options) {
  auto recording = open_streams(files, {options});
  REQUIRE(recording);
  REQUIRE(recording->shared_files.size() == 1);
  return std::move(recording->shared_files.front());
}

/// The stream's warnings, each with its meaning.
inline std::vector<std::string> warnings(const RecordedStream& stream) {
  std::vector<std::string> texts;
  for (const Finding& finding : stream.findings) {
    if (finding.severity != Severity::warning) continue;
    texts.push_back(to_string(finding.what) + "; " + finding.meaning);
  }
  return texts;
}

/// Whether a note says that the stream's stamps are arrivals.
inline bool says_arrivals(const RecordedStream& stream) {
  return std::any_of(stream.findings.begin(), stream.findings.end(), [](const Finding& one) {
    return one.severity == Severity::note &&
           one.meaning ==
               "samples are stamped by their arrival, so the stamps are late by an unknown delay";
  });
}

/// The errors of a stream's stamps against the true times in its samples, ms.
struct Errors {
  double least = 1e9, most = -1e9, widest = 0.0;  // largest half-width, ms
  std::size_t samples = 0, certified = 0, outside = 0;

  void add(const RecordedStream& stream, Time stamp, double truth) {
    const auto error = take_time(stream.clock, stamp) - RecordedLab::utc(truth);
    const double ms = 1e-6 * static_cast<double>(error.count());
    least = std::min(least, ms);
    most = std::max(most, ms);
    ++samples;
    const auto half = half_width(stream.clock, stamp);
    if (!half) return;
    ++certified;
    widest = std::max(widest, 1e-6 * static_cast<double>(half->count()));
    // The truth is stored in single precision; an error of 4 us from that is not the clock's fault.
    outside += std::abs(error.count()) > half->count() + 4000 ? 1 : 0;
  }
};

template <class Input, class Truth>
Errors errors_of(const RecordedStream& stream, Truth truth) {
  auto pass = std::get<Input>(stream.data).passes();
  REQUIRE(pass);
  Errors errors;
  using Frames = std::conditional_t<
      std::is_same_v<Input, ClipInput>, ClipFrames,
      std::conditional_t<std::is_same_v<Input, PointInput>, PointFrames, ImuSamples>>;
  Frames block;
  for (;;) {
    const auto more = (*pass)(block);
    REQUIRE(more);
    if (!*more) return errors;
    for (std::size_t t = 0; t < block.size(); ++t) {
      errors.add(stream, block.stamps[t], truth(block, t));
    }
  }
}

inline Errors node_errors(const RecordedStream& stream) {
  return errors_of<ImuInput>(
      stream, [](const ImuSamples& s, std::size_t t) { return s.acceleration[3 * t]; });
}
inline Errors kinect_errors(const RecordedStream& stream) {
  return errors_of<PointInput>(
      stream, [](const PointFrames& f, std::size_t t) { return f.positions[25 * 3 * t]; });
}
inline Errors mocap_errors(const RecordedStream& stream) {
  return errors_of<ClipInput>(
      stream, [](const ClipFrames& f, std::size_t t) { return f.local_positions[59 * 3 * t]; });
}

}  // namespace kinalign
