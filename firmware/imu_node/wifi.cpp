// SPDX-License-Identifier: Apache-2.0
#include "firmware/imu_node/wifi.h"

#include "firmware/imu_node/config.h"

#include <esp_event.h>
#include <esp_netif.h>
#include <esp_wifi.h>
#include <nvs_flash.h>

#include <algorithm>
#include <atomic>

namespace kinalign {

namespace {

std::atomic<bool> is_up = false;

void on_event(void*, esp_event_base_t base, std::int32_t id, void*) {
  if (base == IP_EVENT && id == IP_EVENT_STA_GOT_IP) is_up = true;
  if (base == IP_EVENT && id == IP_EVENT_STA_LOST_IP) is_up = false;
  if (base == WIFI_EVENT && id == WIFI_EVENT_STA_DISCONNECTED) is_up = false;
}

/// Opens the storage that holds the radio's calibration. It is erased once if an older version
/// wrote it.
void start_storage() {
  const esp_err_t error = nvs_flash_init();
  if (error == ESP_ERR_NVS_NO_FREE_PAGES || error == ESP_ERR_NVS_NEW_VERSION_FOUND) {
    ESP_ERROR_CHECK(nvs_flash_erase());
    ESP_ERROR_CHECK(nvs_flash_init());
  }
}

/// Copies a text into a field of zeros that is at least as long.
template <std::size_t n, std::size_t room>
void copy_text(const char (&text)[n], std::uint8_t (&field)[room]) {
  static_assert(n - 1 <= room);
  std::copy_n(text, n - 1, field);
}

}  // namespace

void start_wifi() {
  start_storage();
  ESP_ERROR_CHECK(esp_netif_init());
  ESP_ERROR_CHECK(esp_event_loop_create_default());
  esp_netif_create_default_wifi_sta();
  wifi_init_config_t driver = WIFI_INIT_CONFIG_DEFAULT();
  ESP_ERROR_CHECK(esp_wifi_init(&driver));
  ESP_ERROR_CHECK(esp_wifi_set_storage(WIFI_STORAGE_RAM));
  ESP_ERROR_CHECK(esp_event_handler_register(WIFI_EVENT, ESP_EVENT_ANY_ID, on_event, nullptr));
  ESP_ERROR_CHECK(esp_event_handler_register(IP_EVENT, ESP_EVENT_ANY_ID, on_event, nullptr));
  wifi_config_t network{};
  copy_text(config::wifi_name, network.sta.ssid);
  copy_text(config::wifi_password, network.sta.password);
  ESP_ERROR_CHECK(esp_wifi_set_mode(WIFI_MODE_STA));
  ESP_ERROR_CHECK(esp_wifi_set_config(WIFI_IF_STA, &network));
  ESP_ERROR_CHECK(esp_wifi_start());
  ESP_ERROR_CHECK(esp_wifi_set_ps(WIFI_PS_NONE));
}

bool wifi_is_up() { return is_up; }

void join_wifi() {
  is_up = false;
  esp_wifi_disconnect();  // fails if there is no link to leave, which does no harm
  esp_wifi_connect();     // if this fails at once, LinkPolicy asks again
}

}  // namespace kinalign
