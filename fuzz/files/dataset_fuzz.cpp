// SPDX-License-Identifier: Apache-2.0
// A catalogue that is accepted has ids that can stand in file names; a summary that is accepted is
// written and read again to the same text.
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/take_summary.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto catalogue = read_catalogue(text, "dataset.toml")) {
    for (const Subject& one : catalogue->subjects) {
      if (!is_label(one.id)) std::abort();
    }
    for (const Action& one : catalogue->actions) {
      if (!is_label(one.id) || find_action(*catalogue, one.id) == nullptr) std::abort();
    }
  }
  if (const auto path = parse_take_path(text); path && path_of(path->first, path->second) != text) {
    std::abort();
  }
  const auto summary = parse_summary_json(text, "take.json");
  if (!summary) return 0;
  const std::string json = summary_json(*summary);
  const auto again = parse_summary_json(json, "take.json");
  if (!again || summary_json(*again) != json) std::abort();
  return 0;
}
