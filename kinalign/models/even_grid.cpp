// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/even_grid.h"

#include "kinalign/models/body_frame.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/motion/median.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace kinalign {

namespace {

constexpr double most_frames = 1e7;
// Limits for input that a model can't use, or that its user should know of. docs/denoise.md lists
// the usual causes: millimetres, or another axis that points up.
/// If the head is lower than the root by more than this, m, the y axis does not point up. Head and
/// root of a person who lies down are at about the same height.
constexpr float least_below = 0.2F;
constexpr float most_reach = 1.6F;                   // m, from the root to a joint
constexpr double most_speed = 8.0;                   // m/s, of the root
constexpr double least_size = 0.4, most_size = 2.6;  // m, from the lowest to the highest joint

std::string text_of(double value, const char* unit) {
  char text[80];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  return text;
}

/// The median step between samples, s.
double usual_step(const std::vector<Time>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    steps.push_back(static_cast<double>(to_ns(stamps[i]) - to_ns(stamps[i - 1])) * 1e-9);
  }
  return upper_median(std::move(steps));
}

/// Fails if the stamps can't be brought onto a grid of that rate.
Result<void> check_stamps(const std::vector<Time>& stamps, double rate_hz) {
  if (stamps.size() < 2) {
    return Failure(Error{"", 0, "at least two frames", std::to_string(stamps.size())});
  }
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] < stamps[i - 1]) {
      return Failure(Error{"", 0, "rising stamps", "frame " + std::to_string(i) + " is earlier"});
    }
  }
  // Pauses and dropped frames hardly change the median, so they alone do not make the check fail.
  const double step = usual_step(stamps);
  if (step * rate_hz > 2.0 || step * rate_hz < 0.25) {
    return Failure(Error{"", 0, "about " + text_of(rate_hz, "frames a second"),
                         text_of(1.0 / std::max(step, 1e-9), "frames a second")});
  }
  return {};
}

/// The index of each wanted joint among `names`. Fails if a joint that the body's frame needs is
/// absent.
Result<std::vector<std::optional<std::size_t>>> places_of(const std::vector<std::string>& wanted,
                                                          const std::vector<std::string>& names) {
  std::vector<std::optional<std::size_t>> out;
  out.reserve(wanted.size());
  for (const std::string& name : wanted) out.push_back(index_of(names, name));
  // Other joints may be absent: they are then missing in every frame.
  const auto needed = body_joints(wanted);
  std::vector<std::size_t> joints = needed ? needed->root : std::vector<std::size_t>{};
  if (needed) {
    joints.push_back(needed->left_right.front()[0]);
    joints.push_back(needed->left_right.front()[1]);
  }
  for (const std::size_t j : joints) {
    if (out[j]) continue;
    return Failure(Error{"", 0, "a joint \"" + wanted[j] + "\", which the model needs",
                         "no such joint", ErrorKind::no_such_joint});
  }
  return out;
}

/// The median height of the body, m, over frames in which more than half of the joints are seen.
/// With a median, single frames with far joints do not make a whole recording invalid.
double body_size(const JointFrames& body) {
  std::vector<double> sizes;
  for (std::size_t t = 0; t < body.frames(); ++t) {
    double low = 1e9, high = -1e9;
    std::size_t seen = 0;
    for (std::size_t j = 0; j < body.joints; ++j) {
      if (body.seen[t * body.joints + j] == 0) continue;
      ++seen;
      const double y = body.positions[(t * body.joints + j) * 3 + 1];
      low = std::min(low, y);
      high = std::max(high, y);
    }
    if (2 * seen > body.joints) sizes.push_back(high - low);
  }
  return sizes.empty() ? 0.0 : upper_median(std::move(sizes));
}

/// The indices of the head and the root of a body, if the model has both.
struct Upright {
  std::size_t head = 0, root = 0;
};
std::optional<Upright> upright_of(const std::vector<std::string>& joints) {
  const auto names = kinect_names(joints);
  const auto head = index_of(names, "Head"), root = index_of(names, "SpineBase");
  if (!head || !root) return std::nullopt;
  return Upright{*head, *root};
}

/// Fails if the head lies more than 0.2 m below the root in more than nine of ten frames.
Result<void> check_upright(const Upright& joints, const JointFrames& body) {
  std::size_t frames = 0, below = 0;
  for (std::size_t t = 0; t < body.frames(); ++t) {
    const std::size_t head = t * body.joints + joints.head, root = t * body.joints + joints.root;
    if (body.seen[head] == 0 || body.seen[root] == 0) continue;
    ++frames;
    if (body.positions[3 * head + 1] < body.positions[3 * root + 1] - least_below) ++below;
  }
  if (frames == 0 || 10 * below <= 9 * frames) return {};
  return Failure(Error{"", 0, "y up: a head above the hips",
                       "a head below the hips in " + std::to_string(below) + " of " +
                           std::to_string(frames) + " frames"});
}

float gap_between(const float* a, const float* b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Sets joints too far from the root to missing; returns their number.
/// Their positions become 0, because JointFrames holds zeros where a joint is missing.
std::size_t leave_out_far(std::size_t root_joint, JointFrames& body) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < body.seen.size(); ++i) {
    const std::size_t root = i / body.joints * body.joints + root_joint;
    if (body.seen[i] == 0 || body.seen[root] == 0) continue;
    if (gap_between(&body.positions[3 * i], &body.positions[3 * root]) <= most_reach) continue;
    body.seen[i] = 0;
    std::fill_n(&body.positions[3 * i], 3, 0.0F);
    ++out;
  }
  return out;
}

