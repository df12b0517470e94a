// SPDX-License-Identifier: Apache-2.0
// Seeds for rules that are tested on random cases. They are new in every run and are printed when a
// case fails. KINALIGN_SEED=number runs that seed alone.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

namespace kinalign {

inline std::vector<std::uint64_t> fresh_seeds(std::size_t n) {
  if (const char* given = std::getenv("KINALIGN_SEED")) return {std::strtoull(given, nullptr, 10)};
  std::random_device device;
  std::vector<std::uint64_t> seeds(n);
  for (auto& seed : seeds) seed = (std::uint64_t{device()} << 32) ^ device();
  return seeds;
}

}  // namespace kinalign
