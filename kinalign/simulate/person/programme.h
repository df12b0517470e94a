// SPDX-License-Identifier: Apache-2.0
// The programme of a simulated person: a list of pieces (such as walking), and the random details
// of each piece, such as tempo, size and side of its repetitions.
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
  walk,       // back and forth in the first viewing direction, 0.9 m each way
  walk_turn,  // in all directions within about 1 m of the start
  wave,       // with one raised hand
  bend,       // forwards from the hips, arms hanging
  turn,       // in place, by quarter and half turns
  squat,
  // Slow pieces, as in Baduanjin. Each repetition has its own length and a pause.
  raise_front,  // both arms, forwards and up
  raise_side,   // both arms, sideways and up
  push,         // with one hand, then with the other
  push_both,
  bend_side,  // to one side with the other arm over the head, then to the other side
  twist,      // the trunk to one side, looking back, then to the other side
  deep_squat
};
inline constexpr std::array<std::string_view, 16> piece_names{
    "t_pose", "stand",       "step",       "walk", "walk_turn", "wave",      "bend",  "turn",
    "squat",  "raise_front", "raise_side", "push", "push_both", "bend_side", "twist", "deep_squat"};
/// Returns whether a piece consists of slow repetitions.
constexpr bool is_slow(Piece piece) { return piece >= Piece::raise_front; }
constexpr std::string_view to_string(Piece piece) {
  return piece_names[static_cast<std::size_t>(piece)];
}

struct ProgrammePiece {
  Piece piece = Piece::stand;
  double length_s = 0.0;
};
using Programme = std::vector<ProgrammePiece>;

/// Returns a programme that begins with a T-pose. All other pieces that are not slow follow in a
/// random order, which is drawn anew in each round, until the length is reached. The last piece is
/// shortened.
Programme default_programme(double length_s, std::uint64_t seed);

/// An act: a piece with its random details. The ranges of tempo are estimates; strides of 1.05 to
/// 1.35 s are slow indoor walking. All details are drawn when the programme begins, so the pose can
/// be computed for any time in any order.
struct Act {
  Piece piece = Piece::stand;
  double begin_s = 0.0, end_s = 0.0;
  /// The first act begins and the last act ends without a transition.
  bool first = false, last = false;
  double side = 1.0;                      // +1: begins with the left hand, foot or direction
  double amplitude = 1.0;                 // size of the movement, 0.85 to 1.15
  double tempo_s = 1.0;                   // s for one repetition, such as a wave or a stride
  double speed = 0.0;                     // m/s in walking, for a person of 1.75 m
  std::uint64_t number = 0;               // number of the act, which selects further random numbers
  std::vector<Repetition> repetitions{};  // of a slow piece; empty for other pieces

  bool has_steps() const {
    return piece == Piece::step || piece == Piece::walk || piece == Piece::walk_turn ||
           piece == Piece::turn;
  }
  /// Returns 1 inside the act and 0 at its ends, with transitions of `ramp_s`.
  double within(double t, double ramp_s) const;
};

/// Returns the acts of a programme, consecutively from t = 0. Pieces of length 0 are omitted.
std::vector<Act> acts_of(const Programme& programme, std::uint64_t seed);

/// Returns the act at a time. At a boundary it is the later act. Before the first act it is the
/// first, after the last act the last.
const Act& act_at(const std::vector<Act>& acts, double t);

}  // namespace kinalign
