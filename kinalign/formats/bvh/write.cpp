// SPDX-License-Identifier: Apache-2.0
// Writes channel values as text, converts a clip to channel values, and copies a file.
#include "kinalign/core/file_version.h"
#include "kinalign/core/numbers.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/bvh/rows.h"
#include "kinalign/formats/unknown_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr std::array<std::string_view, 6> channel_words{"Xposition", "Yposition", "Zposition",
                                                        "Xrotation", "Yrotation", "Zrotation"};

void put_offset(std::string& text, const std::string& indent, const Vec3& offset, int decimals) {
  text += indent + "OFFSET";
  for (int i = 0; i < 3; ++i) {
    text += ' ' + number_text(offset[i], std::min(decimals, 15));
  }
  text += '\n';
}

/// Writes the hierarchy as text. It uses no recursion, because a chain of joints may be long.
class HierarchyText {
 public:
  explicit HierarchyText(const BvhHierarchy& h) : h_(h) {}

  std::string text() {
    text_ = "HIERARCHY\n";
    for (std::size_t j = 0; j < h_.names.size(); ++j) {
      // Joints are in nested order. Closing all braces down to the parent closes the joints in
      // between.
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

  /// Closes the braces of all open joints below `parent`. End sites are written at the end of their
  /// joint.
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

constexpr double centimetres = 100.0;

/// The angles a, b, c in degrees for which rotation = Rz(a) Rx(b) Ry(c).
std::array<double, 3> zxy_angles(const Quat& rotation) {
  const Eigen::Matrix3d r = rotation.normalized().toRotationMatrix();
  constexpr double degrees = 180.0 / std::numbers::pi;
  // Rounding errors may put the sine slightly out of its range.
  const double sin_x = std::clamp(r(2, 1), -1.0, 1.0);
  if (std::abs(sin_x) > 1.0 - 1e-12) {  // z and y rotate about the same axis, so z gets both angles
    return {std::atan2(r(1, 0), r(0, 0)) * degrees, std::asin(sin_x) * degrees, 0.0};
  }
  // The elements of R = Rz(a) Rx(b) Ry(c) are solved for the angles.
  return {std::atan2(-r(0, 1), r(1, 1)) * degrees, std::asin(sin_x) * degrees,
          std::atan2(-r(2, 0), r(2, 2)) * degrees};
}

/// An order of joints in which all descendants of a joint directly follow the joint. Siblings keep
/// their order.
std::vector<std::size_t> nested_order(const std::vector<int>& parents) {
  std::vector<std::vector<std::size_t>> children(parents.size() + 1);  // last element: the roots
  // The loop runs backwards, so that the stack below takes the first child first.
  for (std::size_t j = parents.size(); j-- > 0;) {
    children[parents[j] < 0 ? parents.size() : static_cast<std::size_t>(parents[j])].push_back(j);
  }
  std::vector<std::size_t> order;
  std::vector<std::size_t> open = children.back();  // a stack: the last element is the next joint
  while (!open.empty()) {
    order.push_back(open.back());
    open.pop_back();
    const auto& below = children[order.back()];
    open.insert(open.end(), below.begin(), below.end());
  }
  return order;
}

/// The data for one pass over the file, and the texts of its progress reports.
struct CopyPass {
  FileSystem& files;
  const std::string& path;
  const Progress& progress;
  std::string_view what;
};

/// Passes a whole file to `values`, and calls `use()` after each piece. Both passes of copy_bvh()
/// call this function: the first one counts, and the second one writes.
template <class Use>
Result<Findings> feed_file(const CopyPass& pass, BvhValues& values, Use&& use) {
  const std::string& path = pass.path;
  InputFile file = KA_TRY(InputFile::open(pass.files, path));
  Findings findings;
  bool first = true;
  std::uint64_t bytes = 0;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    // The first piece shows whether the file is a BVH file.
    if (std::exchange(first, false) && !looks_like_bvh(piece)) {
      return Failure(
          Error{path, 1, "a BVH or a take (other files can't become a BVH)", beginning_of(piece)});
    }
    if (piece.empty()) break;
    KA_TRY(values.feed(piece, findings));
    KA_TRY(use());
    bytes += piece.size();
    if (!go_on(pass.progress, pass.what, bytes, file.size())) return Failure(interruption(path));
  }
  KA_TRY(values.finish(findings));
  // The last frame may become complete only at the end of the file.
  KA_TRY(use());
  return findings;
}

}  // namespace

BvhWriter::BvhWriter(const BvhHierarchy& hierarchy, std::uint64_t frames, int decimals,
                     FileSink sink)
    : sink_(std::move(sink)),
      row_size_(hierarchy.row_size()),
      decimals_(std::min(decimals, 15)),
      frames_(frames),
      text_(HierarchyText(hierarchy).text() +
            fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", frames, hierarchy.frame_time)) {}

Result<void> BvhWriter::append(std::span<const double> values) {
  constexpr std::size_t piece = std::size_t{256} << 10;
  std::array<char, number_room> room{};
  // Rows are written completely. The sink receives large pieces, because each call may be a system
  // call.
  for (std::size_t i = 0; i + row_size_ <= values.size() && row_size_ > 0; i += row_size_) {
    for (std::size_t c = 0; c < row_size_; ++c) {
      if (c > 0) text_ += ' ';
      text_.append(room.data(), put_number(room.data(), values[i + c], decimals_));
    }
    text_ += '\n';
    ++written_;
    if (text_.size() < piece) continue;
    KA_TRY(sink_(text_));
    text_.clear();
  }
  return {};
}

Result<void> BvhWriter::finish() {
  // The head already contains the number of frames, so another number would make the file wrong.
  if (written_ == frames_) return sink_(text_);
  return refuse(fmt::format("{} frames to write", frames_), std::to_string(written_));
}

Result<void> write_bvh(const BvhFile& file, const FileSink& sink) {
  const std::size_t row_size = file.hierarchy.row_size();
  BvhWriter writer(file.hierarchy, row_size == 0 ? 0 : file.values.size() / row_size, file.decimals,
                   sink);
  KA_TRY(writer.append(file.values));
  return writer.finish();
}

BvhChannels::BvhChannels(const Skeleton& skeleton, Positions positions)
    : skeleton_(skeleton),
      order_(nested_order(skeleton.parents)),
      moves_(skeleton.joints(), positions == Positions::of_all) {}

void BvhChannels::see(std::span<const double> local_positions) {
  const std::size_t joints = skeleton_.joints();
  for (std::size_t i = 0; 3 * i < local_positions.size(); ++i) {
    const std::size_t j = i % joints;
    if (moves_[j]) continue;
    // Smaller movements are rounding errors.
    moves_[j] = (Vec3(vec3(local_positions, i)) - skeleton_.rest_offsets[j]).norm() > 1e-6;
  }
}

BvhHierarchy BvhChannels::hierarchy(std::uint64_t frames, double frame_seconds) const {
  BvhHierarchy h;
  std::vector<int> place(skeleton_.joints());  // position of each joint in the order of the file
  for (const std::size_t j : order_) {
    const int parent = skeleton_.parents[j];
    place[j] = static_cast<int>(h.names.size());
    h.names.push_back(skeleton_.joint_names[j]);
    h.parents.push_back(parent < 0 ? -1 : place[static_cast<std::size_t>(parent)]);
    h.offsets.emplace_back(skeleton_.rest_offsets[j] * centimetres);
    // Position X, Y, Z, then rotations Z, X, Y, as in the files of motion suits.
    h.channels.push_back(has_position(j) ? std::vector<Channel>{0, 1, 2, 5, 3, 4}
                                         : std::vector<Channel>{5, 3, 4});
  }
  for (const EndSite& site : skeleton_.end_sites) {
    h.end_sites.push_back(
        {place[static_cast<std::size_t>(site.parent)], site.offset * centimetres});
  }
  h.frames = frames;
  h.frame_seconds = frame_seconds;
  h.frame_time = number_text(frame_seconds, 7);
  return h;
}

void BvhChannels::append(std::span<const double> local_positions,
                         std::span<const double> local_rotations,
                         std::vector<double>& values) const {
  // The values are rounded to the file's six decimals, so that the text contains exactly these
  // values.
  const auto keep = [&values](double value) {
    values.push_back(std::nearbyint(value * 1e6) / 1e6);
  };
  const std::size_t joints = skeleton_.joints();
  for (std::size_t row = 0; 4 * row < local_rotations.size(); row += joints) {
    for (const std::size_t j : order_) {
      if (has_position(j)) {
        const Vec3 at = vec3(local_positions, row + j);
        for (int k = 0; k < 3; ++k) keep(at[k] * centimetres);
      }
      for (const double angle : zxy_angles(quat(local_rotations, row + j))) keep(angle);
    }
  }
}

BvhFile bvh_from_clip(Clip clip, double frame_seconds) {
  BvhFile file;
  BvhChannels channels(clip.skeleton);
  channels.see(clip.frames.local_positions);
  file.hierarchy = channels.hierarchy(clip.frames.size(), frame_seconds);
  channels.append(clip.frames.local_positions, clip.frames.local_rotations, file.values);
  file.clip = std::move(clip);
  return file;
}

Result<Findings> copy_bvh(FileSystem& files, const std::string& from, const FileSink& sink,
                          const Progress& progress) {
  // If the file changed between the passes, its number of frames could be wrong.
  const auto version = version_of(from);
  BvhValues counted(from);
  counted.count_decimals = true;
  Findings findings =
      KA_TRY(feed_file({files, from, progress, "reading"}, counted, [&]() -> Result<void> {
        counted.drop_frames();
        return {};
      }));
  BvhWriter writer(counted.hierarchy(), counted.frames_read(), counted.decimals(), sink);
  BvhValues values(from);
  KA_TRY(feed_file({files, from, progress, "writing"}, values, [&]() -> Result<void> {
    KA_TRY(writer.append(values.frames()));
    values.drop_frames();
    return {};
  }));
  KA_TRY(unchanged(from, version));
  KA_TRY(writer.finish());
  return findings;
}

}  // namespace kinalign
