// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/recording.h"

#include "kinalign/take/manifest.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace kinalign {

namespace {

/// Rounds the step to an integer. The limit prevents overflow when a few steps are added.
std::int64_t step_of(double ns) {
  constexpr double longest = 1e18;
  return std::llround(std::min(ns, longest));
}

}  // namespace

Time first_of(const RecordedStream& s) { return take_time(s.clock, s.survey.first); }
Time last_of(const RecordedStream& s) { return take_time(s.clock, s.survey.last); }

std::string stream_label(const RecordedStream& s) {
  const auto* imu = std::get_if<ImuInput>(&s.data);
  // A stream of several nodes is labelled with its own name.
  const bool one = imu != nullptr && imu->node_names.size() == 1;
  return one ? s.name + " " + shown(imu->node_names.front()) : s.name;
}

std::int64_t usual_step_ns(const RecordedStream& s, const StreamOptions& options) {
  if (options.rate_hz > 0.0) return step_of(1e9 / options.rate_hz);
  return step_of(s.step_ns.value_or(static_cast<double>(s.survey.median_step_ns)));
}

Findings all_findings(const RecordedStream& stream) {
  Findings all = stream.findings;
  if (stream.late_findings && *stream.late_findings) append(all, **stream.late_findings);
  return all;
}

const SharedFile* newly_read_file(const Recording& recording, std::size_t stream) {
  const auto file = recording.streams[stream].shared_file;
  // Only earlier streams are searched, so that the marks and findings of a file are reported once,
  // for its first stream.
  const auto begin = recording.streams.begin();
  const bool is_known = std::any_of(begin, begin + static_cast<std::ptrdiff_t>(stream),
                                    [&](const RecordedStream& s) { return s.shared_file == file; });
  return file && !is_known ? &recording.shared_files[*file] : nullptr;
}

Result<void> read_side_by_side(const std::vector<ReadNext>& passes,
                               const std::function<Result<void>()>& go) {
  // The pass with the earliest stamp comes first. A pass that has ended is not inserted again. At
  // the beginning the passes have the order of their indices.
  // The newest stamp of each pass, and the index of the pass.
  std::set<std::pair<std::int64_t, std::size_t>> reached;
  for (std::size_t i = 0; i < passes.size(); ++i) reached.emplace(INT64_MIN, i);
  while (!reached.empty()) {
    const std::size_t i = reached.extract(reached.begin()).value().second;
    if (const auto at = KA_TRY(passes[i]())) reached.emplace(*at, i);
    KA_TRY(go());
  }
  return {};
}

}  // namespace kinalign
