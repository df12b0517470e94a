// SPDX-License-Identifier: Apache-2.0
// Two tasks on the core that the radio does not use. One samples when the timer fires, the other
// sends, receives and keeps the link. Their decisions are made by the code in firmware/node.
#include "firmware/imu_node/config.h"
#include "firmware/imu_node/esp32_board.h"
#include "firmware/imu_node/wifi.h"
#include "firmware/node/link_policy.h"
#include "firmware/node/node.h"

#include <esp_random.h>
#include <esp_system.h>
#include <esp_task_wdt.h>
#include <esp_timer.h>
#include <freertos/task.h>

#include <new>

namespace {

using namespace kinalign;

constexpr BaseType_t our_core = 1;
constexpr UBaseType_t sampling_priority = 20, sending_priority = 10;
constexpr std::uint32_t stack_size = 4096;

Esp32Board board;
// The node is made later, once there is a boot id.
alignas(Node) std::array<std::byte, sizeof(Node)> node_memory;
Node* node = nullptr;
TaskHandle_t sampling = nullptr;

void on_timer(void*) { xTaskNotifyGive(sampling); }

[[noreturn]] void sample(void*) {
  for (;;) node->tick(ulTaskNotifyTake(pdTRUE, portMAX_DELAY));  // the number of ticks that are due
}

struct Keeper {
  LinkPolicy policy;
  Watchdog watchdog;
  std::uint64_t answered = 0;  // replies so far
  bool was_up = false;
};

/// Does the action that the link policy decides on. True: there is a link.
bool keep_link(Keeper& keeper) {
  const std::uint64_t accepted = node->replies_accepted();
  const bool answered = accepted != keeper.answered;
  keeper.answered = accepted;
  const LinkAction action = keeper.policy.step(board.counter_us(), wifi_is_up(), answered);
  if (action == LinkAction::restart) esp_restart();
  if (action == LinkAction::join) join_wifi();
  const bool up = wifi_is_up();
  if (up && !keeper.was_up) board.open_socket();
  keeper.was_up = up;
  return up;
}

[[noreturn]] void exchange(void*) {
  Keeper keeper;
  ESP_ERROR_CHECK(esp_task_wdt_add(nullptr));
  for (;;) {
    node->set_link(keep_link(keeper));
    node->poll();
    const std::uint64_t now_us = board.counter_us();
    if (keeper.watchdog.may_feed(now_us, node->counts().samples.ticks)) esp_task_wdt_reset();
    board.wait_for_arrival(node->idle_us(now_us));
  }
}

NodeSettings settings() {
  NodeSettings settings;
  settings.node_id = config::node_id;
  settings.boot_id = esp_random();  // esp_random() is random only once the radio runs
  settings.has_key = config::has_key;
  settings.key = config::key;
  settings.frame_period_us = 1'000'000 / config::frame_rate_hz;
  return settings;
}

}  // namespace

extern "C" void app_main() {
  board.start();
  start_wifi();
  node = new (node_memory.data()) Node(board, settings());
  xTaskCreatePinnedToCore(sample, "sample", stack_size, nullptr, sampling_priority, &sampling,
                          our_core);
  xTaskCreatePinnedToCore(exchange, "exchange", stack_size, nullptr, sending_priority, nullptr,
                          our_core);
  esp_timer_create_args_t timer_config{};
  timer_config.callback = on_timer;
  timer_config.name = "sample";
  esp_timer_handle_t timer = nullptr;
  ESP_ERROR_CHECK(esp_timer_create(&timer_config, &timer));
  ESP_ERROR_CHECK(esp_timer_start_periodic(timer, 1'000'000 / config::sample_rate_hz));
}
