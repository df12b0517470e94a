// SPDX-License-Identifier: Apache-2.0
// Parses the XML that describes a stream of an XDF file. Only the XML of such headers is supported:
// elements and their text. Attributes, comments and processing instructions are skipped. Only the
// five named entities and numbered characters are resolved, so no text can expand. A document type
// is refused.
#pragma once

#include "kinalign/formats/xdf/xdf.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

constexpr std::size_t deepest_xml = 32;

/// Called at the end of each element. `path`: names from the outermost element to this one. `text`:
/// the element's own text, without blanks around it.
using XmlVisitor =
    std::function<void(std::span<const std::string_view> path, const std::string& text)>;

/// Fails if elements don't close in order, are nested more than 32 deep, or if the text ends within
/// one. The elements before the fault have been visited. An '&' that begins no entity is read as
/// '&', because some writers don't escape it.
Result<void> walk_xml(std::string_view text, const XmlVisitor& visit);

/// Fails if the number of channels or their format is missing or unknown. If the header describes
/// another number of channels, `channels` is empty and `notes` gets a note.
Result<XdfStream> parse_xdf_header(std::uint32_t id, std::string_view xml,
                                   std::vector<Error>& notes);

}  // namespace kinalign
