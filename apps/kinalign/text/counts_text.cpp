// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/counts_text.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

std::string counted(std::uint64_t count, std::string_view one) {
  return counted(count, one, std::string(one) + "s");
}
std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(count), count == 1 ? one : many);
}

std::string size_text(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  // Below 1 MB whole kilobytes are exact enough.
  return size < 1e6 ? fmt::format("{:.0f} kB", 1e-3 * size) : fmt::format("{:.1f} MB", 1e-6 * size);
}

std::string spaced(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

}  // namespace kinalign
