// SPDX-License-Identifier: Apache-2.0
// Stream 121 of the seed draws the delay of the suit's program: counter the frame's number, lane 0.
#include "apps/kinalign/simulate/live_suit.h"

#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/protocols/noitom/frame.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <array>
#include <utility>

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
  next_ = start_ + from_seconds(s);
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

LiveClicks::LiveClicks(const MocapRun& mocap, std::uint64_t run, HostTime start, LiveSocket socket)
    : socket_(std::move(socket)) {
  // The ids of marks contain the run. The recorder ignores a mark whose id it has seen.
  const std::string id = std::to_string(run);
  add(Mark::Kind::start, id + "-start", start + from_seconds(mocap.start_click_s));
  add(Mark::Kind::stop, id + "-stop", start + from_seconds(mocap.stop_click_s));
}

/// Adds the call twice, as docs/formats/marks.md advises: a lost datagram would cost the mark, and
/// a repeat is ignored.
void LiveClicks::add(Mark::Kind kind, const std::string& id, HostTime at) {
  const std::string text = encode_mark_call({kind, "", from_seconds(click_latency_s), id});
  calls_.push_back({at, text});
  // 50 ms later, so that one disturbance of the network does not lose both.
  calls_.push_back({at + std::chrono::milliseconds(50), text});
}

void LiveClicks::work(HostTime now) {
  std::array<std::uint8_t, 64> room{};
  // The answers must be read, since they would fill the socket's buffer.
  while (socket_.receive(room) > 0) continue;
  // The result is counted by the socket.
  for (; next() <= now; ++sent_) (void)socket_.send(octets(calls_[sent_].text));
}

}  // namespace kinalign
