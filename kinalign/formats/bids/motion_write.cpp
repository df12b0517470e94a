// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/motion_write.h"

#include "kinalign/formats/bids/json_text.h"
#include "kinalign/formats/row_stamps.h"

#include <nlohmann/json.hpp>

#include <array>
#include <set>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// The directions of the x, y and z axes from the view of the person at the start: left, up,
// forwards.
constexpr const char* spatial_axes = "LSA";
constexpr int six = 6, nine = 9;  // numbers of decimals

/// A joint's position (m) and rotation in the space of the skeleton's root.
struct Global {
  Vec3 place;
  Quat turn;
};

/// Computes the global pose of frame t. A root's local values are global already. A parent comes
/// before its children, so one loop is enough.
std::vector<Global> global_of(const Skeleton& skeleton, const ClipFrames& frames, std::size_t t) {
  std::vector<Global> out(skeleton.joints());
  for (std::size_t j = 0; j < out.size(); ++j) {
    const std::size_t cell = t * out.size() + j;
    const Vec3 place = vec3(frames.local_positions, cell);
    const Quat turn = quat(frames.local_rotations, cell);
    if (skeleton.parents[j] < 0) {
      out[j] = {place, turn};
      continue;
    }
    const Global& parent = out[static_cast<std::size_t>(skeleton.parents[j])];
    out[j] = {parent.place + parent.turn * place, (parent.turn * turn).normalized()};
  }
  return out;
}

/// The text of channels.json, with the reference frames that occur in the channels. spatial_axes
/// are the axes of the frame "global".
std::string channels_json(const std::vector<BidsChannel>& channels) {
  // Only frames that occur are described.
  std::set<std::string> used;
  for (const BidsChannel& channel : channels) used.insert(channel.reference_frame);
  Json levels;
  if (used.contains("global")) {
    levels["global"] = {{"Description", "the room, the same for all channels of this frame"},
                        {"SpatialAxes", spatial_axes},
                        {"RotationRule", "right-hand"}};
  }
  if (used.contains("sensor")) {
    levels["sensor"] = {{"Description", "each sensor's own axes, which move with it"},
                        {"RotationRule", "right-hand"}};
  }
  const Json frame = {{"LongName", "reference frame"},
                      {"Description", "the space in which a channel's values stand"},
                      {"Levels", levels}};
  return bids_json_text({{"reference_frame", frame}});
}

}  // namespace

BidsMotionWriter::BidsMotionWriter(BidsSource source, TextOut& out)
    : source_(std::move(source)), channels_(bids_channels(source_)), out_(&out) {}

void BidsMotionWriter::begin_row(Time stamp) {
  if (rows_++ == 0) {
    // The remainder of a negative number is negative, so 1000 is added.
    const std::int64_t ns = to_ns(stamp), below = ((ns % 1000) + 1000) % 1000;
    // acq_time has microseconds, so the latencies count from a whole microsecond.
    onset_ = utc_time(ns - below);
  }
  last_ = stamp;
  // The latency is the first column.
  out_->text(seconds_text((stamp - onset_).count()));
}

void BidsMotionWriter::put(std::span<const double> values, int decimals, bool present) {
  for (const double value : values) {
    if (present) {
      out_->number('\t', value, decimals);
    } else {
      out_->text("\tn/a");
    }
  }
}

Result<void> BidsMotionWriter::append(const ClipFrames& frames) {
  // The constructor determines the kind of the source. A block of another kind throws an exception.
  const Skeleton& skeleton = std::get<Skeleton>(source_);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    begin_row(frames.stamps[t]);
    for (const Global& joint : global_of(skeleton, frames, t)) {
      // A clip has no missing joints.
      put({joint.place.data(), 3}, six, true);
      put(std::array{joint.turn.w(), joint.turn.x(), joint.turn.y(), joint.turn.z()}, nine, true);
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

Result<void> BidsMotionWriter::append(const PointFrames& frames) {
  const std::size_t points = std::get<PointHeader>(source_).joint_names.size();
  for (std::size_t t = 0; t < frames.size(); ++t) {
    begin_row(frames.stamps[t]);
    for (std::size_t i = t * points; i < (t + 1) * points; ++i) {
      put({&frames.positions[3 * i], 3}, six, frames.state[i] != Tracking::missing);
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

Result<void> BidsMotionWriter::append(const ImuSamples& samples) {
  const ImuHeader& nodes = std::get<ImuHeader>(source_);
  const std::size_t count = nodes.node_names.size();
  for (std::size_t t = 0; t < samples.size(); ++t) {
    begin_row(samples.stamps[t]);
    for (std::size_t i = t * count; i < (t + 1) * count; ++i) {
      const bool valid = samples.valid[i] != 0;
      if (nodes.content.orientation) put({&samples.orientation[4 * i], 4}, nine, valid);
      if (nodes.content.acceleration) put({&samples.acceleration[3 * i], 3}, six, valid);
      if (nodes.content.angular_velocity) put({&samples.angular_velocity[3 * i], 3}, six, valid);
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

BidsSidecars BidsMotionWriter::sidecars(const BidsSystemFacts& facts) const {
  Json motion;
  motion["TaskName"] = facts.task_name;
  const auto add = [&motion](const char* key, const std::string& text) {
    if (!text.empty()) motion[key] = text;
  };
  add("TaskDescription", facts.task_description);
  motion["TrackingSystemName"] = facts.system_name;
  add("Manufacturer", facts.manufacturer);
  add("ManufacturersModelName", facts.model);
  add("SoftwareVersions", facts.software_versions);
  motion["SamplingFrequency"] = facts.rate_hz;
  const double seconds = 1e-9 * static_cast<double>((last_ - onset_).count());
  // A single row has no rate.
  if (rows_ > 1 && seconds > 0.0) {
    motion["SamplingFrequencyEffective"] = static_cast<double>(rows_ - 1) / seconds;
  }
  // Each row, including the last one, lasts one sample period.
  if (facts.rate_hz > 0.0) motion["RecordingDuration"] = seconds + 1.0 / facts.rate_hz;
  motion["MissingValues"] = "n/a";
  // All counts are written, even if they are 0.
  for (const auto& [key, count] : bids_counts(channels_)) motion[key] = count;
  return {write_tsv(channels_table(channels_)), channels_json(channels_), bids_json_text(motion),
          onset_};
}

}  // namespace kinalign
