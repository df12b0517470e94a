// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/steady_memory.h"

#include <malloc.h>

#include <cstring>
#include <memory>

namespace kinalign {

// mallopt(3). With one arena, memory that one thread frees serves the others, too.
void keep_memory(std::size_t bytes) {
  constexpr int largest_mapped = 32 << 20;  // the largest value glibc accepts; smaller blocks come
                                            // from the heap
  mallopt(M_ARENA_MAX, 1);
  // Setting a threshold by hand also switches off glibc's own adjustment of it.
  mallopt(M_MMAP_THRESHOLD, largest_mapped);
  // Freed memory below this size is not given back to the system.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  // The block is freed at the end of this function. Its pages stay in the heap.
  const std::unique_ptr<void, decltype(&std::free)> room(std::malloc(bytes), &std::free);
  if (room == nullptr) return;
  std::memset(room.get(), 1, bytes);
  // Without this the compiler may remove the memset, whose result is never read.
  asm volatile("" : : "r"(room.get()) : "memory");
}

}  // namespace kinalign
