// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/kernels.h"

namespace kinalign {

namespace baseline {
extern const Kernels kernels;
}
namespace v3 {
extern const Kernels kernels;
}

const Kernels& baseline_kernels() { return baseline::kernels; }

// The processor is asked at run time: one program runs on every x86-64 and uses AVX2 where it can.
// Other processors have only the baseline build.
const Kernels& best_kernels() {
#ifdef KINALIGN_V3_KERNELS
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return v3::kernels;
#endif
  return baseline::kernels;
}

}  // namespace kinalign
