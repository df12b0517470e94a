// SPDX-License-Identifier: Apache-2.0
// The XML that describes a stream of an XDF file. Only the XML that such headers contain is read:
// elements and their text. Attributes, comments and processing instructions are skipped. Only the
// five named entities and characters by number are resolved, so no text can expand. A document type
// is refused.
#pragma once

#include "kinalign/formats/xdf/xdf.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

constexpr std::size_t deepest_xml = 32;

/// Called where an element ends, with the names from the outermost to its own and its own text
/// without the blanks around it.
using XmlVisitor =
    std::function<void(std::span<const std::string_view> path, const std::string& text)>;

/// Fails if elements don't close in order, are nested more than 32 deep, or the text ends within
/// one; the elements before the fault have been visited. A '&' that begins no entity is read as an
/// '&', because some writers don't escape it.
Result<void> walk_xml(std::string_view text, const XmlVisitor& visit);

/// Fails if the number of channels or their format is missing or unknown. If the header describes
/// another number of channels, `channels` is empty and `notes` says so.
Result<XdfStream> parse_xdf_header(std::uint32_t id, std::string_view xml,
                                   std::vector<Error>& notes);

}  // namespace kinalign
