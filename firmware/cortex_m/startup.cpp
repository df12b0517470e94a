// SPDX-License-Identifier: Apache-2.0
// From reset to main, with the names of lm3s6965.ld. ARMv7-M Architecture Reference Manual, B1.5:
// the vectors begin with the stack's end and the address of reset; then the faults.
#include "firmware/cortex_m/stack.h"

#include <algorithm>
#include <array>
#include <cstdlib>

int main();

extern "C" {
extern std::uint32_t data_in_code[], data_begin[], data_end[], bss_begin[], bss_end[];
extern std::uint32_t stack_begin[], stack_end[];
using Initializer = void (*)();
extern Initializer init_array_begin[], init_array_end[];

// Stops here for good after a fault. A program that waits for an answer runs into its own time
// limit.
[[noreturn]] void stop() {
  for (;;) asm volatile("wfi");
}

// Functions that the compiler may call, and that nothing here needs.
[[noreturn]] void abort() { stop(); }
[[noreturn]] void __cxa_pure_virtual() { stop(); }
}

namespace {

constexpr std::uint32_t unused = 0xa5a5a5a5;

/// The end of the part of the stack that reset() may overwrite: it keeps 128 bytes for itself.
std::uint32_t* painted_end() {
  return static_cast<std::uint32_t*>(__builtin_frame_address(0)) - 32;
}

}  // namespace

extern "C" [[noreturn]] void reset() {
  std::copy_n(data_in_code, data_end - data_begin, data_begin);
  std::fill(bss_begin, bss_end, 0U);
  std::fill(stack_begin, painted_end(), unused);
  std::for_each(init_array_begin, init_array_end, [](Initializer initialize) { initialize(); });
  main();
  stop();
}

namespace kinalign {

std::uint32_t stack_used() {
  const std::uint32_t* touched =
      std::find_if(stack_begin, stack_end, [](std::uint32_t word) { return word != unused; });
  return static_cast<std::uint32_t>(stack_end - touched) * sizeof(std::uint32_t);
}

}  // namespace kinalign

using Vector = void (*)();
extern "C" [[gnu::section(".vectors"), gnu::used]] const std::array<Vector, 7> vectors{
    reinterpret_cast<Vector>(stack_end), reset, stop, stop, stop, stop, stop};
