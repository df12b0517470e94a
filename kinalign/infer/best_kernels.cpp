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

const Kernels& best_kernels() {
#ifdef KINALIGN_V3_KERNELS
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return v3::kernels;
#endif
  return baseline::kernels;
}

}  // namespace kinalign
