// SPDX-License-Identifier: Apache-2.0
// A hot loop built for several processors, chosen when the program starts. Fused multiply-add stays
// off (cmake/kinalign_room.cmake), so that all builds of a loop give the same bits.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(KINALIGN_SANITIZED)
#define KA_EVERY_PROCESSOR __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define KA_EVERY_PROCESSOR
#endif

/// A part of such loops: it must become part of the loop to be built for its processor.
#define KA_INLINE inline __attribute__((always_inline))
