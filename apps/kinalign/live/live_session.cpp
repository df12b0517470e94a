// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_session.h"

#include "apps/cli/json_text.h"

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/kinematics.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace kinalign {

namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr Duration one_turn = 100ms;          // the longest wait for data in one turn
constexpr Duration between_statuses = 500ms;  // between two prints of the status on a terminal
constexpr Duration most_quiet = 5s;           // `record` sends at least one message each second

// The name of this machine. The stream states the name of its machine; if both are equal, both
// programs use the same clock.
std::string own_host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Appends numbers as rows of `width` numbers: "[[0.10000,0.90000,0.00000],...]". Five decimals of
/// a metre are a hundredth of a millimetre.
void append_rows(std::string& out, std::span<const double> numbers, std::size_t width) {
  out += '[';
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    out += i % width == 0 ? (i == 0 ? "[" : ",[") : ",";
    if (std::isfinite(numbers[i])) {
      fmt::format_to(std::back_inserter(out), "{:.5f}", numbers[i]);
    } else {
      out += "null";  // JSON has neither NaN nor infinity
    }
    if (i % width == width - 1) out += ']';
  }
  out += ']';
}

/// The event "frame": global positions in m, and local rotations as quaternions w, x, y, z.
std::string frame_json(const Skeleton& skeleton, const ClipFrames& one) {
  std::vector<double> positions(3 * skeleton.joints());
  forward_kinematics(skeleton, one, positions);
  std::string out =
      fmt::format(R"({{"event":"frame","time_ns":{},"positions":)", to_ns(one.stamps.front()));
  append_rows(out, positions, 3);
  out += R"(,"local_rotations":)";
  append_rows(out, one.local_rotations, 4);
  return out + "}";
}

}  // namespace

Result<void> check_live_frames(std::size_t frames) {
  if (frames < most_live_frames) return {};
  return Failure(Error{"--live", 0, "at most 1,000,000 frames", "more frames"});
}

Failure no_live_frames(const std::string& waited_for) {
  return Failure(
      Error{"--live", 0, "frames to compute", "none; the data ended while " + waited_for});
}

Result<LiveSession> LiveSession::open(const LiveWords& words, Call& call) {
  // If a viewer stops reading, the run goes on.
  call.console.never_wait();
  (void)call.console.progress();  // starts the clock of the progress line
  std::optional<LiveDatagrams> datagrams;
  if (!words.send.empty()) {
    datagrams = KA_TRY(LiveDatagrams::open(KA_TRY(parse_endpoint(words.send, "--send"))));
  }
  LiveConnection connection =
      KA_TRY(LiveConnection::open(KA_TRY(parse_endpoint(words.live, "--live"))));
  return LiveSession(std::move(connection), std::move(datagrams), call);
}

LiveSession::LiveSession(LiveConnection connection, std::optional<LiveDatagrams> datagrams,
                         Call& call)
    : connection_(std::move(connection)),
      datagrams_(std::move(datagrams)),
      call_(&call),
      stream_(std::make_unique<LiveStream>()),
      clocks_(std::make_unique<SystemClocks>()),
      piece_came_(clocks_->raw()) {}

/// The stream's facts link the raw clock and UTC by an anchor, one instant on both clocks.
Time LiveSession::now() {
  const HostTime raw = clocks_->raw();
  // If `record` runs on this machine, both programs have the same raw clock, so the time of the
  // stamps can be read from it.
  if (is_own_host_.value_or(false)) {
    const ClockPair& anchor = stream_->facts()->anchor;
    return anchor.utc + (raw - anchor.raw);
  }
  // If `record` runs on another machine, only the arrival of its messages is known here. The
  // latency then lacks the time on the network.
  return stream_->now().value_or(Time{}) + (raw - piece_came_);
}

/// Receives one piece of the stream and passes it to `work`. Returns false at the end of the
/// stream.
Result<bool> LiveSession::turn(const LiveWork& work) {
  const auto came = connection_.wait(one_turn);
  piece_came_ = came == LiveConnection::Came::bytes ? clocks_->raw() : piece_came_;
  if (came == LiveConnection::Came::bytes) {
    is_quiet_ = false;
    LiveData data;
    KA_TRY(stream_->take(connection_.bytes(), data));
    // The first records of the stream name its machine. The name is compared once.
    if (!is_own_host_ && stream_->facts()) is_own_host_ = stream_->facts()->host == own_host();
    KA_TRY(work.take(data));
    call_->console.flush();
  }
  const HostTime now = clocks_->raw();
  // After a turn without data, report_quiet() checks how long the connection has been silent.
  if (came == LiveConnection::Came::nothing) KA_TRY(report_quiet(now - piece_came_));
  if (now >= next_status_ && call_->console.shows()) {
    next_status_ = now + between_statuses;
    call_->console.show({{harmless(work.status()), Colour::plain}, {"Ctrl-C ends", Colour::plain}});
  }
  if (came == LiveConnection::Came::end) stream_->end();
  return came != LiveConnection::Came::end;
}

