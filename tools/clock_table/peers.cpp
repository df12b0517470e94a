// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/peers.h"

#include "tools/clock_table/judge.h"

#include "kinalign/clock/offline/clockless.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace kinalign {

namespace {

/// Frames that arrived, in the order in which they were sent.
std::vector<const SimulatedFrame*> arrived_frames(const SimulatedExchanges& exchanges) {
  std::vector<const SimulatedFrame*> frames;
  for (const SimulatedFrame& frame : exchanges.frames) {
    if (frame.arrival) frames.push_back(&frame);
  }
  return frames;
}

double counter(const SimulatedFrame& frame) { return static_cast<double>(frame.n_tx_us) * 1e-6; }

/// A whole exchange: a frame whose reply was echoed by a later frame that arrived.
struct TwoWay {
  double known_at = 0.0;  // when that later frame arrived
  double node = 0.0;      // counter in the middle of the exchange, s
  double offset = 0.0;    // s, host minus node, from half of the round trip
  double round_trip = 0.0;
};

std::vector<TwoWay> two_way_exchanges(const SimulatedExchanges& exchanges) {
  std::vector<TwoWay> found;
  for (const SimulatedFrame& carrier : exchanges.frames) {
    if (!carrier.echo || !carrier.arrival) continue;
    const SimulatedFrame& f = exchanges.frames[*carrier.echo];
    const double n_tx = counter(f), n_rx = static_cast<double>(f.n_rx_us) * 1e-6;
    found.push_back({*carrier.arrival, (n_tx + n_rx) / 2.0,
                     ((*f.arrival - n_tx) + (f.replied - n_rx)) / 2.0,
                     (n_rx - n_tx) - (f.replied - *f.arrival)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const TwoWay& a, const TwoWay& b) { return a.known_at < b.known_at; });
  return found;
}

std::vector<ClocklessExchange> clockless(const SimulatedExchanges& exchanges) {
  std::vector<ClocklessExchange> out;
  for (const SimulatedFrame* f : arrived_frames(exchanges)) {
    ClocklessExchange e{f->sequence, arrival_time(*f->arrival), departure_time(f->replied), {}};
    if (f->confirmed) e.t6 = arrival_time(*f->confirmed);
    out.push_back(e);
  }
  return out;
}

template <class Stamps>
PeerErrors errors_of(const SimulatedExchanges& exchanges, const Stamps& stamps) {
  PeerErrors out;
  const auto frames = arrived_frames(exchanges);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<HostTime> stamp = stamps[i];
    if (!stamp) continue;
    out.sent.push_back(frames[i]->sent);
    out.error.push_back(seconds_of(*stamp) - frames[i]->truth);
  }
  return out;
}

PeerErrors each_delay(const SimulatedExchanges& exchanges) {
  return errors_of(exchanges, stamps_by_each_delay(clockless(exchanges)));
}

PeerErrors mean_delay(const SimulatedExchanges& exchanges) {
  return errors_of(exchanges, stamps_by_mean_delay(clockless(exchanges)).value());
}

PeerErrors frame_number(const SimulatedExchanges& exchanges) {
  return errors_of(exchanges,
                   stamps_by_frame_number(clockless(exchanges), exchanges.options.rate_hz).value());
}

/// A line offset + slope (node - at), used from the time on at which it was known.
struct Line {
  double known_at = 0.0, at = 0.0, offset = 0.0, slope = 0.0;
};

/// Stamps each frame by the newest line that was known when it arrived.
PeerErrors by_lines(const SimulatedExchanges& exchanges, const std::vector<Line>& lines) {
  PeerErrors out;
  for (const SimulatedFrame* f : arrived_frames(exchanges)) {
    const auto behind =
        std::upper_bound(lines.begin(), lines.end(), *f->arrival,
                         [](double t, const Line& line) { return t < line.known_at; });
    if (behind == lines.begin()) continue;
    const Line& line = *(behind - 1);
    const double n = counter(*f);
    out.sent.push_back(f->sent);
    out.error.push_back(n + line.offset + line.slope * (n - line.at) - f->truth);
  }
  return out;
}

/// Weighted least squares around the weighted mean.
Line fitted(const std::vector<TwoWay>& points, const std::vector<double>& weights) {
  double sum = 0.0, node = 0.0, offset = 0.0, squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += weights[i];
    node += weights[i] * points[i].node;
    offset += weights[i] * points[i].offset;
  }
  node /= sum;
  offset /= sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    squares += weights[i] * std::pow(points[i].node - node, 2);
    products += weights[i] * (points[i].node - node) * (points[i].offset - offset);
  }
  return {0.0, node, offset, squares > 0.0 ? products / squares : 0.0};
}

