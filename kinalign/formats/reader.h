// SPDX-License-Identifier: Apache-2.0
// The interface of all readers of formats. A reader takes a file in pieces, which may be cut
// anywhere, and returns rows.
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

/// One pass over one file. The memory depends on the bytes that arrive, never on numbers in the
/// file. Rows are in kinalign's units and axes: metres, radians, m/s2, right-handed, y up. Stamps
/// are within +-4e18 ns, so that differences can't overflow.
template <class HeaderType, class FramesType>
class Reader {
 public:
  using Header = HeaderType;
  using Frames = FramesType;

  virtual ~Reader() = default;

  /// Takes the next piece, and appends the rows that it completes to `out`. After a failure the
  /// reader must not be used again.
  virtual Result<void> feed(std::string_view piece, Frames& out) = 0;

  /// Call this at the end of the file. It appends the remaining rows. Fails if the file ends within
  /// its header.
  virtual Result<void> finish(Frames& out) = 0;

  /// The header of the rows; nullptr until it was read.
  virtual const Header* header() const = 0;

  /// True if the stamps come from a rate, because the file has no time column or its time never
  /// changes. The value is valid after finish().
  bool counted = false;

  /// Faults that did not stop the reading; complete after finish(). A repeated fault is one finding
  /// with a count.
  Findings findings;
};

using ClipReader = Reader<Skeleton, ClipFrames>;
using PointReader = Reader<PointHeader, PointFrames>;
using ImuReader = Reader<ImuHeader, ImuSamples>;

using AnyReader = std::variant<std::unique_ptr<ClipReader>, std::unique_ptr<PointReader>,
                               std::unique_ptr<ImuReader>>;

}  // namespace kinalign
