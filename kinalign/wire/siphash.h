// SPDX-License-Identifier: Apache-2.0
// SipHash-2-4 with 64 bits: J.-P. Aumasson, D. J. Bernstein, "SipHash: a fast short-input PRF",
// INDOCRYPT 2012. Without the key its results look random and cannot be predicted. It serves as the
// MAC (message authentication code) of the node's datagrams. It is also the hash of tables whose
// keys are chosen by unknown senders.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace kinalign {

using SipHashKey = std::array<std::uint8_t, 16>;

/// The hash as a number. The reference implementation writes its lowest byte first.
std::uint64_t siphash_2_4(const SipHashKey& key, std::span<const std::uint8_t> bytes);

}  // namespace kinalign
