// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/stream_write.h"

#include <span>

namespace kinalign {

namespace {

constexpr int decimals = 6;

void put_all(std::span<const double> values, TextOut& out) {
  for (const double value : values) out.number(',', value, decimals);
}

}  // namespace

Result<void> write_points(const PointStream& stream, TextOut& out) {
  out.text("time_ns");
  for (const std::string& joint : stream.joint_names) {
    for (const char* part : {"_x", "_y", "_z", "_state"}) out.text("," + joint + part);
  }
  KA_TRY(out.end_line());
  const PointFrames& frames = stream.frames;
  const std::size_t joints = stream.joint_names.size();
  for (std::size_t t = 0; t < frames.size(); ++t) {
    out.integer(to_ns(frames.stamps[t]));
    for (std::size_t i = t * joints; i < (t + 1) * joints; ++i) {
      put_all({&frames.positions[3 * i], 3}, out);
      out.text(",");
      out.integer(static_cast<std::int64_t>(frames.state[i]));
    }
    KA_TRY(out.end_line());
  }
  return {};
}

Result<void> write_node(const ImuStream& stream, TextOut& out) {
  const ImuContent& content = stream.content;
  out.text("time_ns");
  if (content.orientation) out.text(",qw,qx,qy,qz");
  if (content.acceleration) out.text(",ax,ay,az");
  if (content.angular_velocity) out.text(",gx,gy,gz");
  KA_TRY(out.end_line());
  const ImuSamples& samples = stream.samples;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (samples.valid[t] == 0) continue;
    out.integer(to_ns(samples.stamps[t]));
    if (content.orientation) put_all({&samples.orientation[4 * t], 4}, out);
    if (content.acceleration) put_all({&samples.acceleration[3 * t], 3}, out);
    if (content.angular_velocity) put_all({&samples.angular_velocity[3 * t], 3}, out);
    KA_TRY(out.end_line());
  }
  return {};
}

}  // namespace kinalign
