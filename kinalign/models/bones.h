// SPDX-License-Identifier: Apache-2.0
// Moves the joints that a method returns, so that bones have constant lengths.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

/// The median length over T frames of the bone from each joint to its parent, m; 0 for roots. A
/// left bone and its right partner both get the mean of the two medians.
std::vector<float> typical_lengths(const std::vector<int>& parents,
                                   const std::vector<std::size_t>& partners,
                                   std::span<const float> positions);

/// Changes the joints [T,J,3] so that every bone has its length, with small moves. Each frame is
/// processed alone. First, sweeps move both ends of each bone (position-based dynamics). Then one
/// pass from the roots outward makes the lengths exact.
void impose_lengths(const std::vector<int>& parents, const std::vector<float>& lengths,
                    std::span<float> positions);

}  // namespace kinalign
