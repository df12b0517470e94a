// SPDX-License-Identifier: Apache-2.0
// The programme of a simulated person, piece after piece, and the random details of each piece:
// tempo, size and side of its repetitions.
#pragma once

#include "kinalign/simulate/person/repetitions.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

enum class Piece : std::uint8_t {
  t_pose,     // arms out, palms down, upright
  stand,      // arms down, still except for sway and breath
  step,       // in place
  walk,       // to and fro along the person's first line of sight, 0.9 m each way
  walk_turn,  // in all directions within about 1 m of the start
  wave,       // with one raised hand
  bend,       // forward from the hips, arms hanging
  turn,       // in place, by quarter and half turns
  squat,
  // Slow pieces, as in Baduanjin: each repetition has its own length and a pause.
  raise_front,  // both arms, forward and up
  raise_side,   // both arms, sideways and up
  push,         // forward with one hand, then with the other
  push_both,
  bend_side,  // to one side, the other arm over the head, then to the other side
  twist,      // the trunk to one side, eyes back, then to the other side
  deep_squat
};
inline constexpr std::array<std::string_view, 16> piece_names{
    "t_pose", "stand",       "step",       "walk", "walk_turn", "wave",      "bend",  "turn",
    "squat",  "raise_front", "raise_side", "push", "push_both", "bend_side", "twist", "deep_squat"};
/// True if a piece consists of slow repetitions.
constexpr bool is_slow(Piece piece) { return piece >= Piece::raise_front; }
constexpr std::string_view to_string(Piece piece) {
  return piece_names[static_cast<std::size_t>(piece)];
}

struct ProgrammePiece {
  Piece piece = Piece::stand;
  double length_s = 0.0;
};
using Programme = std::vector<ProgrammePiece>;

/// A T-pose first. Then every other piece that is not slow, in a random order that is new in each
/// round, until the length is reached. The last piece is cut.
Programme default_programme(double length_s, std::uint64_t seed);

/// A piece with its random details. The ranges of tempo are estimates: strides of 1.05 to 1.35 s
/// are slow indoor walking.
/// All random details are drawn when the programme begins, so an act can be asked for any time in
/// any order.
struct Act {
  Piece piece = Piece::stand;
  double begin_s = 0.0, end_s = 0.0;
  /// The first act has no transition at its beginning, the last one none at its end.
  bool first = false, last = false;
  double side = 1.0;                      // +1: the left hand, foot or direction first
  double amplitude = 1.0;                 // size of the movement, 0.85 to 1.15
  double tempo_s = 1.0;                   // s for one repetition: a wave, a bend, a squat, a stride
  double speed = 0.0;                     // m/s in walking, for a person of 1.75 m
  std::uint64_t number = 0;               // number of the act, for further draws
  std::vector<Repetition> repetitions{};  // for a slow piece; empty for others

  bool has_steps() const {
    return piece == Piece::step || piece == Piece::walk || piece == Piece::walk_turn ||
           piece == Piece::turn;
  }
  /// 1 in the middle, 0 at the ends, with transitions of `ramp_s`.
  double within(double t, double ramp_s) const;
};

/// The acts of a programme, one after the other from t = 0. Pieces without length are left out.
std::vector<Act> acts_of(const Programme& programme, std::uint64_t seed);

/// The act at a time. At a border it is the later act; before the first and after the last, the
/// nearest.
const Act& act_at(const std::vector<Act>& acts, double t);

}  // namespace kinalign
