// SPDX-License-Identifier: Apache-2.0
// Numbers below 1e-38 cost a processor a hundred times the time of others. A network that decays to
// rest meets many of them.
#pragma once

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace kinalign {

/// While an object of this class lives, the processor of this thread takes such numbers for 0. The
/// class does nothing on processors other than x86.
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
