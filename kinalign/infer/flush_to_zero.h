// SPDX-License-Identifier: Apache-2.0
// Subnormal numbers (below 1e-38) make a processor a hundred times slower. A network that decays to
// rest produces many of them.
#pragma once

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace kinalign {

/// While an object of this class exists, the processor treats subnormal numbers in this thread as
/// 0. The class does nothing on processors other than x86.
class FlushToZero {
 public:
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;
#ifdef __SSE__
  FlushToZero() { _mm_setcsr(before_ | 0x8040U); }  // FTZ for results, DAZ for operands
  ~FlushToZero() { _mm_setcsr(before_); }

 private:
  unsigned before_ = _mm_getcsr();
#else
  FlushToZero() = default;
  ~FlushToZero() = default;
#endif
};

}  // namespace kinalign
