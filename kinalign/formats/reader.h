// SPDX-License-Identifier: Apache-2.0
// What every format's reader is: fed a file in pieces cut anywhere, it yields rows.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

struct PointHeader {
  std::vector<std::string> joint_names;
};

struct ImuHeader {
  std::vector<std::string> node_names;
  ImuContent content;
};

/// One pass over one file. Memory goes by what was fed, never by numbers that the file states.
/// Rows come out in our units and axes: metres, radians, m/s2, right-handed, y up; stamps inside
/// +-4e18 ns, so that differences can't overflow.
template <class HeaderType, class FramesType>
class Reader {
 public:
  using Header = HeaderType;
  using Frames = FramesType;

  virtual ~Reader() = default;

  /// Takes the next piece and appends the rows that it completes to `out`. After a failure the
  /// reader may not be used again.
  virtual Result<void> feed(std::string_view piece, Frames& out) = 0;

  /// The file has ended: appends what is left. Fails where the file stops in its head.
  virtual Result<void> finish(Frames& out) = 0;

  /// What the file says of itself before its first row; nullptr until that has been read.
  virtual const Header* header() const = 0;

  /// Stamps are counted by a rate, for want of any that move; known after finish().
  bool counted = false;

  /// What was wrong and could be read all the same; complete after finish(). A fault that repeats
  /// is one finding with a count.
  Findings findings;
};

using ClipReader = Reader<Skeleton, ClipFrames>;
using PointReader = Reader<PointHeader, PointFrames>;
using ImuReader = Reader<ImuHeader, ImuSamples>;

using AnyReader = std::variant<std::unique_ptr<ClipReader>, std::unique_ptr<PointReader>,
                               std::unique_ptr<ImuReader>>;

}  // namespace kinalign
