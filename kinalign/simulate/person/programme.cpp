// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 101 of a seed, by the number of the act, has these lanes: 0
// side, 1 amplitude, 2 tempo, 3 speed. Stream 102, by the number of the round: lanes 0 to 7 the
// order, 8 to 15 the lengths.
#include "kinalign/simulate/person/programme.h"

#include "kinalign/simulate/random.h"
#include "kinalign/simulate/smooth.h"

#include <algorithm>
#include <string>

namespace kinalign {

namespace {

/// Returns the length in the default programme, s. It is long enough to walk away and return.
double usual_length(Piece piece) {
  switch (piece) {
    case Piece::t_pose:
      return 4.0;
    case Piece::stand:
      return 3.0;
    case Piece::step:
      return 6.0;
    case Piece::walk:
    case Piece::walk_turn:
      return 16.0;
    case Piece::turn:
      return 12.0;
    case Piece::wave:
    case Piece::bend:
    case Piece::squat:
      return 7.0;
    default:  // the default programme has no slow pieces
      return 0.0;
  }
}

/// Returns the least and the greatest length of one repetition, s.
std::pair<double, double> tempo(Piece piece) {
  switch (piece) {
    case Piece::wave:
      return {0.65, 0.95};
    case Piece::bend:
    case Piece::squat:
      return {2.6, 3.6};
    case Piece::walk:
    case Piece::walk_turn:
      return {1.1, 1.3};
    case Piece::step:
      return {1.05, 1.35};
    case Piece::turn:
      return {1.0, 1.2};
    case Piece::t_pose:
    case Piece::stand:
      return {1.0, 1.0};
    default:
      return {5.5, 8.5};
  }
}

/// Returns an act of this piece with random side, size, tempo and speed.
Act drawn(const RandomStream& random, std::uint64_t number, Piece piece) {
  const auto between = [&](std::uint64_t lane, double least, double most) {
    return least + (most - least) * random.uniform(number, lane);
  };
  Act act;
  act.piece = piece;
  act.number = number;
  act.side = random.chance(number, 0, 0.5) ? 1.0 : -1.0;
  act.amplitude = between(1, 0.85, 1.15);
  const auto [least, most] = tempo(piece);
  act.tempo_s = between(2, least, most);
  act.speed = between(3, 0.6, 0.85);
  return act;
}

}  // namespace

Programme default_programme(double length_s, std::uint64_t seed) {
  Programme programme;
  const RandomStream random(seed, 102);
  double end = 0.0;
  const auto add = [&](Piece piece, double length) {
    if (end >= length_s) return;
    programme.push_back({piece, std::min(length, length_s - end)});
    end += length;
  };
  add(Piece::t_pose, usual_length(Piece::t_pose));
  for (std::uint64_t round = 0; end < length_s; ++round) {
    std::array<Piece, 8> order{Piece::stand, Piece::step, Piece::walk, Piece::walk_turn,
                               Piece::wave,  Piece::bend, Piece::turn, Piece::squat};
    // Shuffle by Fisher and Yates.
    for (std::uint64_t i = order.size() - 1; i > 0; --i) {
      const auto other =
          static_cast<std::size_t>(random.uniform(round, i) * static_cast<double>(i + 1));
      std::swap(order[i], order[other]);
    }
    for (std::uint64_t i = 0; i < order.size(); ++i) {
      add(order[i], usual_length(order[i]) * (0.85 + 0.3 * random.uniform(round, 8 + i)));
    }
  }
  return programme;
}

double Act::within(double t, double ramp_s) const {
  const double ramp = std::min(ramp_s, 0.5 * (end_s - begin_s));
  return (first ? 1.0 : rise((t - begin_s) / ramp)) * (last ? 1.0 : rise((end_s - t) / ramp));
}

// A programme without any length gives one act, so that there is always an act.
std::vector<Act> acts_of(const Programme& programme, std::uint64_t seed) {
  const RandomStream random(seed, 101);
  std::vector<Act> acts;
  double begin = 0.0;
  for (const ProgrammePiece& piece : programme) {
    if (!(piece.length_s > 0.0)) continue;
    Act act = drawn(random, acts.size(), piece.piece);
    act.begin_s = begin;
    act.end_s = begin += piece.length_s;
    if (is_slow(act.piece)) {
      act.repetitions =
          drawn_repetitions({act.begin_s, act.end_s, act.tempo_s, act.side, act.number}, seed);
    }
    acts.push_back(act);
  }
  if (acts.empty()) acts.push_back(drawn(random, 0, Piece::stand));
  acts.front().first = acts.back().last = true;
  return acts;
}

const Act& act_at(const std::vector<Act>& acts, double t) {
  const auto behind = std::upper_bound(acts.begin() + 1, acts.end(), t,
                                       [](double at, const Act& act) { return at < act.begin_s; });
  return *(behind - 1);
}

}  // namespace kinalign
