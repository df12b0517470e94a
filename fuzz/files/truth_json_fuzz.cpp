// SPDX-License-Identifier: Apache-2.0
// A truth that is accepted is written and read again to the same text, and its clocks tell times.
#include "kinalign/documents/truth_json.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

namespace {

void ask(const TrueClock& clock) {
  for (const std::int64_t stamp : clock.stamps_ns) {
    if (clock.stamps_ns.size() > 1 && !true_time(clock, utc_time(stamp))) std::abort();
    if (true_time(clock, utc_time(stamp / 2)).has_value() != (clock.stamps_ns.size() > 1)) {
      std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto first = read_truth({reinterpret_cast<const char*>(data), size}, "truth.json");
  if (!first) return 0;
  ask(first->kinect.clock);
  for (const TrueNode& node : first->nodes) ask(node.clock);
  (void)first->mocap.frame_ns(first->mocap.frames);
  const std::string json = truth_json(*first);
  const auto second = read_truth(json, "truth.json");
  if (!second || truth_json(*second) != json) std::abort();
  return 0;
}
