// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/dataset_page/skeleton_svg.h"

#include "kinalign/take/recording.h"
#include "kinalign/view/page/page_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

// Units of the picture. A unit is half a pixel, because the picture is displayed at half its size.
constexpr double width = 120.0, height = 160.0, margin = 6.0;
// The scale is limited: a body that is small because of wrong units stays small in the picture.
constexpr double most_units_per_m = 90.0;
// A position farther away is an error and would make the rest of the picture too small.
constexpr double farthest_m = 1000.0;

/// A bone in metres, in the take's space, before projection.
struct Bone {
  Vec3 from, to;
  bool inferred = false;
};

/// A joint without a bone, such as a marker.
struct Dot {
  Vec3 at;
  bool inferred = false;
};

/// The parts of a body that are drawn, all in one colour.
struct Drawn {
  std::string_view colour;
  std::vector<Bone> bones;
  std::vector<Dot> dots;

  /// Returns all positions that the picture must contain.
  std::vector<Vec3> places() const {
    std::vector<Vec3> out;
    for (const Bone& bone : bones) out.insert(out.end(), {bone.from, bone.to});
    for (const Dot& dot : dots) out.push_back(dot.at);
    return out;
  }
};

bool is_drawable(const Vec3& place) {
  return place.allFinite() && place.cwiseAbs().maxCoeff() < farthest_m;
}

/// Returns which joints belong to a bone: those with a parent or a child.
std::vector<bool> joints_on_bones(const PageBody& body) {
  std::vector<bool> out(body.parents.size(), false);
  for (std::size_t j = 0; j < body.parents.size(); ++j) {
    if (body.parents[j] < 0) continue;
    out[j] = true;
    out[static_cast<std::size_t>(body.parents[j])] = true;
  }
  return out;
}

/// Returns the bones and dots of a body. Parts that are missing or too far away are omitted.
Drawn drawn(const PageBody& body) {
  Drawn out{to_string(body.colour), {}, {}};
  const auto state = [&body](std::size_t joint) {
    return body.state.empty() ? Tracking::tracked : static_cast<Tracking>(body.state[joint]);
  };
  const auto place = [&body](std::size_t joint) {
    const float* p = &body.positions[3 * joint];
    return Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
  };
  const std::vector<bool> on_bone = joints_on_bones(body);
  for (std::size_t j = 0; j < body.parents.size(); ++j) {
    // A root has no parent, so its own index is used here; the checks below then apply to it too.
    const bool has_parent = body.parents[j] >= 0;
    const std::size_t p = has_parent ? static_cast<std::size_t>(body.parents[j]) : j;
    const Tracking least = std::min(state(j), state(p));
    if (least == Tracking::missing || !is_drawable(place(j)) || !is_drawable(place(p))) continue;
    const bool inferred = least == Tracking::inferred;
    if (has_parent) out.bones.push_back({place(p), place(j), inferred});
    if (!on_bone[j]) out.dots.push_back({place(j), inferred});
  }
  return out;
}

/// Returns the horizontal axis with the largest spread of the lower ends of bones and of the dots.
/// The axis points towards +x, or else towards +z.
Vec3 widest_axis(const std::vector<Drawn>& bodies) {
  double n = 0.0, x = 0.0, z = 0.0, xx = 0.0, xz = 0.0, zz = 0.0;
  const auto add = [&](const Vec3& place) {
    n += 1.0;
    x += place.x();
    z += place.z();
    xx += place.x() * place.x();
    xz += place.x() * place.z();
    zz += place.z() * place.z();
  };
  for (const Drawn& body : bodies) {
    for (const Bone& bone : body.bones) add(bone.to);
    for (const Dot& dot : body.dots) add(dot.at);
  }
  // The direction of the largest variance: half the angle of the covariance (principal axis).
  const double angle =
      0.5 * std::atan2(2.0 * (xz - x * z / n), (xx - x * x / n) - (zz - z * z / n));
  return {std::cos(angle), 0.0, std::sin(angle)};  // at most 90 degrees away from +x
}

/// Converts metres to units of the picture. All bodies have the same conversion, so their relative
/// positions are as in the take. The scale is the smallest of those that the limits allow.
class Camera {
 public:
  explicit Camera(const std::vector<Drawn>& bodies) : axis_(widest_axis(bodies)) {
    for (const Drawn& body : bodies) {
      for (const Vec3& place : body.places()) {
        left_ = std::min(left_, axis_.dot(place));
        right_ = std::max(right_, axis_.dot(place));
        bottom_ = std::min(bottom_, place.y());
        top_ = std::max(top_, place.y());
      }
    }
    const double wide = std::max(right_ - left_, 1e-3), high = std::max(top_ - bottom_, 1e-3);
    scale_ =
        std::min({most_units_per_m, (width - 2 * margin) / wide, (height - 2 * margin) / high});
  }
  std::pair<int, int> at(const Vec3& place) const {
    const double across = axis_.dot(place) - 0.5 * (left_ + right_);
    return {static_cast<int>(std::lround(0.5 * width + scale_ * across)),
            static_cast<int>(std::lround(height - margin - scale_ * (place.y() - bottom_)))};
  }

 private:
  Vec3 axis_;
  double left_ = std::numeric_limits<double>::infinity(), right_ = -left_;
  double bottom_ = left_, top_ = -left_, scale_ = 1.0;
};

/// Returns the path of all inferred bones, or of all other bones. Bones shorter than a pixel are
/// omitted.
std::string path_of(const std::vector<Bone>& bones, bool inferred, const Camera& camera) {
  std::string out;
  std::pair<int, int> pen{-1, -1};
  for (const Bone& bone : bones) {
    if (bone.inferred != inferred) continue;
    // Integers keep the text short; fractions of half a pixel are not visible.
    const auto from = camera.at(bone.from), to = camera.at(bone.to);
    if (std::abs(from.first - to.first) + std::abs(from.second - to.second) < 3) continue;
    // Connected bones need only one "M" command, which keeps a page with hundreds of pictures
    // small.
    if (from != pen) out += fmt::format("M{} {}", from.first, from.second);
    out += fmt::format("L{} {}", to.first, to.second);
    pen = to;
  }
  return out;
}

/// Returns the path of the dots: lines of length 0 with round ends.
std::string path_of(const std::vector<Dot>& dots, bool inferred, const Camera& camera) {
  std::string out;
  for (const Dot& dot : dots) {
    const auto at = camera.at(dot.at);
    if (dot.inferred == inferred) out += fmt::format("M{} {}h0", at.first, at.second);
  }
  return out;
}

}  // namespace

std::string skeleton_svg(const std::vector<PageBody>& bodies) {
  std::vector<Drawn> all;
  for (const PageBody& body : bodies) {
    if (!body.in_take_space) continue;
    Drawn one = drawn(body);
    if (!one.bones.empty() || !one.dots.empty()) all.push_back(std::move(one));
  }
  if (all.empty()) return "";
  // All bodies of the take have the same view.
  const Camera camera(all);
  std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\">", width, height);
  const auto add = [&out](std::string_view colour, std::string_view kind, const std::string& path) {
    if (path.empty()) return;
    out += fmt::format("<path class=\"{}{}\" d=\"{}\"/>", colour, kind, path);
  };
  for (const Drawn& one : all) {
    add(one.colour, "", path_of(one.bones, false, camera));
    add(one.colour, " dashed", path_of(one.bones, true, camera));
    add(one.colour, " dots", path_of(one.dots, false, camera));
    add(one.colour, " dots pale", path_of(one.dots, true, camera));
  }
  return out + "</svg>";
}

}  // namespace kinalign
