// SPDX-License-Identifier: Apache-2.0
// Biovision BVH, read and written. Layout: docs/formats/bvh.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct BvhOptions {
  double metres_per_unit = 0.01;  // most writers, Axis Neuron among them, use centimetres
  bool z_up = false;              // the file's up axis is z; y otherwise
  Time start{};                   // stamp of frame 0; the file itself knows none
};

/// As a stream's user has it; the click's latency is added to its stamp.
BvhOptions bvh_options(const StreamOptions& options);

/// One channel of a joint: 0..2 position x, y, z; 3..5 rotation about x, y, z.
using Channel = std::uint8_t;

/// What stands above the rows, in the file's own units and words.
struct BvhHierarchy {
  std::vector<std::string> names;              // [J] as written; may repeat
  std::vector<int> parents;                    // [J] -1: a root
  std::vector<Vec3> offsets;                   // [J]
  std::vector<std::vector<Channel>> channels;  // [J] in the order of the row
  std::vector<EndSite> end_sites;
  int offset_decimals = 6;   // digits behind the point of the OFFSETs
  std::uint64_t frames = 0;  // as stated; the rows decide
  std::int64_t frames_line = 0;
  double frame_seconds = 0.0;
  std::string frame_time;  // as written

  std::size_t row_size() const;  // values in a frame, C
};

struct BvhFile {
  BvhHierarchy hierarchy;
  Clip clip;                   // T frames, J joints; repeated names are name#2, name#3, ...
  std::vector<double> values;  // [T,C] as read: the file's units, degrees, beyond +-180 too
  int decimals = 6;            // of the file, for writing
  Findings findings;           // read all the same: "Frames: 900" above 899 rows, ...
};

/// Parses everything up to the rows; `text` must reach to the end of the "Frame Time:" number.
/// Fails where the hierarchy cannot be understood. Sets `rows` to where the first row begins.
Result<BvhHierarchy> parse_bvh_hierarchy(std::string_view text, std::string_view name,
                                         std::size_t& rows, Findings& findings);

/// "HIERARCHY" stands first.
bool looks_like_bvh(std::string_view head);

/// The skeleton in metres; repeated names are told apart by name#2, with a finding.
Skeleton skeleton_of(const BvhHierarchy& hierarchy, const BvhOptions& options,
                     std::string_view name, Findings& findings);

/// Whether a person's skeleton has a person's size and stands: findings that propose
/// metres_per_unit or up where not. Of the rest pose and the first of `rows` [n,C] (none: a file
/// without frames) the row decides what stands. Skeletons of fewer than ten joints are not judged.
Findings judge_size(const BvhHierarchy& hierarchy, const Skeleton& skeleton,
                    std::span<const double> rows, const BvhOptions& options, std::string_view name);

/// Local positions and rotations of rows of channel values [n,C], appended to `out`. Position
/// channels replace the components of OFFSET; angles apply in the order of the channels.
class BvhPoser {
 public:
  BvhPoser(const BvhHierarchy& hierarchy, const BvhOptions& options);
  void append(std::span<const double> values, ClipFrames& out);
  std::uint64_t frames() const { return frames_; }

 private:
  struct Joint;
  void place(const Joint& joint, std::span<const double> values, std::span<double> positions) const;
  void turn(const Joint& joint, std::span<const double> values, std::span<double> rotations) const;

  std::vector<Joint> joints_;
  std::size_t row_size_ = 0;
  BvhOptions options_;
  double frame_ns_ = 0.0;
  std::uint64_t frames_ = 0;

 public:
  ~BvhPoser();
  BvhPoser(BvhPoser&&) noexcept;
  BvhPoser& operator=(BvhPoser&&) noexcept;
  BvhPoser(const BvhPoser&) = delete;
  BvhPoser& operator=(const BvhPoser&) = delete;
};

/// A reader in pieces (reader.h). Values are counted, not lines: a wrong frame count or an
/// incomplete last frame is a finding. But where the first frames stand on a line each, a line
/// that shifts the following frames is an error, not a wrapped row.
std::unique_ptr<ClipReader> make_bvh_reader(const BvhOptions& options, const std::string& name);

/// Reads a whole file. `name` appears in messages only. Memory goes by the values present.
Result<BvhFile> read_bvh(std::string_view text, std::string_view name, const BvhOptions& options);

using TextSink = std::function<Result<void>(std::string_view)>;

/// Writes `values` in the file's decimals: read, write, read gives every channel exactly. A Clip
/// made elsewhere gets its channels from bvh_from_clip first; nothing else computes on angles.
/// Larger than memory: bvh_write.h, bvh_copy.h.
Result<void> write_bvh(const BvhFile& file, const TextSink& sink);

/// A clip made elsewhere with channels (BvhChannels of bvh_write.h).
BvhFile bvh_from_clip(Clip clip, double frame_seconds);

}  // namespace kinalign
