// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/report.h"

#include "firmware/node/count_names.h"

#include <array>
#include <charconv>

namespace kinalign {

namespace {

/// Builds an object of JSON. Values are given as JSON text.
class Object {
 public:
  Object& add(const std::string& name, const std::string& value) {
    text_ += (text_.empty() ? "\"" : ", \"") + name + "\": " + value;
    return *this;
  }
  Object& add(const std::string& name, std::uint64_t value) {
    return add(name, std::to_string(value));
  }
  std::string text() const { return '{' + text_ + '}'; }

 private:
  std::string text_;
};

/// The shortest text of the number without an exponent, so that the microseconds of a counter can
/// be read.
std::string shortest(double value) {
  std::array<char, 400> digits{};  // the longest double
  const auto format = std::chars_format::fixed;
  return {digits.begin(), std::to_chars(digits.begin(), digits.end(), value, format).ptr};
}

std::string truths(const std::vector<ClockTruth>& all) {
  std::string text;
  for (const ClockTruth& truth : all) {
    text += (text.empty() ? "" : ", ") + Object()
                                             .add("boot_id", truth.boot_id)
                                             .add("raw_ns", std::to_string(truth.raw_ns))
                                             .add("counter_us", shortest(truth.counter_us))
                                             .add("drift_ppm", shortest(truth.drift_ppm))
                                             .text();
  }
  return '[' + text + ']';
}

const char* name_of(SyncLight sync) {
  if (sync == SyncLight::unanswered) return "\"unanswered\"";
  return sync == SyncLight::answered ? "\"answered\"" : "\"locked\"";
}

}  // namespace

std::string report(const HostNodeOptions& options, NodeRun& node_run) {
  const RunCounts counts = node_run.counts();
  Object all;
  all.add("node_id", options.node.node_id).add("reboots", counts.reboots);
  const auto add = [&](const char* name, std::uint64_t number) { all.add(name, number); };
  if (options.clockless) {
    each_clockless_count(counts.clockless, add);
  } else {
    each_node_count(counts.node, add);
  }
  return all.add("sync", name_of(node_run.lights().sync))
      .add("truth", truths(node_run.truths()))
      .text();
}

}  // namespace kinalign
