// SPDX-License-Identifier: Apache-2.0
// M5Stack ATOM Matrix: ESP32, MPU-6886, 25 LEDs. It has no battery that it can measure. Written
// against ESP-IDF 5.3's documented interface (ESP Timer, I2C master, lwIP sockets) and the
// component espressif/led_strip. This board's code has not been compiled or run together with the
// rest.
#pragma once

#include "firmware/node/board.h"

#include <driver/i2c_master.h>
#include <freertos/FreeRTOS.h>
#include <led_strip.h>

namespace kinalign {

class Esp32Board : public Board {
 public:
  /// Opens the buses. A device that does not answer is asked again later.
  void start();
  /// Opens a socket to the host of config.h in place of the earlier one. To be called after each
  /// new link.
  void open_socket();
  /// Waits until a datagram arrives, at most longest_us.
  void wait_for_arrival(std::uint32_t longest_us);

  std::uint64_t counter_us() override;
  bool read_imu(NodeSample& sample) override;
  bool send(std::span<const std::uint8_t> datagram) override;
  bool receive(std::span<std::uint8_t> room, std::size_t& size) override;
  bool read_battery(std::uint16_t&) override { return false; }
  void show(const Lights& lights) override;
  void lock() override { taskENTER_CRITICAL(&lock_); }
  void unlock() override { taskEXIT_CRITICAL(&lock_); }

 private:
  bool set_up_imu();
  bool read_registers(std::uint8_t address, std::span<std::uint8_t> values);

  i2c_master_dev_handle_t imu_ = nullptr;
  bool imu_ready_ = false;
  std::uint32_t imu_asked_ = 0;
  led_strip_handle_t leds_ = nullptr;
  int socket_ = -1;
  portMUX_TYPE lock_ = portMUX_INITIALIZER_UNLOCKED;
};

}  // namespace kinalign
