// SPDX-License-Identifier: Apache-2.0
// The content of a Samples chunk of XDF.
#pragma once

#include "kinalign/formats/xdf/xdf.h"

namespace kinalign {

/// The whole samples that stand in `content`, which begins with their number; `last_stamp` is the
/// stream's, from which stamps are deduced. `what_is_wrong` is set where the samples are not as
/// many as stated or something stands behind them.
XdfSamples parse_xdf_samples(const XdfStream& stream, std::span<const std::uint8_t> content,
                             double& last_stamp, std::optional<Error>& what_is_wrong);

}  // namespace kinalign
