// SPDX-License-Identifier: Apache-2.0
// Bones of constant length, imposed on joints that a method answered with.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

/// The median length of each joint's bone to its parent over T frames, m; 0 for roots. Left and
/// right get their mean.
std::vector<float> typical_lengths(const std::vector<int>& parents,
                                   const std::vector<std::size_t>& partners,
                                   std::span<const float> positions);

/// Moves the joints [T,J,3] as little as brings every bone to its length, frame by frame: sweeps
/// that move both ends of each bone (position-based dynamics), then one pass outward from the
/// roots, after which the lengths are exact.
void impose_lengths(const std::vector<int>& parents, const std::vector<float>& lengths,
                    std::span<float> positions);

}  // namespace kinalign
