// SPDX-License-Identifier: Apache-2.0
#include "firmware/imu_node/esp32_board.h"

#include "firmware/imu_node/config.h"
#include "firmware/imu_node/mpu6886.h"

#include <esp_err.h>
#include <esp_timer.h>
#include <freertos/task.h>
#include <lwip/netdb.h>
#include <lwip/sockets.h>

namespace kinalign {

namespace {

constexpr gpio_num_t sda_pin = GPIO_NUM_25, scl_pin = GPIO_NUM_21;
constexpr int led_pin = 27;
constexpr int bus_timeout_ms = 5;  // 17 bytes at 400 kHz take 0.4 ms
// The sensor is asked again at each 100th reading.
constexpr std::uint32_t ask_imu_again_every = 100;

i2c_master_dev_handle_t open_imu() {
  i2c_master_bus_config_t bus_config{};
  bus_config.i2c_port = I2C_NUM_0;
  bus_config.sda_io_num = sda_pin;
  bus_config.scl_io_num = scl_pin;
  bus_config.clk_source = I2C_CLK_SRC_DEFAULT;
  bus_config.glitch_ignore_cnt = 7;
  bus_config.flags.enable_internal_pullup = 1;
  i2c_master_bus_handle_t bus = nullptr;
  ESP_ERROR_CHECK(i2c_new_master_bus(&bus_config, &bus));
  i2c_device_config_t device_config{};
  device_config.dev_addr_length = I2C_ADDR_BIT_LEN_7;
  device_config.device_address = mpu6886::bus_address;
  device_config.scl_speed_hz = 400'000;  // the fastest clock that the sensor takes
  i2c_master_dev_handle_t device = nullptr;
  ESP_ERROR_CHECK(i2c_master_bus_add_device(bus, &device_config, &device));
  return device;
}

led_strip_handle_t open_leds() {
  led_strip_config_t config{};  // the colours' order is green, red, blue by default
  config.strip_gpio_num = led_pin;
  config.max_leds = matrix_side * matrix_side;
  config.led_model = LED_MODEL_WS2812;
  led_strip_rmt_config_t rmt_config{};
  rmt_config.resolution_hz = 10'000'000;
  led_strip_handle_t leds = nullptr;
  ESP_ERROR_CHECK(led_strip_new_rmt_device(&config, &rmt_config, &leds));
  return leds;
}

int connected_socket() {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  // Only an address in digits, because asking a name server would wait.
  wanted.ai_flags = AI_NUMERICHOST;
  addrinfo* found = nullptr;
  if (getaddrinfo(config::server, config::server_port, &wanted, &found) != 0) return -1;
  const int made = ::socket(found->ai_family, SOCK_DGRAM, 0);
  if (made >= 0) ::connect(made, found->ai_addr, found->ai_addrlen);
  freeaddrinfo(found);
  return made;
}

}  // namespace

void Esp32Board::start() {
  imu_ = open_imu();
  leds_ = open_leds();
}

void Esp32Board::open_socket() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = connected_socket();
}

void Esp32Board::wait_for_arrival(std::uint32_t longest_us) {
  if (socket_ < 0) {
    vTaskDelay(pdMS_TO_TICKS(10));
    return;
  }
  fd_set watched;
  FD_ZERO(&watched);
  FD_SET(socket_, &watched);
  timeval longest{};
  longest.tv_usec = static_cast<suseconds_t>(longest_us);
  ::select(socket_ + 1, &watched, nullptr, nullptr, &longest);
}

std::uint64_t Esp32Board::counter_us() { return static_cast<std::uint64_t>(esp_timer_get_time()); }

bool Esp32Board::read_registers(std::uint8_t address, std::span<std::uint8_t> values) {
  return i2c_master_transmit_receive(imu_, &address, 1, values.data(), values.size(),
                                     bus_timeout_ms) == ESP_OK;
}

bool Esp32Board::set_up_imu() {
  std::array<std::uint8_t, 1> identity{};
  if (!read_registers(mpu6886::identity_register, identity)) return false;
  if (identity[0] != mpu6886::identity) return false;
  for (const mpu6886::Setting& setting : mpu6886::settings) {
    const std::array<std::uint8_t, 2> bytes{setting.address, setting.value};
    if (i2c_master_transmit(imu_, bytes.data(), bytes.size(), bus_timeout_ms) != ESP_OK)
      return false;
    if (setting.then_wait_ms != 0) vTaskDelay(pdMS_TO_TICKS(setting.then_wait_ms));
  }
  return true;
}

bool Esp32Board::read_imu(NodeSample& sample) {
  if (!imu_ready_) {  // at the start, and after a failed reading: the sensor may have been reset
    if (imu_asked_++ % ask_imu_again_every == 0) imu_ready_ = set_up_imu();
    return false;  // setting up took time, so this tick has no reading
  }
  std::array<std::uint8_t, mpu6886::values_size> registers{};
  imu_ready_ = read_registers(mpu6886::values_register, registers);
  if (imu_ready_) sample = mpu6886::sample_of(registers);
  return imu_ready_;
}

bool Esp32Board::send(std::span<const std::uint8_t> datagram) {
  if (socket_ < 0) return false;
  return ::send(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT) >= 0;
}

bool Esp32Board::receive(std::span<std::uint8_t> room, std::size_t& size) {
  if (socket_ < 0) return false;
  const auto got = ::recv(socket_, room.data(), room.size(), MSG_DONTWAIT);
  if (got < 0) return false;
  size = static_cast<std::size_t>(got);
  return true;
}

void Esp32Board::show(const Lights& lights) {
  const Picture colours = picture(lights);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    led_strip_set_pixel(leds_, i, colours[i].red, colours[i].green, colours[i].blue);
  }
  led_strip_refresh(leds_);
}

}  // namespace kinalign
