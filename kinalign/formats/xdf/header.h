// SPDX-License-Identifier: Apache-2.0
// The XML that describes a stream of an XDF file.
#pragma once

#include "kinalign/formats/xdf/xdf.h"

namespace kinalign {

/// Fails where the number of channels or their format is not to be had. `channels` are left empty
/// where not as many are described as there are, and `notes` says so.
Result<XdfStream> parse_xdf_header(std::uint32_t id, std::string_view xml,
                                   std::vector<Error>& notes);

}  // namespace kinalign
