// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/linear.h"

#include "kinalign/evaluate/statistics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace kinalign {

namespace {

// Number of frames before and after the middle frame; the window has nine frames.
constexpr std::size_t half_window = 4;
// Features are divided by this length, so their size is about 1 for any data and the penalty has
// the same effect.
constexpr double feature_scale = 0.05;  // m

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Index whole(std::size_t value) { return static_cast<Eigen::Index>(value); }

/// Returns the heading of the body in each frame, from the uncleaned joints.
std::vector<BodyFrame> headings(const DenoiseLayout& layout, const JointFrames& body) {
  return body_frames(*body_joints(layout.inputs), body);
}

/// Writes the positions of nine frames relative to the root of the middle frame, in its heading: [9
/// * 3J] m.
void put_features(const JointFrames& body, const std::vector<BodyFrame>& frames, std::size_t t,
                  double* out) {
  const std::size_t last = body.frames() - 1;
  // Before the beginning and after the end of a take, its first or last frame is repeated.
  for (std::size_t k = 0; k <= 2 * half_window; ++k) {
    const std::size_t u = std::min(t + k < half_window ? 0 : t + k - half_window, last);
    for (std::size_t j = 0; j < body.joints; ++j) {
      const float* at = &body.positions[(u * body.joints + j) * 3];
      const std::array<float, 3> moved{at[0] - frames[t].root[0], at[1] - frames[t].root[1],
                                       at[2] - frames[t].root[2]};
      for (const float value : frames[t].turned(moved.data())) *out++ = value;
    }
  }
}

/// Returns truth minus base in the axes of the body's heading, m.
std::array<float, 3> offset_of(const BodyFrame& frame, const float* truth, const float* base) {
  const std::array<float, 3> moved{truth[0] - base[0], truth[1] - base[1], truth[2] - base[2]};
  return frame.turned(moved.data());
}

/// Moves a joint by an offset in the axes of the body's heading.
void add_turned(const BodyFrame& frame, const float* offset, float* at) {
  const auto turned = frame.turned_back(offset);
  for (std::size_t k = 0; k < 3; ++k) at[k] += turned[k];
}

/// A body without gaps, its headings, and the input joints that correspond to the outputs.
struct Prepared {
  JointFrames body;
  std::vector<BodyFrame> frames;
  std::vector<float> base;  // [T,Jout,3] m

  Prepared(const DenoiseLayout& layout, JointFrames seen) : body(std::move(seen)) {
    // Gaps are filled as the layout does for a network. If the layout is causal, no later frames
    // are used.
    fill_missing(body, layout.smoothing.causal);
    frames = headings(layout, body);
    for (std::size_t t = 0; t < body.frames(); ++t) {
      for (const int joint : layout.bases) {
        // If no input joint corresponds to the output, `joint` is negative and the root is used.
        const float* at =
            joint < 0 ? frames[t].root.data()
                      : &body.positions[(t * body.joints + static_cast<std::size_t>(joint)) * 3];
        base.insert(base.end(), at, at + 3);
      }
    }
  }
};

}  // namespace

std::vector<float> base_joints(const DenoiseLayout& layout, JointFrames body) {
  return Prepared(layout, std::move(body)).base;
}

/// Computes the mean offset of each joint over all valid samples.
MeanOffset::MeanOffset(const DenoiseLayout& layout, const std::vector<const Pair*>& learnt) {
  const std::size_t joints = layout.outputs.size();
  std::vector<double> sums(3 * joints, 0.0), counts(joints, 0.0);
  for (const Pair* pair : learnt) {
    const Prepared seen(layout, pair->input);
    for (std::size_t i = 0; i < pair->valid.size(); ++i) {
      if (pair->valid[i] == 0) continue;
      const auto offset =
          offset_of(seen.frames[i / joints], &pair->truth[3 * i], &seen.base[3 * i]);
      for (std::size_t k = 0; k < 3; ++k) sums[3 * (i % joints) + k] += offset[k];
      counts[i % joints] += 1.0;
    }
  }
  // A joint that is never valid gets the offset 0.
  for (std::size_t c = 0; c < sums.size(); ++c) {
    mean_.push_back(static_cast<float>(sums[c] / std::max(counts[c / 3], 1.0)));
  }
}

