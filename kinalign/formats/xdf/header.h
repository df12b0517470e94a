// SPDX-License-Identifier: Apache-2.0
// Parses the XML that describes a stream of an XDF file. Only elements and their texts matter;
// attributes do not.
#pragma once

#include "kinalign/formats/xdf/xdf.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Fails if the number of channels or their format is missing or unknown. If the header describes
/// another number of channels, `channels` stays empty and a note is added. If the XML has a fault,
/// the elements before it are kept and a note is added. An '&' that begins no entity is read as
/// '&', because some writers do not escape it.
Result<XdfStream> parse_xdf_header(std::uint32_t id, std::string_view xml,
                                   std::vector<Error>& notes);

}  // namespace kinalign