/// Warns once if the connection has sent no data for `most_quiet`. Fails if it has never sent a
/// message of `record`.
Result<void> LiveSession::report_quiet(Duration silence) {
  if (is_quiet_ || silence <= most_quiet) return {};
  is_quiet_ = true;
  // A program that accepts the connection and sends nothing is not `record`, so waiting longer
  // would not help.
  if (!stream_->now()) {
    return Failure(
        Error{"--live", 0, "the stream of kinalign record --live-port", "no data for 5 s"});
  }
  report("kinalign record has sent nothing for 5 s: record or the network has stopped",
         {{"event", "quiet"}});
  return {};
}

Result<void> LiveSession::run(const LiveWork& work) {
  while (!interrupted() && KA_TRY(turn(work))) {
  }
  // The connection broke unless the user pressed Ctrl-C or `record` ended the stream itself.
  broke_ = !interrupted() && !stream_->closed();
  if (broke_ && !stream_->now()) {
    return Failure(Error{"--live", 0, "the stream of kinalign record --live-port",
                         "a connection that ended before the first message"});
  }
  return {};
}

void LiveSession::report_frame(const Skeleton& skeleton, const ClipFrames& one,
                               std::optional<Time> needed) {
  // The text takes more time than the rest of this function, so it is made only if it is used.
  if (call_->console.prints_json() || datagrams_) {
    const std::string text = frame_json(skeleton, one);
    call_->console.print_json(text);
    if (datagrams_) datagrams_->send(text);
  }
  // A frame that waited for the person and not for the program has no latency.
  if (!needed) return;
  const Time answered = now();
  latency_.add(answered - *needed, answered - one.stamps.front());
}

void LiveSession::report(const std::string& line, const Json& event) {
  if (!line.empty()) call_->console.print(harmless(line) + "\n");
  call_->console.print_json(json_text(event));
  call_->console.flush();
}

std::string LiveSession::latency_text() const {
  constexpr std::size_t newest = 300;  // frames
  return fmt::format(
      "{:.0f} ms after the samples (p99 {:.0f}), {:.0f} ms behind the motion (p99 {:.0f})",
      latency_.after_arrival_ms(0.5, newest), latency_.after_arrival_ms(0.99, newest),
      latency_.behind_motion_ms(0.5, newest), latency_.behind_motion_ms(0.99, newest));
}

void LiveSession::describe(Json& about) const {
  // These percentiles are over the whole run. latency_text() gives those of the newest frames.
  about["latency_ms"] = {{"frames", latency_.frames()},
                         {"after_arrival_p50", latency_.after_arrival_ms(0.5)},
                         {"after_arrival_p99", latency_.after_arrival_ms(0.99)},
                         {"behind_motion_p50", latency_.behind_motion_ms(0.5)},
                         {"behind_motion_p99", latency_.behind_motion_ms(0.99)}};
  about["messages"] = stream_->counts().messages;
  about["lost"] = stream_->counts().lost;
  about["refused"] = stream_->counts().refused;
  if (!about.contains("warnings")) about["warnings"] = Json::array();
  for (const std::string& warning : warnings()) about["warnings"].push_back(warning);
  about["ended"] = broke_ ? "broke" : stream_->closed() ? "record" : "stopped";
}

/// The warnings about the stream: a broken connection, lost messages, samples that were left out.
std::vector<std::string> LiveSession::warnings() const {
  std::vector<std::string> out;
  if (broke_)
    out.emplace_back("the stream broke off: kinalign record was killed, or the network failed");
  if (const std::uint64_t lost = stream_->counts().lost; lost > 0) {
    out.push_back(fmt::format("{} messages lost: this program reads too slowly", grouped(lost)));
  }
  if (const std::uint64_t refused = stream_->counts().refused; refused > 0) {
    out.push_back(
        fmt::format("{} samples left out: their stamps or values are wrong", grouped(refused)));
  }
  return out;
}

}  // namespace kinalign
