// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/live_clicks.h"

#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/wire/little_endian_reader.h"

#include <array>
#include <utility>

namespace kinalign {

namespace {

using namespace std::chrono_literals;

Duration click_time(double s) { return Duration{static_cast<std::int64_t>(s * 1e9)}; }

}  // namespace

LiveClicks::LiveClicks(const MocapRun& mocap, std::uint64_t run, HostTime start, LiveSocket socket)
    : socket_(std::move(socket)) {
  // The ids of marks contain the run. The recorder ignores a mark whose id it has seen.
  const std::string id = std::to_string(run);
  add(Mark::Kind::start, id + "-start", start + click_time(mocap.start_click_s));
  add(Mark::Kind::stop, id + "-stop", start + click_time(mocap.stop_click_s));
}

/// Adds the call twice, as docs/formats/marks.md advises: a lost datagram would cost the mark, and
/// a repeat is ignored.
void LiveClicks::add(Mark::Kind kind, const std::string& id, HostTime at) {
  const std::string text = encode_mark_call({kind, "", click_time(click_latency_s), id});
  calls_.push_back({at, text});
  // 50 ms later, so that one disturbance of the network does not lose both.
  calls_.push_back({at + 50ms, text});
}

void LiveClicks::work(HostTime now) {
  std::array<std::uint8_t, 64> room{};
  // The answers must be read, since they would fill the socket's buffer.
  while (socket_.receive(room) > 0) continue;
  // The result is counted by the socket.
  for (; next() <= now; ++sent_) (void)socket_.send(octets(calls_[sent_].text));
}

}  // namespace kinalign
