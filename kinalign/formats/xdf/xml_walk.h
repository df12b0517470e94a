// SPDX-License-Identifier: Apache-2.0
// As much XML as the headers of XDF hold: elements and their text. Attributes, comments and
// processing instructions are passed over, the five named entities and characters by number are
// resolved and no others, so nothing can grow; a document type is refused.
#pragma once

#include "kinalign/core/error.h"

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

/// Fails, after what could be visited, where elements don't close in order, stand more than 32
/// deep, or the text ends within one. A '&' that begins no entity is taken for itself: writers
/// leave it.
Result<void> walk_xml(std::string_view text, const XmlVisitor& visit);

}  // namespace kinalign
