// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/bones.h"

#include "kinalign/motion/median.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Both values were found by trials on UI-PRMD, in which they improved positions and halved the
// error of bone lengths. Setting lengths only from the root outward made hands and feet worse.
constexpr int sweeps = 40;
/// A joint moves by this multiple of its mean move (over-relaxation), so that fewer sweeps are
/// needed.
constexpr float beyond = 1.2F;

/// Joints in an order in which every parent stands before its children.
std::vector<std::size_t> outward(const std::vector<int>& parents) {
  std::vector<std::size_t> order;
  std::vector<bool> taken(parents.size(), false);
  while (order.size() < parents.size()) {
    const std::size_t before = order.size();
    for (std::size_t j = 0; j < parents.size(); ++j) {
      if (taken[j] || (parents[j] >= 0 && !taken[static_cast<std::size_t>(parents[j])])) continue;
      taken[j] = true;
      order.push_back(j);
    }
    if (order.size() == before) break;  // a cycle; no valid skeleton has one
  }
  return order;
}

float distance(const float* a, const float* b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The joints of one frame, changed in place.
/// `moves_` and `counts_` are buffers of sweep(); their contents do not outlive a call.
class Frame {
 public:
  Frame(const std::vector<int>& parents, const std::vector<float>& lengths, float* joints)
      : parents_(parents), lengths_(lengths), joints_(joints), moves_(3 * parents.size()) {}

  /// Moves both ends of each bone by half the error of its length. The moves of a joint are
  /// averaged. All moves are first summed and then applied, so the result does not depend on the
  /// order of the bones.
  void sweep() {
    std::fill(moves_.begin(), moves_.end(), 0.0F);
    std::vector<int>& counts = counts_;
    counts.assign(parents_.size(), 0);
    for (std::size_t j = 0; j < parents_.size(); ++j) {
      if (parents_[j] < 0) continue;
      const auto p = static_cast<std::size_t>(parents_[j]);
      const float* a = &joints_[3 * p];
      const float* b = &joints_[3 * j];
      const float length = distance(a, b);
      if (length < 1e-6F) continue;
      const float share = 0.5F * (length - lengths_[j]) / length;
      for (std::size_t k = 0; k < 3; ++k) {
        moves_[3 * p + k] += share * (b[k] - a[k]);
        moves_[3 * j + k] -= share * (b[k] - a[k]);
      }
      ++counts[p];
      ++counts[j];
    }
    for (std::size_t j = 0; j < parents_.size(); ++j) {
      if (counts[j] == 0) continue;
      const float step = beyond / static_cast<float>(counts[j]);
      for (std::size_t k = 0; k < 3; ++k) joints_[3 * j + k] += step * moves_[3 * j + k];
    }
  }

  /// Sets the exact lengths from the roots outward and keeps each bone's direction. A bone of
  /// length 0 points up.
  void set_lengths(const std::vector<std::size_t>& order) {
    // Directions come from the joints before this pass, because each step moves the parent of the
    // next joint.
    const std::vector<float> before(joints_, joints_ + 3 * parents_.size());
    for (const std::size_t j : order) {
      if (parents_[j] < 0) continue;
      const auto p = static_cast<std::size_t>(parents_[j]);
      const float length = distance(&before[3 * p], &before[3 * j]);
      for (std::size_t k = 0; k < 3; ++k) {
        const float direction = length < 1e-6F ? (k == 1 ? 1.0F : 0.0F)
                                               : (before[3 * j + k] - before[3 * p + k]) / length;
        joints_[3 * j + k] = joints_[3 * p + k] + lengths_[j] * direction;
      }
    }
  }

 private:
  const std::vector<int>& parents_;
  const std::vector<float>& lengths_;
  float* joints_;
  std::vector<float> moves_;
  std::vector<int> counts_;
};

}  // namespace

std::vector<float> typical_lengths(const std::vector<int>& parents,
                                   const std::vector<std::size_t>& partners,
                                   std::span<const float> positions) {
  const std::size_t joints = parents.size(), frames = positions.size() / (3 * joints);
  std::vector<float> out(joints, 0.0F), all(frames);
  for (std::size_t j = 0; j < joints && frames > 0; ++j) {
    if (parents[j] < 0) continue;
    const auto p = static_cast<std::size_t>(parents[j]);
    for (std::size_t t = 0; t < frames; ++t) {
      all[t] = distance(&positions[(t * joints + p) * 3], &positions[(t * joints + j) * 3]);
    }
    out[j] = upper_median(all);
  }
  for (std::size_t j = 0; j < joints; ++j) {
    // Both sides of a body are taken to be equally long, so two medians give a better length than
    // one.
    if (partners[j] > j) out[j] = out[partners[j]] = 0.5F * (out[j] + out[partners[j]]);
  }
  return out;
}

void impose_lengths(const std::vector<int>& parents, const std::vector<float>& lengths,
                    std::span<float> positions) {
  const std::vector<std::size_t> order = outward(parents);
  for (std::size_t at = 0; at + 3 * parents.size() <= positions.size(); at += 3 * parents.size()) {
    Frame frame(parents, lengths, &positions[at]);
    for (int i = 0; i < sweeps; ++i) frame.sweep();
    frame.set_lengths(order);
  }
}

}  // namespace kinalign
