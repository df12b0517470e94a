// SPDX-License-Identifier: Apache-2.0
// All random numbers come from stream 130 of a seed. Counter 0, lane 0 draws the first movement;
// counters 1, 2, ..., lane 0 draw the length of each movement.
#include "kinalign/dataset/twin/twin_actions.h"

#include "kinalign/dataset/catalogue.h"
#include "kinalign/simulate/random.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr double t_pose_s = 3.5;  // two seconds are still; the arms come down in the last 1.3
// If the rest of the take is shorter than this, the last movement is lengthened.
constexpr double least_piece_s = 5.0;

/// The mean length of a movement, s. A walk returns to its beginning.
double mean_length(Piece piece) {
  if (piece == Piece::walk || piece == Piece::walk_turn) return 13.0;
  if (piece == Piece::turn) return 10.0;
  return is_slow(piece) ? 11.0 : 7.0;
}

}  // namespace

const std::vector<TwinAction>& twin_actions() {
  using enum Piece;
  static const std::vector<TwinAction> all{
      {"S1A01", "stretching", {raise_side, raise_front}},
      {"S1A02", "chest expanding", {push_both, raise_side}},
      {"S1A03", "kicking", {step, raise_front}},
      {"S1A04", "side bending", {bend_side}},
      {"S1A05", "body turning", {twist, raise_side}},
      {"S1A06", "whole body", {bend, squat, raise_front}},
      {"S1A07", "jumping", {step, wave, raise_side}},
      {"S1A08", "cooling down", {step, raise_front, bend}},
      {"S2A01", "two hands hold up the sky", {raise_side}},
      {"S2A02", "drawing the bow", {deep_squat, push}},
      {"S2A03", "separating heaven and earth", {bend_side, raise_front}},
      {"S2A04", "looking back", {twist}},
      {"S2A05", "swaying head and tail", {deep_squat, bend_side}},
      {"S2A06", "hands hold the feet", {bend, raise_front}},
      {"S2A07", "punching with fierce eyes", {deep_squat, push_both, push}},
      {"S2A08", "rising on the heels", {stand, raise_side}},
      {"S3A01", "jogging in place", {step}},
      {"S3A02", "squats", {squat, deep_squat}},
      {"S3A03", "boxing", {push, turn}},
      {"S3A04", "shuttle walk", {walk}},
      {"S3A05", "ball throwing", {raise_front, push_both, twist}},
      {"S4A01", "tiger", {push_both, bend}},
      {"S4A02", "deer", {twist, push}},
      {"S4A03", "bear", {twist, bend_side}},
      {"S4A04", "ape", {squat, raise_front}},
      {"S4A05", "bird", {raise_side, step}},
      {"S5A01", "walking", {walk}},
      {"S5A02", "walking about", {walk_turn}},
      {"S5A03", "waving", {wave, stand}},
      {"S5A04", "picking up", {bend, squat}},
      {"S5A05", "turning", {turn}},
      {"S5A06", "reaching", {push, raise_front, stand}},
      {"S6A01", "steps and arms", {step, raise_side, turn}},
      {"S6A02", "walks and waves", {walk_turn, wave, twist}}};
  return all;
}

std::vector<const TwinAction*> twin_actions_of(std::string_view class_id) {
  std::vector<const TwinAction*> out;
  for (const TwinAction& action : twin_actions()) {
    if (action.id.starts_with(class_id)) out.push_back(&action);
  }
  return out;
}

Programme twin_programme(const TwinAction& action, double length_s, std::uint64_t seed) {
  const RandomStream random(seed, 130);
  const auto count = static_cast<double>(action.pieces.size());
  // The first movement is drawn at random, so that takes of one action begin differently.
  auto next = static_cast<std::size_t>(random.uniform(0, 0) * count);
  Programme out{{Piece::t_pose, t_pose_s}};
  double end = t_pose_s;
  for (std::uint64_t number = 1; end < length_s; ++number) {
    const Piece piece = action.pieces[next++ % action.pieces.size()];
    double length = mean_length(piece) * (0.8 + 0.4 * random.uniform(number, 0));
    // The last movement ends at the end of the take.
    if (length_s - end - length < least_piece_s) length = length_s - end;
    out.push_back({piece, length});
    end += length;
  }
  return out;
}

Result<std::string> twin_catalogue(const std::string& name) {
  std::string text = KA_TRY(catalogue_template("hfut-mmd", name));
  // The template is changed as text, so its comments stay.
  constexpr std::string_view undescribed = "description = \"\"";
  if (const std::size_t at = text.find(undescribed); at != std::string::npos) {
    text.replace(at, undescribed.size(),
                 "description = \"simulated by kinalign benchmark twin; nobody was recorded\"");
  }
  for (const TwinAction& action : twin_actions()) {
    constexpr std::string_view unnamed = "name = \"\"";
    const std::size_t table = text.find("[action." + std::string(action.id) + "]");
    const std::size_t at = table == std::string::npos ? table : text.find(unnamed, table);
    if (at == std::string::npos) continue;
    text.replace(at, unnamed.size(), "name = \"" + std::string(action.name) + "\"");
  }
  return text;
}

}  // namespace kinalign
