// SPDX-License-Identifier: Apache-2.0
// The seed's random stream 121 gives the delay of the suit's program for each frame; the counter is
// the frame's number and the lane is 0.
#include "apps/kinalign/simulate/live_suit.h"

#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/protocols/noitom/frame.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

/// The first frame is planned here, so that next() is right before the first call of work().
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
  // After a long sleep several frames may be due. All of them are sent, since a suit skips no
  // frame.
  while (next_ <= now) {
    worst_late_ = std::max(worst_late_, now - next_);
    if (socket_.send(datagram())) ++sent_;
    ++frame_;
    plan();
  }
}

/// Sets next_, the time at which the next frame is sent.
void LiveSuit::plan() {
  if (frame_ >= run_.frames) {
    next_ = HostTime::max();
    return;
  }
  // A frame is sent after the delay of the suit's program, which is random for each frame.
  const double s = run_.frame_s(frame_) + program_delay_s(random_, frame_);
  next_ = start_ + from_seconds(s);
}

/// The next frame as a datagram of Noitom's binary stream, with the positions of all joints.
std::vector<std::uint8_t> LiveSuit::datagram() {
  // The pose is that of the measured time, not of the time of sending.
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
  append_noitom(frame, bytes);  // check_live() has refused other skeletons
  return bytes;
}

LiveClicks::LiveClicks(const MocapRun& mocap, std::uint64_t run, HostTime start, LiveSocket socket)
    : socket_(std::move(socket)) {
  // The recorder ignores a mark whose id it has seen, so the ids contain the number of the run.
  const std::string id = std::to_string(run);
  add(Mark::Kind::start, id + "-start", start + from_seconds(mocap.start_click_s));
  add(Mark::Kind::stop, id + "-stop", start + from_seconds(mocap.stop_click_s));
}

/// Adds a datagram with the mark, and a second one as docs/formats/marks.md advises. If one
/// datagram is lost, the other brings the mark. If both arrive, the recorder ignores the repeat.
void LiveClicks::add(Mark::Kind kind, const std::string& id, HostTime at) {
  const std::string text = encode_mark_call({kind, "", from_seconds(click_latency_s), id});
  calls_.push_back({at, text});
  // The second datagram follows 50 ms later, so that one disturbance of the network does not lose
  // both.
  calls_.push_back({at + std::chrono::milliseconds(50), text});
}

void LiveClicks::work(HostTime now) {
  std::array<std::uint8_t, 64> room{};
  // The answers are read, since they would otherwise fill the socket's buffer.
  while (socket_.receive(room) > 0) continue;
  // The socket itself counts the datagrams that were refused.
  for (; next() <= now; ++sent_) (void)socket_.send(octets(calls_[sent_].text));
}

}  // namespace kinalign