/// The first frame in which the root has moved faster than a person can since the frame before.
/// Such a jump may mean that the device has begun to follow another person (docs/denoise.md).
std::optional<std::size_t> first_jump(std::size_t root_joint, const JointFrames& body,
                                      double rate_hz) {
  const auto most = static_cast<float>(most_speed / rate_hz);
  for (std::size_t t = 1; t < body.frames(); ++t) {
    const std::size_t now = t * body.joints + root_joint, before = now - body.joints;
    if (body.seen[now] == 0 || body.seen[before] == 0) continue;
    if (gap_between(&body.positions[3 * now], &body.positions[3 * before]) > most) return t;
  }
  return std::nullopt;
}

/// A joint at a time between sample `before` and the next one.
struct Between {
  std::size_t before, joint;
  double share;  // 0 at sample `before`, 1 at the next one
};

/// Writes the interpolated joint to place `at` of the body's joints, unless it is missing.
void put_joint(const PointFrames& points, const Between& where, std::size_t at, JointFrames& body) {
  const std::size_t names = points.state.size() / points.size();
  const std::size_t a = where.before * names + where.joint, b = a + names;
  const double share = where.share;
  auto seen = std::min(points.state[a], points.state[b]);
  // At the time of a sample only that sample's state counts. Otherwise a joint would also be
  // missing in the frames before and after a frame in which it is missing.
  if (share < 1e-6) seen = points.state[a];
  if (share > 1 - 1e-6) seen = points.state[b];
  body.seen[at] = static_cast<std::uint8_t>(seen);
  if (seen == Tracking::missing) return;
  for (std::size_t k = 0; k < 3; ++k) {
    body.positions[at * 3 + k] = static_cast<float>(points.positions[3 * a + k] * (1.0 - share) +
                                                    points.positions[3 * b + k] * share);
  }
}

}  // namespace

EvenSpan span_of(Time first, Time last, double rate_hz) {
  // With the extra half step, stamps of 33.3 ms with jitter still give a frame for each sample.
  const double steps = static_cast<double>(to_ns(last) - to_ns(first)) * 1e-9 * rate_hz + 0.5;
  return {first, static_cast<std::size_t>(std::clamp(steps, 0.0, most_frames)) + 1};
}

// Everything is done in one pass: `before` only moves forward, because the grid's times rise. Times
// up to half a step beyond both ends use the first or the last sample, as in span_of().
JointFrames joints_on_grid(const std::vector<std::optional<std::size_t>>& places,
                           const PointFrames& points, const EvenGrid& grid) {
  const auto at_s = [&](std::size_t i) {
    return static_cast<double>(to_ns(points.stamps[i]) - to_ns(points.stamps.front())) * 1e-9;
  };
  const double last = at_s(points.size() - 1), edge = 0.5 / grid.rate_hz;
  const double begin =
      static_cast<double>(to_ns(grid.span->start) - to_ns(points.stamps.front())) * 1e-9;
  const std::size_t frames = grid.span->frames, joints = places.size();
  JointFrames out{joints, std::vector<float>(frames * joints * 3, 0.0F),
                  std::vector<std::uint8_t>(frames * joints, 0)};
  std::size_t before = 0;
  for (std::size_t t = 0; t < frames; ++t) {
    const double asked = begin + static_cast<double>(t) / grid.rate_hz;
    if (asked < -edge || asked > last + edge) continue;
    const double time = std::clamp(asked, 0.0, last);
    while (before + 2 < points.size() && at_s(before + 1) <= time) ++before;
    const double from = at_s(before), to = at_s(before + 1);
    const double share = to > from ? std::clamp((time - from) / (to - from), 0.0, 1.0) : 0.0;
    if (std::min(time - from, to - time) > grid.gap_s) continue;
    for (std::size_t j = 0; j < joints; ++j) {
      if (places[j]) put_joint(points, {before, *places[j], share}, t * joints + j, out);
    }
  }
  return out;
}

Result<EvenFrames> even_frames(const std::vector<std::string>& wanted,
                               const std::vector<std::string>& names, const PointFrames& points,
                               const EvenGrid& grid) {
  const double rate_hz = grid.rate_hz;
  KA_TRY(check_stamps(points.stamps, rate_hz));
  const auto places = KA_TRY(places_of(wanted, names));
  const auto at_s = [&](std::size_t i) {
    return static_cast<double>(to_ns(points.stamps[i]) - to_ns(points.stamps.front())) * 1e-9;
  };
  const double last = at_s(points.size() - 1);
  const EvenSpan span =
      grid.span ? *grid.span : span_of(points.stamps.front(), points.stamps.back(), rate_hz);
  const std::size_t frames = span.frames;
  if (static_cast<double>(frames) >= most_frames) {
    return Failure(Error{"", 0, "at most 10,000,000 frames", text_of(last * rate_hz, "frames")});
  }
  EvenFrames out{.body = joints_on_grid(places, points, {rate_hz, grid.gap_s, span}),
                 .start = span.start,
                 .rate_hz = rate_hz};
  // The size is checked before far joints are removed: in millimetres nearly all joints would be
  // far, and the message would not name the reason.
  const double size = body_size(out.body);
  if (size < least_size || size > most_size) {
    return Failure(Error{"", 0, "a body of 0.4 to 2.6 m, in metres, y up",
                         text_of(size, "m from the lowest joint to the highest")});
  }
  if (const auto joints = upright_of(wanted)) {
    KA_TRY(check_upright(*joints, out.body));
    out.far = leave_out_far(joints->root, out.body);
    if (const auto frame = first_jump(joints->root, out.body, rate_hz)) {
      out.jump_s = static_cast<double>(*frame) / rate_hz;
    }
  }
  return out;
}

}  // namespace kinalign
