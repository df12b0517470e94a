// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_cleaner.h"

#include "kinalign/infer/shapes.h"
#include "kinalign/models/bones.h"
#include "kinalign/motion/frame_arrays.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t remembered_frames = 60;  // frames kept if the network uses the whole sequence
/// Extra frames, to fill joints that are missing at the start of the window.
constexpr std::size_t filled_frames = 15;

// frames on each side of the smoothed one
std::size_t half(const Smoothing& how) { return how.window / 2; }

/// Frames on each side that the smoothing uses in addition to the network's.
std::size_t smoothed_frames(const DenoiseModel& model) {
  return half(model.layout.smoothing) + half(model.steadying.smoothing);
}

/// The first row at which the network must run again; `rows` and `before` begin with the same
/// frame. Only rows after the last unchanged row count as changed. Rows at the start of the window
/// also change when the window moves, but their earlier results used more frames and are better.
std::size_t first_changed(std::span<const float> rows, std::span<const float> before,
                          std::size_t channels) {
  std::size_t row = std::min(rows.size(), before.size()) / channels;
  const auto is_same = [&](std::size_t t) {
    const auto at = rows.begin() + static_cast<std::ptrdiff_t>(t * channels);
    return std::equal(at, at + static_cast<std::ptrdiff_t>(channels),
                      before.begin() + static_cast<std::ptrdiff_t>(t * channels));
  };
  while (row > 0 && !is_same(row - 1)) --row;
  return row;
}

}  // namespace

LiveCleaner::LiveCleaner(Denoiser& denoiser, std::size_t look_ahead)
    : denoiser_(&denoiser),
      inputs_(mirror_partners(denoiser.model().layout.inputs)),
      outputs_(mirror_partners(denoiser.model().layout.outputs)),
      plain_{WindowNetwork(denoiser.network())},
      mirrored_{WindowNetwork(denoiser.network())} {
  const DenoiseModel& model = denoiser.model();
  const auto ahead = kinalign::look_ahead(model.architecture);
  const auto back = look_back(model.architecture);
  const bool is_bounded = ahead && !model.second;
  ahead_ = is_bounded ? std::min(look_ahead, *ahead + smoothed_frames(model)) : look_ahead;
  behind_ = back.value_or(remembered_frames) + smoothed_frames(model) + filled_frames;
  window_.joints = model.layout.inputs.size();
}

std::optional<std::vector<float>> LiveCleaner::step(const JointFrames& frame) {
  append_to(window_.positions, frame.positions);
  append_to(window_.seen, frame.seen);
  if (window_.frames() - next_ <= ahead_) return std::nullopt;
  return joints_at(next_);
}

std::optional<std::vector<float>> LiveCleaner::finish() {
  if (next_ == window_.frames()) return std::nullopt;
  return joints_at(next_);
}

/// The network's joints [.., Jout, 3] in rows `first` ... `end` - 1, in the body's frames.
std::vector<float> LiveCleaner::positions_of(Seen& seen, DenoiseFeatures features,
                                             std::size_t first, std::size_t end) {
  denoiser_->standardise(features);
  const std::size_t channels = denoiser_->model().layout.channels();
  const std::size_t changed = first_changed(features.input, seen.rows, channels);
  const auto answers = seen.network.run(features.input, features.frames.size(), changed, end);
  Denoised out = denoiser_->answer_of(features, answers, first, end);
  denoiser_->apply_second(out);
  seen.rows = std::move(features.input);
  return std::move(out.positions);
}

/// The joints of `row`, post-processed as by Steadier but without constant bones.
std::vector<float> LiveCleaner::steadied_at(std::size_t row) {
  const DenoiseModel& model = denoiser_->model();
  const Smoothing& smoothing = model.steadying.smoothing;
  std::size_t first = row - std::min(row, smoothing.window);
  std::size_t end = std::min(row + half(smoothing) + 1, window_.frames());
  if (model.second) {  // it uses all rows
    first = 0;
    end = window_.frames();
  }
  const DenoiseFeatures features = denoise_features(model.layout, window_);
  std::vector<float> positions = positions_of(plain_, features, first, end);
  if (model.steadying.mirror) {
    DenoiseFeatures other = features;
    mirror(other, inputs_, outputs_);
    std::vector<float> mirrored = positions_of(mirrored_, std::move(other), first, end);
    mirror_positions(mirrored, outputs_);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i] = 0.5F * (positions[i] + mirrored[i]);
    }
  }
  to_world({features.frames.begin() + static_cast<std::ptrdiff_t>(first),
            features.frames.begin() + static_cast<std::ptrdiff_t>(end)},
           positions);
  smooth(smoothing, model.layout.answers(), positions);
  return row_of(positions, row - first, model.layout.answers());
}

/// Computes the joints of `row` and removes rows from the window that no later frame needs.
std::vector<float> LiveCleaner::joints_at(std::size_t row) {
  std::vector<float> out = steadied_at(row);
  const DenoiseLayout& layout = denoiser_->model().layout;
  append_to(answers_, out);
  const std::size_t remembered = std::min(answers_.size(), remembered_lengths * out.size());
  if (denoiser_->model().steadying.bones) {
    impose_lengths(layout.parents,
                   typical_lengths(layout.parents, outputs_,
                                   std::span(answers_).subspan(answers_.size() - remembered)),
                   out);
  }
  for (++next_; next_ > behind_; --next_) forget_first();
  return out;
}

void LiveCleaner::forget_first() {
  erase_first(window_.positions, 3 * window_.joints);
  erase_first(window_.seen, window_.joints);
  const std::size_t channels = denoiser_->model().layout.channels();
  for (Seen* seen : {&plain_, &mirrored_}) {
    if (!seen->rows.empty()) erase_first(seen->rows, channels);
    seen->network.forget(1);
  }
}

// Live joints use the bone lengths of the last ten seconds. A file gets the medians of the whole
// run instead.
std::vector<float> LiveCleaner::whole() const {
  std::vector<float> out = answers_;
  const std::vector<int>& parents = denoiser_->model().layout.parents;
  if (denoiser_->model().steadying.bones && !out.empty()) {
    impose_lengths(parents, typical_lengths(parents, outputs_, out), out);
  }
  return out;
}

}  // namespace kinalign
