// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_cleaner.h"

#include "kinalign/infer/shapes.h"
#include "kinalign/models/bones.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t remembered_frames = 60;  // of a network that sees the whole sequence
constexpr std::size_t filled_frames = 15;      // joints that are missing at the window's begin

std::size_t half(const Smoothing& how) { return how.window / 2; }

/// Frames on each side that are seen beside what the network sees.
std::size_t smoothed_frames(const DenoiseModel& model) {
  return half(model.layout.smoothing) + half(model.steadying.smoothing);
}

bool misses_joints(const JointFrames& body, std::size_t row) {
  const auto begin = body.seen.begin() + static_cast<std::ptrdiff_t>(row * body.joints);
  const auto end = begin + static_cast<std::ptrdiff_t>(body.joints);
  return std::find(begin, end, std::uint8_t{0}) != end;
}

JointFrames rows_from(const JointFrames& body, std::size_t first) {
  const auto begin = static_cast<std::ptrdiff_t>(first * body.joints);
  return {body.joints,
          {body.positions.begin() + 3 * begin, body.positions.end()},
          {body.seen.begin() + begin, body.seen.end()}};
}

Steadying without_bones(Steadying how) {
  how.bones = false;
  return how;
}

}  // namespace

LiveCleaner::LiveCleaner(Denoiser& denoiser, std::size_t look_ahead)
    : denoiser_(&denoiser),
      steadier_(without_bones(denoiser.model().steadying), denoiser.model().layout),
      partners_(mirror_partners(denoiser.model().layout.outputs)) {
  const DenoiseModel& model = denoiser.model();
  const auto ahead = kinalign::look_ahead(model.architecture);
  const auto back = look_back(model.architecture);
  const bool is_bounded = ahead && !model.second;
  ahead_ = is_bounded ? std::min(look_ahead, *ahead + smoothed_frames(model)) : look_ahead;
  behind_ = back.value_or(remembered_frames) + smoothed_frames(model) + filled_frames;
  window_.joints = model.layout.inputs.size();
}

std::optional<std::vector<float>> LiveCleaner::step(const JointFrames& frame) {
  window_.positions.insert(window_.positions.end(), frame.positions.begin(), frame.positions.end());
  window_.seen.insert(window_.seen.end(), frame.seen.begin(), frame.seen.end());
  if (window_.frames() - next_ <= ahead_) return std::nullopt;
  return joints_at(next_);
}

std::optional<std::vector<float>> LiveCleaner::finish() {
  if (next_ == window_.frames()) return std::nullopt;
  return joints_at(next_);
}

/// Of the rows that an answer for `row` depends on. No row before it matters where it sees all
/// joints; else earlier rows fill what it misses.
std::size_t LiveCleaner::first_row_for(std::size_t row) const {
  std::size_t first = row - std::min(row, behind_ - filled_frames);
  while (first > 0 && misses_joints(window_, first)) --first;
  return first;
}

std::vector<float> LiveCleaner::joints_at(std::size_t row) {
  const auto answer = [this](const JointFrames& body) { return denoiser_->answer(body); };
  const std::size_t first = first_row_for(row);
  const JointFrames body = rows_from(window_, first);
  const std::vector<float> all = steadier_.steadied(answer, body, answer(body)).positions;
  const DenoiseLayout& layout = denoiser_->model().layout;
  const auto width = static_cast<std::ptrdiff_t>(3 * layout.outputs.size());
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(row - first) * width;
  std::vector<float> out(begin, begin + width);
  answers_.insert(answers_.end(), out.begin(), out.end());
  const std::size_t remembered = std::min(answers_.size(), remembered_lengths * out.size());
  if (denoiser_->model().steadying.bones) {
    impose_lengths(layout.parents,
                   typical_lengths(layout.parents, partners_,
                                   std::span(answers_).subspan(answers_.size() - remembered)),
                   out);
  }
  for (++next_; next_ > behind_; --next_) {
    const auto joints = static_cast<std::ptrdiff_t>(window_.joints);
    window_.positions.erase(window_.positions.begin(), window_.positions.begin() + 3 * joints);
    window_.seen.erase(window_.seen.begin(), window_.seen.begin() + joints);
  }
  return out;
}

std::vector<float> LiveCleaner::whole() const {
  std::vector<float> out = answers_;
  const std::vector<int>& parents = denoiser_->model().layout.parents;
  if (denoiser_->model().steadying.bones && !out.empty()) {
    impose_lengths(parents, typical_lengths(parents, partners_, out), out);
  }
  return out;
}

}  // namespace kinalign
