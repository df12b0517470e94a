// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/nearest_name.h"

#include <algorithm>
#include <cstddef>

namespace kinalign {

namespace {

/// The number of changes that turn `a` into `b` (optimal string alignment distance). A change
/// inserts, removes or replaces a letter, or swaps two neighbours. No letter is changed twice. Only
/// three rows of the table of distances between prefixes are kept.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), two_before(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_before.swap(before);
    before.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      // `changed`: the last two letters are paired, at no cost if they are equal.
      const std::size_t changed = before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, changed});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return row.back();
}

/// The first few known names as one text: "a, b, c, ...".
std::string first_of(const std::vector<std::string>& known) {
  constexpr std::size_t most = 8;
  std::string list;
  for (std::size_t i = 0; i < known.size() && i < most; ++i) {
    list += (i > 0 ? ", " : "") + shown(known[i]);
  }
  if (known.size() > most) list += ", ...";
  return list;
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  // A name in a file may have any length, so only its beginning is compared.
  constexpr std::size_t longest = 64;
  const std::string_view start = name.substr(0, longest);
  std::string best;
  // A third of the letters may differ, and at least one letter. `least` is one more than that.
  std::size_t least = std::max<std::size_t>(1, start.size() / 3) + 1;
  for (const std::string& other : known) {
    const std::size_t letters = distance(start, other);
    if (letters >= least) continue;
    least = letters;
    best = other;
  }
  // A user may give only the beginning of a long name. It differs from the name in many letters.
  if (!best.empty() || start.size() < 3) return best;
  const auto begun = std::find_if(known.begin(), known.end(), [start](const std::string& other) {
    return other.starts_with(start);
  });
  return begun == known.end() ? "" : *begun;
}

Error unknown_name(std::string_view name, const std::string& what,
                   const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  std::string hint;
  if (!nearest.empty()) {
    hint = " (nearest: " + nearest + ")";
  } else if (!known.empty()) {
    hint = " (known: " + first_of(known) + ")";
  }
  return {"", 0, what + hint, "\"" + shown(name) + "\""};
}

}  // namespace kinalign