std::vector<float> MeanOffset::clean(const DenoiseLayout& layout, const JointFrames& body) const {
  Prepared seen(layout, body);
  std::vector<float> out = std::move(seen.base);
  const std::size_t joints = layout.outputs.size();
  for (std::size_t i = 0; 3 * i < out.size(); ++i) {
    add_turned(seen.frames[i / joints], &mean_[3 * (i % joints)], &out[3 * i]);
  }
  return out;
}

struct Ridge::Fit {
  Eigen::RowVectorXd mean;  // mean of the features
  Matrix weights;           // [features + 1, 3 Jout]
};

namespace {

/// The sums of the normal equations, over frames in which all joints are valid.
struct Normal {
  Matrix gram, moment;

  void add(const Matrix& features, const Matrix& targets) {
    if (gram.size() == 0) {
      gram = Matrix::Zero(features.cols(), features.cols());
      moment = Matrix::Zero(features.cols(), targets.cols());
    }
    gram.noalias() += features.transpose() * features;
    moment.noalias() += features.transpose() * targets;
  }

  // Solves (G + penalty I) w = M by Cholesky. The last feature is the constant 1. It has no
  // penalty, so the mean offset is not reduced.
  Matrix solved(double penalty) const {
    Matrix ridge = gram;
    for (Eigen::Index i = 0; i + 1 < ridge.rows(); ++i) ridge(i, i) += penalty;
    return ridge.llt().solve(moment);
  }
};

/// Computes the features of the frames in which all joints are valid: minus `mean`, scaled,
/// followed by a 1. Also computes the targets, m.
void frames_of(const DenoiseLayout& layout, const Pair& pair, const Eigen::RowVectorXd& mean,
               Matrix& features, Matrix& targets) {
  const Prepared seen(layout, pair.input);
  const std::vector<BodyFrame>& frames = seen.frames;
  const std::size_t joints = layout.outputs.size();
  // A frame with an invalid joint is omitted. All outputs then have the same frames and need only
  // one Gram matrix.
  std::vector<std::size_t> rows;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const auto* valid = &pair.valid[t * joints];
    if (std::all_of(valid, valid + joints, [](std::uint8_t one) { return one != 0; })) {
      rows.push_back(t);
    }
  }
  features.resize(whole(rows.size()), mean.size() + 1);
  targets.resize(whole(rows.size()), whole(3 * joints));
  std::vector<double> line(static_cast<std::size_t>(mean.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    put_features(seen.body, frames, rows[r], line.data());
    for (Eigen::Index c = 0; c < mean.size(); ++c) {
      features(whole(r), c) = (line[static_cast<std::size_t>(c)] - mean(c)) / feature_scale;
    }
    features(whole(r), mean.size()) = 1.0;
    for (std::size_t j = 0; j < joints; ++j) {
      const std::size_t i = rows[r] * joints + j;
      const auto offset = offset_of(frames[rows[r]], &pair.truth[3 * i], &seen.base[3 * i]);
      for (std::size_t k = 0; k < 3; ++k) targets(whole(r), whole(3 * j + k)) = offset[k];
    }
  }
}

}  // namespace

/// Makes two passes: the first computes the mean of the features, the second sums the normal
/// equations. Only sums are stored, so memory does not grow with the number of takes.
Ridge::Ridge(const DenoiseLayout& layout, const std::vector<const Pair*>& learnt, double penalty)
    : fit_(std::make_unique<Fit>()) {
  const auto width = whole((2 * half_window + 1) * 3 * layout.inputs.size());
  const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(width);
  Matrix features, targets;
  Eigen::RowVectorXd sum = zero;
  double count = 0.0;
  for (const Pair* pair : learnt) {
    frames_of(layout, *pair, zero, features, targets);
    // The mean is 0 here, so the features are only scaled. Multiplying gives their sum in metres.
    if (features.rows() == 0) continue;
    sum += features.leftCols(width).colwise().sum() * feature_scale;
    count += static_cast<double>(features.rows());
  }
  fit_->mean = sum / std::max(count, 1.0);
  Normal normal;
  for (const Pair* pair : learnt) {
    frames_of(layout, *pair, fit_->mean, features, targets);
    if (features.rows() > 0) normal.add(features, targets);
  }
  // Without a complete frame, the weights are 0 and the result equals the input.
  fit_->weights = normal.gram.size() == 0 ? Matrix(Matrix::Zero(width + 1, whole(layout.answers())))
                                          : normal.solved(penalty);
}