/// liblsl's method: every five seconds the best of eight probes.
std::vector<TwoWay> best_of_eight(const SimulatedExchanges& exchanges) {
  std::map<std::int64_t, std::vector<TwoWay>> windows;
  for (const TwoWay& e : two_way_exchanges(exchanges)) {
    auto& window = windows[static_cast<std::int64_t>(e.known_at / 5.0)];
    if (window.size() < 8) window.push_back(e);
  }
  std::vector<TwoWay> best;
  for (const auto& [index, window] : windows) {
    TwoWay pick = *std::min_element(
        window.begin(), window.end(),
        [](const TwoWay& a, const TwoWay& b) { return a.round_trip < b.round_trip; });
    pick.known_at = window.back().known_at;
    best.push_back(pick);
  }
  return best;
}

PeerErrors lsl_live(const SimulatedExchanges& exchanges) {
  std::vector<Line> lines;
  for (const TwoWay& e : best_of_eight(exchanges))
    lines.push_back({e.known_at, e.node, e.offset, 0.0});
  return by_lines(exchanges, lines);
}

/// One robust line (Huber's weights) through all points, as readers of XDF fit it.
PeerErrors lsl_offline(const SimulatedExchanges& exchanges) {
  const auto picked = best_of_eight(exchanges);
  std::vector<double> weights(picked.size(), 1.0);
  Line line;
  for (int round = 0; round < 30; ++round) {
    line = fitted(picked, weights);
    std::vector<double> residuals;
    for (const TwoWay& e : picked) {
      residuals.push_back(std::abs(e.offset - line.offset - line.slope * (e.node - line.at)));
    }
    std::vector<double> sorted = residuals;
    std::sort(sorted.begin(), sorted.end());
    const double bend = 1.345 * 1.4826 * sorted[sorted.size() / 2] + 1e-9;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = std::min(1.0, bend / std::max(residuals[i], 1e-12));
    }
  }
  line.known_at = -1.0;
  return by_lines(exchanges, {line});
}

/// A client that asks every 16 s, and fits a line through its last 16 exchanges, weighted by their
/// excess round trips.
PeerErrors sntp_live(const SimulatedExchanges& exchanges) {
  std::vector<TwoWay> asked;
  std::vector<Line> lines;
  for (const TwoWay& e : two_way_exchanges(exchanges)) {
    if (!asked.empty() &&
        std::floor(e.known_at / 16.0) == std::floor(asked.back().known_at / 16.0)) {
      continue;
    }
    asked.push_back(e);
    const std::size_t n = std::min<std::size_t>(16, asked.size());
    const std::vector<TwoWay> last(asked.end() - static_cast<std::ptrdiff_t>(n), asked.end());
    double least = std::numeric_limits<double>::infinity();
    for (const TwoWay& p : last) least = std::min(least, p.round_trip);
    std::vector<double> weights;
    for (const TwoWay& p : last) {
      weights.push_back(n < 3 ? (p.round_trip == least ? 1.0 : 0.0)
                              : std::pow(50e-6 + (p.round_trip - least) / 2.0, -2));
    }
    Line line = fitted(last, weights);
    line.known_at = e.known_at;
    lines.push_back(line);
  }
  return by_lines(exchanges, lines);
}

/// A filter for offset and drift. The measurement noise follows the excess round trip; errors
/// beyond three deviations count less.
PeerErrors kalman_live(const SimulatedExchanges& exchanges) {
  const auto points = two_way_exchanges(exchanges);
  std::vector<Line> lines;
  if (points.empty()) return {};
  double x = points[0].offset, v = 0.0, last = points[0].node, least = points[0].round_trip;
  double pxx = 4e-4, pxv = 0.0, pvv = std::pow(50e-6, 2);
  for (const TwoWay& e : points) {
    const double dt = std::max(e.node - last, 0.0), q = 1e-16;
    last = std::max(last, e.node);
    x += dt * v;
    pxx += 2.0 * dt * pxv + dt * dt * pvv + q * dt * dt * dt / 3.0;
    pxv += dt * pvv + q * dt * dt / 2.0;
    pvv += q * dt;
    least = std::min(least, e.round_trip);
    const double noise = 5e-6 + (e.round_trip - least) / 2.0 +
                         e.round_trip / 2.0 / static_cast<double>(1 + lines.size());
    const double off = e.offset - x;
    double variance = pxx + noise * noise;
    if (off * off > 9.0 * variance) variance = pxx + off * off / 9.0;
    const double gain_x = pxx / variance, gain_v = pxv / variance;
    x += gain_x * off;
    v += gain_v * off;
    pvv -= gain_v * pxv;
    pxv -= gain_x * pxv;
    pxx -= gain_x * pxx;
    lines.push_back({e.known_at, last, x, v});
  }
  return by_lines(exchanges, lines);
}

}  // namespace

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all{
      {"T2 - d, each d", true, each_delay},  {"T2 - d, mean d", false, mean_delay},
      {"frame number", false, frame_number}, {"SNTP-like", true, sntp_live},
      {"LSL-like", true, lsl_live},          {"LSL-like, offline", false, lsl_offline},
      {"Kalman filter", true, kalman_live}};
  return all;
}

}  // namespace kinalign
