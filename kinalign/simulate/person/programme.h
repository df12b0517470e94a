// SPDX-License-Identifier: Apache-2.0
// What a simulated person does, piece after piece, and how this time: tempo, size and side of each
// repetition are drawn.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/simulate/person/repetitions.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

enum class Piece : std::uint8_t {
  t_pose,     // arms out, palms down, upright
  stand,      // arms down, still but for sway and breath
  step,       // in place
  walk,       // to and fro along the line that the person faced at first, 0.9 m each way
  walk_turn,  // about within 1 m of the start, in all directions
  wave,       // with one raised hand
  bend,       // forward from the hips, arms hanging
  turn,       // in place, by quarters and halves
  squat,
  // Slow ones, as in Baduanjin: each repetition has its own length and a pause.
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
/// Whether a piece is done in slow repetitions.
constexpr bool is_slow(Piece piece) { return piece >= Piece::raise_front; }
constexpr std::string_view to_string(Piece piece) {
  return piece_names[static_cast<std::size_t>(piece)];
}
/// Fails with the names that there are.
Result<Piece> piece_named(std::string_view name);

struct ProgrammePiece {
  Piece piece = Piece::stand;
  double length_s = 0.0;
};
using Programme = std::vector<ProgrammePiece>;

/// T-pose first, then every other piece that is not slow in a drawn order, in a new order each time
/// round, until the length is reached; the last piece is cut.
Programme default_programme(double length_s, std::uint64_t seed);

/// A piece as it is done this time. Ranges of tempo are estimates: strides of 1.05 to 1.35 s are
/// slow indoor walking.
struct Act {
  Piece piece = Piece::stand;
  double begin_s = 0.0, end_s = 0.0;
  bool first = false, last = false;       // nothing to come from, nothing to go to
  double side = 1.0;                      // +1: the left hand, foot or way round first
  double amplitude = 1.0;                 // of the movement, 0.85 to 1.15
  double tempo_s = 1.0;                   // of one repetition: a wave, a bend, a squat, a stride
  double speed = 0.0;                     // m/s of a person of 1.75 m, where one walks
  std::uint64_t number = 0;               // of the act, for further draws
  std::vector<Repetition> repetitions{};  // of a slow piece; else none

  bool has_steps() const {
    return piece == Piece::step || piece == Piece::walk || piece == Piece::walk_turn ||
           piece == Piece::turn;
  }
  /// 1 within, 0 at its ends: `ramp_s` to come in and to go out.
  double within(double t, double ramp_s) const;
};

/// The acts of a programme, one behind the other from t = 0. Pieces of no length are left out.
std::vector<Act> acts_of(const Programme& programme, std::uint64_t seed);

/// The act at a time, at the ends of two the later one; before and behind all the nearest.
const Act& act_at(const std::vector<Act>& acts, double t);

}  // namespace kinalign