Ridge::Ridge(Ridge&&) noexcept = default;
Ridge& Ridge::operator=(Ridge&&) noexcept = default;
Ridge::~Ridge() = default;

std::vector<float> Ridge::clean(const DenoiseLayout& layout, const JointFrames& body) const {
  Prepared seen(layout, body);
  std::vector<float> out = std::move(seen.base);
  const std::size_t joints = layout.outputs.size();
  Eigen::RowVectorXd line(fit_->mean.size() + 1);
  for (std::size_t t = 0; t < seen.frames.size(); ++t) {
    put_features(seen.body, seen.frames, t, line.data());
    line.head(fit_->mean.size()) = (line.head(fit_->mean.size()) - fit_->mean) / feature_scale;
    line(fit_->mean.size()) = 1.0;
    const Eigen::RowVectorXd offsets = line * fit_->weights;
    for (std::size_t j = 0; j < joints; ++j) {
      const std::array<float, 3> offset{static_cast<float>(offsets(whole(3 * j))),
                                        static_cast<float>(offsets(whole(3 * j + 1))),
                                        static_cast<float>(offsets(whole(3 * j + 2)))};
      add_turned(seen.frames[t], offset.data(), &out[(t * joints + j) * 3]);
    }
  }
  return out;
}

namespace {

// Groups limit the number of fits to five for any number of people.
constexpr std::size_t most_groups = 5;
constexpr double ratio_of_one_person = 1.5;
/// Chosen from UI-PRMD's seven people and 24 simulated people, for whom a share of 0.95 contained
/// 96 %.
constexpr double most_share = 0.93;

/// Appends the position errors of valid joints, m.
void put_errors(const DenoiseLayout& layout, const Ridge& ridge, const Pair& pair,
                std::vector<double>& out) {
  const std::vector<float> answer = ridge.clean(layout, pair.input);
  for (std::size_t i = 0; i < pair.valid.size(); ++i) {
    if (pair.valid[i] == 0) continue;
    out.push_back(std::hypot(answer[3 * i] - pair.truth[3 * i],
                             answer[3 * i + 1] - pair.truth[3 * i + 1],
                             answer[3 * i + 2] - pair.truth[3 * i + 2]));
  }
}

/// Returns the quantile of n people's errors that contains 90 % of the errors of another person.
double share_of_people(std::size_t people) {
  const auto n = static_cast<double>(people);
  return std::min(most_share, 0.9 * (n + 1.0) / n);
}

}  // namespace

double unseen_ratio(const DenoiseLayout& layout, const std::vector<Pair>& pairs) {
  std::map<std::string, std::size_t> group_of;
  for (const Pair& pair : pairs) group_of.try_emplace(pair.subject, 0);
  // People are assigned to the groups in the order of their names, so the result does not depend on
  // the order of pairs.
  std::size_t next = 0;
  for (auto& [subject, group] : group_of) group = next++ % most_groups;
  const std::size_t groups = std::min(next, most_groups);
  if (groups < 2) return ratio_of_one_person;
  std::vector<double> seen, unseen;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<const Pair*> learnt;
    for (const Pair& pair : pairs) {
      if (group_of.at(pair.subject) != g) learnt.push_back(&pair);
    }
    const Ridge ridge(layout, learnt);
    for (const Pair& pair : pairs) {
      put_errors(layout, ridge, pair, group_of.at(pair.subject) == g ? unseen : seen);
    }
  }
  // The ratio is at least 1, because methods are not expected to be better for unseen people.
  if (seen.empty() || unseen.empty()) return 1.0;
  const double least = quantile(std::move(seen), 0.9);
  if (least <= 0.0) return 1.0;
  return std::max(1.0, quantile(std::move(unseen), share_of_people(next)) / least);
}

}  // namespace kinalign
