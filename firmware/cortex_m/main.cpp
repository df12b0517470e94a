// SPDX-License-Identifier: Apache-2.0
// The node on a Cortex-M3, with a serial line for its world: see firmware/script/script.h. The
// port is the CMSDK UART of Arm's Cortex-M System Design Kit (technical reference manual,
// section 4.3): as slow as it is, it waits for nobody here.
#include "firmware/cortex_m/stack.h"
#include "firmware/script/script.h"

#include <new>

namespace {

struct UartRegisters {
  volatile std::uint32_t data, state, control, interrupt, baud_divider;
};
constexpr std::uintptr_t uart_address = 0x40004000;
constexpr std::uint32_t transmitter_full = 1, receiver_full = 2;        // of state
constexpr std::uint32_t transmitter_enabled = 1, receiver_enabled = 2;  // of control

class Uart : public kinalign::Line {
 public:
  Uart() {
    uart_.baud_divider = 16;  // the least there is
    uart_.control = transmitter_enabled | receiver_enabled;
  }
  bool read(std::span<std::uint8_t> bytes) override {
    for (auto& byte : bytes) {
      while ((uart_.state & receiver_full) == 0) continue;
      byte = static_cast<std::uint8_t>(uart_.data);
    }
    return true;
  }
  void write(std::span<const std::uint8_t> bytes) override {
    for (const auto byte : bytes) {
      while ((uart_.state & transmitter_full) != 0) continue;
      uart_.data = byte;
    }
  }

 private:
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
