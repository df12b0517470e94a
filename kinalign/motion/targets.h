// SPDX-License-Identifier: Apache-2.0
// Builds a hot loop for several processors; the version is chosen when the program starts. Fused
// multiply-add is off (cmake/kinalign_room.cmake), so that all versions of a loop give the same
// bits.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(KINALIGN_SANITIZED)
#define KA_EVERY_PROCESSOR __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define KA_EVERY_PROCESSOR
#endif

/// Marks functions that such loops call. Inlined, they are built for the same processor as the
/// loop.
#define KA_INLINE inline __attribute__((always_inline))
