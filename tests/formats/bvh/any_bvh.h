// SPDX-License-Identifier: Apache-2.0
// BVH files of random skeletons, written in all the ways that real writers use, and their meaning
// by an independent plain computation.
#pragma once

#include "kinalign/formats/bvh/bvh.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace kinalign {

struct AnyBvh {
  BvhHierarchy hierarchy;
  std::vector<double> values;  // [T,C]
  std::size_t frames = 0;
  std::string text;  // the file's text, made of the fields above
};

namespace any_bvh {

inline std::string number(double value, int decimals) {
  std::array<char, 64> room{};
  const int size = std::snprintf(room.data(), room.size(), "%.*f", decimals, value);
  return {room.data(), static_cast<std::size_t>(size)};
}

/// A random number with `decimals` digits after the point, exactly as it will be read.
inline double any_number(double most, int decimals, std::mt19937_64& random) {
  std::uniform_real_distribution<double> range(-most, most);
  return std::strtod(number(range(random), decimals).c_str(), nullptr);
}

/// Two to nine joints, too few to be judged as a person. Each has random channels in random order,
/// the first joint at least one.
inline BvhHierarchy any_hierarchy(std::mt19937_64& random) {
  BvhHierarchy out;
  std::vector<int> open;  // the innermost joints, to which a next joint may be attached
  const std::size_t joints = 2 + random() % 8;
  for (std::size_t j = 0; j < joints; ++j) {
    while (!open.empty() && random() % 3 == 0) open.pop_back();
    out.names.push_back((random() % 2 == 0 ? "joint:" : "a joint ") + std::to_string(j));
    out.parents.push_back(open.empty() ? -1 : open.back());
    open.push_back(static_cast<int>(j));
    const auto part = [&] { return any_number(40, 3, random); };
    out.offsets.emplace_back(part(), part(), part());
    std::vector<Channel> channels{0, 1, 2, 3, 4, 5};
    std::shuffle(channels.begin(), channels.end(), random);
    channels.resize(j == 0 ? 1 + random() % 6 : random() % 7);
    out.channels.push_back(channels);
    if (random() % 3 == 0) {
      out.end_sites.push_back({static_cast<int>(j), Vec3(part(), part(), part())});
    }
  }
  out.offset_decimals = 3;
  out.frame_seconds = 0.0083333;
  out.frame_time = "0.0083333";
  return out;
}

/// A word in the letter case that some writer uses.
inline std::string any_case(std::string word, std::mt19937_64& random) {
  if (random() % 4 != 0) return word;
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

class Writer {
 public:
  Writer(const AnyBvh& bvh, std::mt19937_64& random)
      : bvh_(bvh), random_(random), line_end_(random() % 2 == 0 ? "\n" : "\r\n") {}

  std::string text(int decimals) {
    text_ = any_case("HIERARCHY", random_) + line_end_;
    for (std::size_t j = 0; j < bvh_.hierarchy.names.size(); ++j) {
      close_down_to(bvh_.hierarchy.parents[j]);
      open(j);
    }
    close_down_to(-1);
    text_ += any_case("MOTION", random_) + line_end_ + any_case("Frames:", random_) + blank() +
             std::to_string(bvh_.frames) + line_end_ + any_case("Frame", random_) + blank() +
             any_case("Time:", random_) + blank() + bvh_.hierarchy.frame_time + line_end_;
    rows(decimals);
    return std::move(text_);
  }

 private:
  std::string blank() { return random_() % 3 == 0 ? " \t" : " "; }

  void offset(const Vec3& at) {
    text_ += any_case("OFFSET", random_);
    for (int k = 0; k < 3; ++k) text_ += blank() + number(at[k], bvh_.hierarchy.offset_decimals);
    text_ += line_end_;
  }

  void open(std::size_t j) {
    constexpr std::array<const char*, 6> words{"Xposition", "Yposition", "Zposition",
                                               "Xrotation", "Yrotation", "Zrotation"};
    const BvhHierarchy& h = bvh_.hierarchy;
    text_ += any_case(h.parents[j] < 0 ? "ROOT" : "JOINT", random_) + blank() + h.names[j];
    text_ += (random_() % 4 == 0 ? " " : line_end_) + "{" + line_end_;
    open_.push_back(static_cast<int>(j));
    offset(h.offsets[j]);
    if (h.channels[j].empty() && random_() % 2 == 0) return;
    text_ += any_case("CHANNELS", random_) + blank() + std::to_string(h.channels[j].size());
    for (const Channel channel : h.channels[j]) {
      text_ += blank() + any_case(words.at(channel), random_);
    }
    text_ += line_end_;
  }

  void close_down_to(int parent) {
    while (!open_.empty() && open_.back() != parent) {
      for (const EndSite& site : bvh_.hierarchy.end_sites) {
        if (site.parent != open_.back()) continue;
        text_ += any_case("End", random_) + " Site" + line_end_ + "{" + line_end_;
        offset(site.offset);
        text_ += "}" + line_end_;
      }
      open_.pop_back();
      text_ += "}" + line_end_;
    }
  }

  /// Writes one frame a line, or a few values a line.
  void rows(int decimals) {
    const std::size_t size = bvh_.hierarchy.row_size();
    const std::size_t wrapped = random_() % 2 == 0 || size == 1 ? size : 1 + random_() % (size - 1);
    for (std::size_t i = 0; i < bvh_.values.size(); ++i) {
      text_ += number(bvh_.values[i], decimals);
      const bool last = (i + 1) % wrapped == 0 || i + 1 == bvh_.values.size();
      text_ += last ? line_end_ : blank();
    }
  }

  const AnyBvh& bvh_;
  std::mt19937_64& random_;
  std::string line_end_, text_;
  std::vector<int> open_;
};

}  // namespace any_bvh

inline AnyBvh make_any_bvh(std::mt19937_64& random) {
  AnyBvh out;
  out.hierarchy = any_bvh::any_hierarchy(random);
  out.frames = random() % 6;
  out.hierarchy.frames = out.frames;
  const int decimals = static_cast<int>(random() % 8);
  for (std::size_t i = out.frames * out.hierarchy.row_size(); i > 0; --i) {
    out.values.push_back(any_bvh::any_number(400, decimals, random));
  }
  out.text = any_bvh::Writer(out, random).text(decimals);
  return out;
}

/// Positions of all joints in frame `t`, m, [J]: computed with one matrix for each joint.
inline std::vector<Vec3> places_of(const AnyBvh& bvh, std::size_t t) {
  const BvhHierarchy& h = bvh.hierarchy;
  std::vector<Vec3> places;
  std::vector<Eigen::Matrix3d> turns;
  std::size_t at = t * h.row_size();
  for (std::size_t j = 0; j < h.names.size(); ++j) {
    Vec3 place = h.offsets[j];
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (const Channel channel : h.channels[j]) {
      const double value = bvh.values[at++];
      if (channel < 3) {
        place[channel] = value;
        continue;
      }
      const double a = value * std::numbers::pi / 180.0;
      const int x = (channel - 3 + 1) % 3, y = (channel - 3 + 2) % 3;
      Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
      one(x, x) = one(y, y) = std::cos(a);
      one(y, x) = std::sin(a);
      one(x, y) = -std::sin(a);
      turn = (turn * one).eval();
    }
    place *= 0.01;
    if (h.parents[j] >= 0) {
      const auto p = static_cast<std::size_t>(h.parents[j]);
      place = (places[p] + turns[p] * place).eval();
      turn = (turns[p] * turn).eval();
    }
    places.push_back(place);
    turns.push_back(turn);
  }
  return places;
}

}  // namespace kinalign
