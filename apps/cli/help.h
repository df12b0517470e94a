// SPDX-License-Identifier: Apache-2.0
// The help of the program: help pages, man page and completion scripts. All three are made from the
// verbs' descriptions, so they always agree.
#pragma once

#include "apps/cli/verb.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Breaks `text` into lines of at most `width` characters. Every line but the first is indented to
/// column `indent`.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 80);

/// The version, such as "0.1.0".
std::string program_version();

/// The list of verbs. A group of verbs takes one line.
std::string overview(const std::vector<Verb>& verbs);
/// The list of verbs in one group, such as "dataset".
std::string group_page(const std::string& group, const std::vector<Verb>& verbs);

/// The help page of one verb. The first line is an example that works.
std::string help_page(const Page& page, const Usage& usage);

/// The man page kinalign(1) in roff.
std::string man_page(const std::vector<Verb>& verbs);

/// A completion script for `shell`: bash, zsh or fish.
std::string completion_script(const std::string& shell, const std::vector<Verb>& verbs);

/// The usage line of a help page: `kinalign align FILE [FLAGS]`.
std::string usage_line(const Page& page, const Usage& usage);

/// A flag as a page lists it: "-o, --out TEXT", and its meaning with the default value.
struct FlagText {
  std::string flag, meaning;
};
FlagText flag_text(const Field& field);

}  // namespace kinalign
