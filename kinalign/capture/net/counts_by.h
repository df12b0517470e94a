// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace kinalign {

/// One counter for each value of an enumeration.
template <class Cause, std::size_t causes>
class CountsBy {
 public:
  std::uint64_t& operator[](Cause cause) { return of_[static_cast<std::size_t>(cause)]; }
  std::uint64_t operator[](Cause cause) const { return of_[static_cast<std::size_t>(cause)]; }
  std::uint64_t total() const { return std::accumulate(of_.begin(), of_.end(), std::uint64_t{0}); }

 private:
  std::array<std::uint64_t, causes> of_{};
};

}  // namespace kinalign
