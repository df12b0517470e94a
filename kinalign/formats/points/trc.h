// SPDX-License-Identifier: Apache-2.0
// TRC, tab-separated optical markers. Layout: docs/formats/points.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Units mm, cm or m as the file says; y up unless `up` says z; seconds of the Time column, moved
/// so that the first frame has start_ns where that is given. A marker whose cells are empty or
/// "nan" is missing. A wrong NumFrames is a finding; a blank line behind the rows ends them.
std::unique_ptr<PointReader> make_trc_reader(const StreamOptions& options, std::string_view file);

bool looks_like_trc(std::string_view head);

}  // namespace kinalign
