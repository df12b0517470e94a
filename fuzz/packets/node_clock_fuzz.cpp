// SPDX-License-Identifier: Apache-2.0
// For any frames of a node its clock gives intervals whose ends are in order, with the likeliest
// time between them, and the whole recording can be fitted. Each five bytes are a frame: the steps
// of the counter and the host, the life, and the echo.
#include "kinalign/clock/offline/offline_clock.h"
#include "kinalign/wire/bytes.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

using namespace kinalign;

namespace {

/// Mostly steps of milliseconds, sometimes any number of 64 bits.
std::int64_t step(std::uint8_t byte) {
  const auto value = static_cast<std::int64_t>(byte & 0x3FU) - 8;
  return byte < 0xC0 ? value * 1'000'000 : value << (byte & 0x3FU);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(std::span(data, size));
  std::vector<Exchange> exchanges;
  std::uint64_t node = 5'000'000'000, host = 1'000'000'000'000;
  LiveClock clock;
  while (bytes.left() >= 5 && exchanges.size() < 2000) {
    node += static_cast<std::uint64_t>(step(bytes.take<std::uint8_t>()));
    host += static_cast<std::uint64_t>(step(bytes.take<std::uint8_t>()));
    const auto n = static_cast<std::int64_t>(node & 0x3FFFFFFFFFFFFFFFU);
    const auto h = static_cast<std::int64_t>(host & 0x3FFFFFFFFFFFFFFFU);
    const auto what = bytes.take<std::uint8_t>();
    Exchange e{what & 3U, NodeTime{Duration{n}}, HostTime{Duration{h}}, {}};
    const std::int64_t n_back = step(bytes.take<std::uint8_t>()),
                       h_back = step(bytes.take<std::uint8_t>());
    if ((what & 4U) != 0) {
      e.echo = {NodeTime{Duration{n - n_back % (n + 1)}}, HostTime{Duration{h - h_back % (h + 1)}}};
    }
    clock.push(e);
    exchanges.push_back(e);
    const auto stamp = clock.host_from_node(e.boot, e.n_tx);
    // No slope may be known exactly: the next piece divides by its deviation.
    if (!(clock.piece()->estimate().slope().deviation > 0.0)) std::abort();
    if (!stamp || stamp->certainty != Certainty::certified) continue;
    if (*stamp->latest < *stamp->earliest || stamp->time < *stamp->earliest - Duration{1000} ||
        stamp->time > *stamp->latest + Duration{1000}) {
      std::abort();
    }
  }
  // The fit has a knot for each second. It takes recordings of up to eleven days, but those would
  // cost the fuzzer ten seconds each, so longer ones than a day are left out.
  const auto [least, most] =
      std::minmax_element(exchanges.begin(), exchanges.end(),
                          [](const Exchange& a, const Exchange& b) { return a.n_tx < b.n_tx; });
  if (!exchanges.empty() && most->n_tx - least->n_tx > std::chrono::hours(24)) return 0;
  const OfflineClock offline = fit_offline_clock(exchanges);
  // One exchange begins at most three pieces: for a new life, a host clock that went back, and a
  // step.
  const bool many = offline.model.pieces.size() > 3 * exchanges.size();
  if (clock.take_events().size() > 64 || many) std::abort();
  return 0;
}
