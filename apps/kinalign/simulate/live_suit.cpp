// SPDX-License-Identifier: Apache-2.0
// Stream 121 of the seed draws the delay of the suit's program: counter the frame's number, lane 0.
#include "apps/kinalign/simulate/live_suit.h"

#include "kinalign/protocols/noitom/frame.h"

#include <algorithm>

namespace kinalign {

/// Plans the first frame, so that next() is right before work().
LiveSuit::LiveSuit(const Motion& motion, const MocapRun& run, std::uint64_t seed, HostTime start,
                   LiveSocket socket)
    : motion_(motion),
      run_(run),
      random_(seed, 121),
      start_(start),
      socket_(std::move(socket)),
      channels_(motion.skeleton, BvhChannels::Positions::of_all) {
  plan();
}

void LiveSuit::work(HostTime now) {
  // Several frames may be due after a long sleep. All of them are sent, since a suit skips none.
  while (next_ <= now) {
    worst_late_ = std::max(worst_late_, now - next_);
    if (socket_.send(datagram())) ++sent_;
    ++frame_;
    plan();
  }
}

/// Sets the time at which the next frame is sent.
void LiveSuit::plan() {
  if (frame_ >= run_.frames) {
    next_ = HostTime::max();
    return;
  }
  // A frame leaves after the delay of the suit's program. The delay is drawn from the frame's
  // number.
  const double s = run_.frame_s(frame_) + program_delay_s(random_, frame_);
  next_ = start_ + Duration{static_cast<std::int64_t>(s * 1e9)};
}

/// The next frame as Noitom's binary stream, with the positions of all joints.
std::vector<std::uint8_t> LiveSuit::datagram() {
  // The pose is taken at the measured time and not at the time of sending.
  motion_.pose_at(run_.frame_s(frame_), pose_);
  const std::size_t joints = motion_.skeleton.joints();
  std::vector<double> positions(3 * joints), rotations(4 * joints), row;
  for (std::size_t j = 0; j < joints; ++j) {
    vec3(positions, j) = pose_.local_positions[j];
    put_quat(rotations, j, pose_.local_rotations[j]);
  }
  channels_.append(positions, rotations, row);
  NoitomFrame frame;
  frame.name = "simulated";
  frame.frame_index = static_cast<std::uint32_t>(frame_);
  frame.displacement = true;
  for (const double value : row) frame.values.push_back(static_cast<float>(value));
  std::vector<std::uint8_t> bytes;
  append_noitom(frame, bytes);  // check_live has refused another number of joints
  return bytes;
}

}  // namespace kinalign
