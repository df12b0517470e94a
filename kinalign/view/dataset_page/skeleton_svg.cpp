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

// Units of the picture: it is shown half as large, so that a unit is half a pixel.
constexpr double width = 120.0, height = 160.0, margin = 6.0;
constexpr double most_units_per_m = 90.0;  // a small body, as in a file of other units, shows
constexpr double farthest_m = 1000.0;      // a broken number does not blow the picture up

struct Bone {
  Vec3 from, to;
  bool inferred = false;
};

bool is_drawable(const Vec3& place) {
  return place.allFinite() && place.cwiseAbs().maxCoeff() < farthest_m;
}

std::vector<Bone> bones_of(const PageBody& body) {
  std::vector<Bone> out;
  const auto state = [&body](std::size_t joint) {
    return body.state.empty() ? Tracking::tracked : static_cast<Tracking>(body.state[joint]);
  };
  const auto place = [&body](std::size_t joint) {
    const float* p = &body.positions[3 * joint];
    return Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
  };
  for (std::size_t j = 0; j < body.parents.size(); ++j) {
    if (body.parents[j] < 0) continue;
    const auto p = static_cast<std::size_t>(body.parents[j]);
    const Tracking least = std::min(state(j), state(p));
    if (least == Tracking::missing || !is_drawable(place(j)) || !is_drawable(place(p))) continue;
    out.push_back({place(p), place(j), least == Tracking::inferred});
  }
  return out;
}

/// The horizontal axis along which the ends of the bones are spread most; towards +x, else +z.
Vec3 widest_axis(const std::vector<std::vector<Bone>>& bodies) {
  double n = 0.0, x = 0.0, z = 0.0, xx = 0.0, xz = 0.0, zz = 0.0;
  for (const auto& bones : bodies) {
    for (const Bone& bone : bones) {
      n += 1.0;
      x += bone.to.x();
      z += bone.to.z();
      xx += bone.to.x() * bone.to.x();
      xz += bone.to.x() * bone.to.z();
      zz += bone.to.z() * bone.to.z();
    }
  }
  const double angle =
      0.5 * std::atan2(2.0 * (xz - x * z / n), (xx - x * x / n) - (zz - z * z / n));
  return {std::cos(angle), 0.0, std::sin(angle)};  // within 90 degrees of +x
}

/// From metres to units of the picture.
class Camera {
 public:
  explicit Camera(const std::vector<std::vector<Bone>>& bodies) : axis_(widest_axis(bodies)) {
    for (const auto& bones : bodies) {
      for (const Bone& bone : bones) {
        for (const Vec3& end : {bone.from, bone.to}) {
          left_ = std::min(left_, axis_.dot(end));
          right_ = std::max(right_, axis_.dot(end));
          bottom_ = std::min(bottom_, end.y());
          top_ = std::max(top_, end.y());
        }
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

/// A path of the bones that are inferred, or of those that are not; bones of a pixel are left out.
std::string path_of(const std::vector<Bone>& bones, bool inferred, const Camera& camera) {
  std::string out;
  std::pair<int, int> pen{-1, -1};
  for (const Bone& bone : bones) {
    if (bone.inferred != inferred) continue;
    const auto from = camera.at(bone.from), to = camera.at(bone.to);
    if (std::abs(from.first - to.first) + std::abs(from.second - to.second) < 3) continue;
    if (from != pen) out += fmt::format("M{} {}", from.first, from.second);
    out += fmt::format("L{} {}", to.first, to.second);
    pen = to;
  }
  return out;
}

}  // namespace

std::string skeleton_svg(const std::vector<PageBody>& bodies) {
  std::vector<std::vector<Bone>> bones;
  std::vector<std::string_view> colours;
  for (const PageBody& body : bodies) {
    if (!body.in_take_space) continue;
    std::vector<Bone> one = bones_of(body);
    if (one.empty()) continue;
    bones.push_back(std::move(one));
    colours.push_back(to_string(body.colour));
  }
  if (bones.empty()) return "";
  const Camera camera(bones);
  std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\">", width, height);
  for (std::size_t b = 0; b < bones.size(); ++b) {
    for (const bool inferred : {false, true}) {
      const std::string path = path_of(bones[b], inferred, camera);
      if (path.empty()) continue;
      out += fmt::format("<path class=\"{}{}\" d=\"{}\"/>", colours[b], inferred ? " dashed" : "",
                         path);
    }
  }
  return out + "</svg>";
}

}  // namespace kinalign
