// SPDX-License-Identifier: Apache-2.0
// Alignment into memory: slabs put together.
#include "kinalign/align/align.h"

namespace kinalign {

namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(SampleDistance& to, const SampleDistance& from) {
  append(to.nearest_raw_ns, from.nearest_raw_ns);
  append(to.time_interval_ns, from.time_interval_ns);
}

void append(ClipRows& to, const ClipRows& from) {
  append(to.positions, from.positions);
  append(to.local_positions, from.local_positions);
  append(to.local_rotations, from.local_rotations);
  append(to.valid, from.valid);
  append(to.distance, from.distance);
}

void append(PointRows& to, const PointRows& from) {
  append(to.positions, from.positions);
  append(to.state, from.state);
  append(to.valid, from.valid);
  append(to.distance, from.distance);
}

void append(ImuRows& to, const ImuRows& from) {
  append(to.orientation, from.orientation);
  append(to.acceleration, from.acceleration);
  append(to.angular_velocity, from.angular_velocity);
  append(to.valid, from.valid);
  append(to.distance, from.distance);
}

}  // namespace

Result<Take> align(const Recording& recording, const Manifest& manifest) {
  Take take;
  TakeSink sink;
  sink.begin = [&take](const TakeHeader& header) -> Result<void> {
    take.header = header;
    return {};
  };
  sink.rows = [&take](const TakeSlab& slab) -> Result<void> {
    append(take.all.stamps, slab.stamps);
    if (take.all.rows.empty()) {
      take.all.rows = slab.rows;
      return {};
    }
    for (std::size_t g = 0; g < slab.rows.size(); ++g) {
      std::visit([&](auto& to) { append(to, std::get<std::decay_t<decltype(to)>>(slab.rows[g])); },
                 take.all.rows[g]);
    }
    return {};
  };
  take.report = KA_TRY(align(recording, manifest, sink));
  return take;
}

}  // namespace kinalign
