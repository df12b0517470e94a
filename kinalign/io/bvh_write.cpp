// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/numbers.h"
#include "kinalign/io/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr std::array<std::string_view, 6> channel_words{"Xposition", "Yposition", "Zposition",
                                                        "Xrotation", "Yrotation", "Zrotation"};

void put(std::string& text, double value, int decimals) {
  std::array<char, number_room> room{};
  const char* end = put_number(room.data(), value, std::min(decimals, 15));
  text.append(room.data(), static_cast<std::size_t>(end - room.data()));
}

void put_offset(std::string& text, const std::string& indent, const Vec3& offset, int decimals) {
  text += indent + "OFFSET";
  for (int i = 0; i < 3; ++i) {
    text += ' ';
    put(text, offset[i], decimals);
  }
  text += '\n';
}

/// Joint `first` and all below it, without recursion: a chain may be deep.
class HierarchyText {
 public:
  explicit HierarchyText(const BvhHierarchy& h) : h_(h) {}

  std::string text() {
    text_ = "HIERARCHY\n";
    for (std::size_t j = 0; j < h_.names.size(); ++j) {
      close_down_to(h_.parents[j]);
      open(j);
    }
    close_down_to(-1);
    return std::move(text_);
  }

 private:
  std::string indent() const { return std::string(open_.size(), '\t'); }

  void open(std::size_t j) {
    text_ += indent() + (h_.parents[j] < 0 ? "ROOT " : "JOINT ") + h_.names[j] + "\n";
    text_ += indent() + "{\n";
    open_.push_back(static_cast<int>(j));
    put_offset(text_, indent(), h_.offsets[j], h_.offset_decimals);
    if (h_.channels[j].empty()) return;
    text_ += indent() + fmt::format("CHANNELS {}", h_.channels[j].size());
    for (const Channel channel : h_.channels[j])
      text_ += fmt::format(" {}", channel_words[channel]);
    text_ += '\n';
  }

  void close_down_to(int parent) {
    while (!open_.empty() && open_.back() != parent) {
      for (const EndSite& site : h_.end_sites) {
        if (site.parent != open_.back()) continue;
        text_ += indent() + "End Site\n" + indent() + "{\n";
        put_offset(text_, indent() + "\t", site.offset, h_.offset_decimals);
        text_ += indent() + "}\n";
      }
      open_.pop_back();
      text_ += indent() + "}\n";
    }
  }

  const BvhHierarchy& h_;
  std::string text_;
  std::vector<int> open_;
};

/// Angles a, b, c in degrees with rotation = Rz(a) Rx(b) Ry(c).
std::array<double, 3> zxy_angles(const Quat& rotation) {
  const Eigen::Matrix3d r = rotation.normalized().toRotationMatrix();
  constexpr double degrees = 180.0 / std::numbers::pi;
  const double sin_x = std::clamp(r(2, 1), -1.0, 1.0);
  if (std::abs(sin_x) > 1.0 - 1e-12) {  // both other turns are about one axis: give it to z
    return {std::atan2(r(1, 0), r(0, 0)) * degrees, std::asin(sin_x) * degrees, 0.0};
  }
  return {std::atan2(-r(0, 1), r(1, 1)) * degrees, std::asin(sin_x) * degrees,
          std::atan2(-r(2, 0), r(2, 2)) * degrees};
}

constexpr double centimetres = 100.0;

/// Whether a joint leaves its rest offset by more than a micrometre.
bool moves(const Clip& clip, std::size_t j) {
  const std::size_t joints = clip.skeleton.joints();
  for (std::size_t t = 0; t < clip.frames.size(); ++t) {
    const Vec3 at = vec3(std::span(clip.frames.local_positions), t * joints + j);
    if ((at - clip.skeleton.rest_offsets[j]).norm() > 1e-6) return true;
  }
  return false;
}

BvhHierarchy hierarchy_of(const Clip& clip, double frame_seconds) {
  BvhHierarchy h;
  h.names = clip.skeleton.joint_names;
  h.parents = clip.skeleton.parents;
  for (std::size_t j = 0; j < h.names.size(); ++j) {
    h.offsets.emplace_back(clip.skeleton.rest_offsets[j] * centimetres);
    const bool positions = h.parents[j] < 0 || moves(clip, j);
    h.channels.push_back(positions ? std::vector<Channel>{0, 1, 2, 5, 3, 4}
                                   : std::vector<Channel>{5, 3, 4});
  }
  for (EndSite site : clip.skeleton.end_sites) {
    site.offset *= centimetres;
    h.end_sites.push_back(site);
  }
  h.frames = clip.frames.size();
  h.frame_seconds = frame_seconds;
  put(h.frame_time, frame_seconds, 7);
  return h;
}

}  // namespace

Result<void> write_bvh(const BvhFile& file, const TextSink& sink) {
  constexpr std::size_t piece = std::size_t{256} << 10;
  const std::size_t row_size = file.hierarchy.row_size();
  const std::size_t frames = row_size == 0 ? 0 : file.values.size() / row_size;
  std::string text = HierarchyText(file.hierarchy).text();
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", frames, file.hierarchy.frame_time);
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t c = 0; c < row_size; ++c) {
      if (c > 0) text += ' ';
      put(text, file.values[t * row_size + c], file.decimals);
    }
    text += '\n';
    if (text.size() < piece) continue;
    KA_TRY(sink(text));
    text.clear();
  }
  return sink(text);
}

BvhFile bvh_from_clip(Clip clip, double frame_seconds) {
  BvhFile file;
  file.hierarchy = hierarchy_of(clip, frame_seconds);
  const std::size_t joints = clip.skeleton.joints();
  // Rounded to the written decimals, so that the text holds exactly these values.
  const auto keep = [&file](double value) {
    file.values.push_back(std::nearbyint(value * 1e6) / 1e6);
  };
  for (std::size_t i = 0; i < clip.frames.size() * joints; ++i) {
    if (file.hierarchy.channels[i % joints].size() == 6) {
      const Vec3 at = vec3(std::span<const double>(clip.frames.local_positions), i);
      for (int k = 0; k < 3; ++k) keep(at[k] * centimetres);
    }
    for (const double angle : zxy_angles(quat(clip.frames.local_rotations, i))) keep(angle);
  }
  file.clip = std::move(clip);
  return file;
}

}  // namespace kinalign
