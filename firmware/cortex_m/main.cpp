// SPDX-License-Identifier: Apache-2.0
// The node on a Cortex-M3 that has only a serial line for clock, sensor and radio: see
// firmware/script/script.h. The port is Arm's PL011 (technical reference manual DDI 0183, chapter
// 3), the first of the LM3S6965.
#include "firmware/cortex_m/stack.h"
#include "firmware/script/script.h"

#include <new>

namespace {

struct UartRegisters {
  volatile std::uint32_t data;
  std::uint32_t unused_1[5];
  volatile std::uint32_t flags;
  std::uint32_t unused_2[4];
  volatile std::uint32_t line_control, control;
};
constexpr std::uintptr_t uart_address = 0x4000c000;
constexpr std::uint32_t receiver_empty = 1 << 4, transmitter_full = 1 << 5;  // bits of flags
constexpr std::uint32_t eight_bits = 3 << 5, with_queues = 1 << 4;           // bits of line_control
// Bits of control: port, transmitter, receiver.
constexpr std::uint32_t enabled = 1 | 1 << 8 | 1 << 9;

class Uart : public kinalign::Line {
 public:
  Uart() {
    uart_.line_control = eight_bits | with_queues;
    uart_.control = enabled;
  }
  bool read(std::span<std::uint8_t> bytes) override {
    for (auto& byte : bytes) {
      while ((uart_.flags & receiver_empty) != 0) wait();
      byte = static_cast<std::uint8_t>(uart_.data);
    }
    return true;
  }
  void write(std::span<const std::uint8_t> bytes) override {
    for (const auto byte : bytes) {
      while ((uart_.flags & transmitter_full) != 0) continue;
      uart_.data = byte;
    }
  }

 private:
  /// Waits a little between two looks at a register. An emulator has one lock for all registers, so
  /// asking without a pause would keep the serial line itself out.
  static void wait() {
    for (int i = 0; i < 1000; ++i) asm volatile("");
  }

  UartRegisters& uart_ = *reinterpret_cast<UartRegisters*>(uart_address);
};

alignas(kinalign::Script)
    std::array<std::byte, sizeof(kinalign::Script)> memory;  // too large for the stack

}  // namespace

int main() {
  Uart uart;
  auto* script = new (memory.data()) kinalign::Script(uart);
  script->play();
  std::array<std::uint8_t, 4> used{};
  kinalign::ByteWriter(used).put(kinalign::stack_used());
  write_message(uart, 'M', used);
  return 0;
}
