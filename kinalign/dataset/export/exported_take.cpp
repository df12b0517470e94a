// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/exported_take.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::uint64_t slab_rows = 1024;
// The date of a released take. It is after 1990, so BIDS and other formats accept it as a date.
constexpr Time no_date = utc_time(946'684'800'000'000'000);  // 2000-01-01T00:00:00Z

/// The joints of a skeleton as points.
PointFrames frames_of(const std::vector<Time>& stamps, const ClipRows& rows) {
  PointFrames out{stamps, rows.positions, {}};
  const std::size_t joints = rows.positions.size() / 3 / stamps.size();
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const bool valid = rows.valid.empty() || rows.valid[i] != 0;
    out.state.insert(out.state.end(), joints, valid ? Tracking::tracked : Tracking::missing);
  }
  return out;
}

/// The points with their states; an invalid cell counts as missing, whatever its state.
PointFrames frames_of(const std::vector<Time>& stamps, const PointRows& rows) {
  PointFrames out{stamps, rows.positions, rows.state};
  for (std::size_t i = 0; i < rows.valid.size(); ++i) {
    if (rows.valid[i] == 0) out.state[i] = Tracking::missing;
  }
  return out;
}

}  // namespace

Result<ExportedTake> ExportedTake::open(FileSystem& files, const std::string& path, TakeName name,
                                        double rate_hz, bool without_date) {
  ExportedTake out(KA_TRY(TakeReader::open(files, path)), std::move(name), rate_hz);
  // A take without rows has no first stamp to move.
  if (out.header().frames == 0) return out;
  // The first stamp decides by how much all stamps are moved.
  KA_TRY(out.reader_.read(0, 1, out.slab_));
  if (without_date) out.moved_ = no_date - out.slab_.stamps.front();
  out.first_ = out.slab_.stamps.front() + out.moved_;
  return out;
}

Result<void> ExportedTake::rows(const std::function<Result<void>(const TakeSlab&)>& use) {
  const std::uint64_t frames = header().frames;
  for (std::uint64_t first = 0; first < frames; first += slab_rows) {
    KA_TRY(reader_.read(first, std::min(slab_rows, frames - first), slab_));
    // All stamps are moved by the same time, so the intervals between them stay.
    for (Time& stamp : slab_.stamps) stamp += moved_;
    KA_TRY(use(slab_));
  }
  return {};
}

Result<void> ExportedTake::clip_frames(std::size_t group,
                                       const std::function<Result<void>(const ClipFrames&)>& use) {
  return rows([&](const TakeSlab& slab) {
    const auto& rows = std::get<ClipRows>(slab.rows[group]);
    return use({slab.stamps, rows.local_positions, rows.local_rotations});
  });
}

Result<void> ExportedTake::point_frames(
    std::size_t group, const std::function<Result<void>(const PointFrames&)>& use) {
  return rows([&](const TakeSlab& slab) {
    // For formats without skeletons, a skeleton's joints are points.
    const auto* clip = std::get_if<ClipRows>(&slab.rows[group]);
    return use(clip != nullptr ? frames_of(slab.stamps, *clip)
                               : frames_of(slab.stamps, std::get<PointRows>(slab.rows[group])));
  });
}

Result<void> ExportedTake::node_samples(std::size_t group,
                                        const std::function<Result<void>(const ImuSamples&)>& use) {
  return rows([&](const TakeSlab& slab) {
    const auto& rows = std::get<ImuRows>(slab.rows[group]);
    return use(
        {slab.stamps, rows.orientation, rows.acceleration, rows.angular_velocity, rows.valid});
  });
}

}  // namespace kinalign
