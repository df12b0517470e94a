// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <string_view>

namespace kinalign {

namespace {

/// Reads the whole text as a number from least to most.
template <class T>
bool number(std::string_view text, T least, T most, T& value) {
  T read{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (error != std::errc{} || end != text.data() + text.size()) return false;
  if (!(read >= least && read <= most)) return false;
  value = read;
  return true;
}

/// HOST:PORT or [HOST]:PORT.
bool server(std::string_view text, HostNodeOptions& options) {
  const std::size_t colon = text.rfind(':');
  int port = 0;
  if (colon == std::string_view::npos || !number(text.substr(colon + 1), 1, 65535, port))
    return false;
  std::string_view host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return false;  // an IPv6 address without brackets: it is not clear where the port begins
  }
  options.host = host;
  options.port = text.substr(colon + 1);
  return !host.empty();
}

constexpr double day_s = 86400;

bool at(std::string_view text, EventKind kind, HostNodeOptions& options) {
  Event event{.kind = kind};
  if (!number(text, 0.0, day_s, event.at_s)) return false;
  options.events.push_back(event);
  return true;
}

/// AT:VALUE
bool at_with(std::string_view text, EventKind kind, double most, HostNodeOptions& options) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return false;
  if (!at(text.substr(0, colon), kind, options)) return false;
  return number(text.substr(colon + 1), -most, most, options.events.back().value);
}

bool outage(std::string_view text, HostNodeOptions& options) {
  if (!at_with(text, EventKind::outage_begins, day_s, options)) return false;
  const Event begin = options.events.back();
  options.events.push_back({begin.at_s + begin.value, EventKind::outage_ends});
  return begin.value >= 0;
}

using Read = std::function<bool(std::string_view, HostNodeOptions&)>;

struct Flag {
  const char* name;
  const char* expected;  // nullptr: the flag takes no value
  Read read;
};

const std::vector<Flag>& flags();

}  // namespace

const char* host_node_help() {
  return R"(usage: host_node --server HOST:PORT [OPTIONS]     behaves as an inertial node, over UDP
       host_node --script                        plays a script (firmware/script/script.h)

  --server HOST:PORT     where frames go; [::1]:PORT for IPv6
  --id N                 node id (1)
  --rate HZ              frames a second (15)
  --sample-rate HZ       samples a second (100)
  --key-file FILE        the node's own key, 32 hexadecimal digits; the file's mode is 0600
  --seconds S            length of the run (until SIGINT or SIGTERM)
  --boot-id N            of the first start (random)
  --clockless            behave as a node without a counter: request, answer, confirm
  --orientation          send orientations too
  --battery-mv N         a battery with so many millivolts
  --dither-us N          delay each frame by up to N us (1000)
  --narrow               send stamps modulo 2^32
  --offset S             the counter at the start (0)
  --drift-ppm X          drift of the counter against the host's (0)
  --drift AT:PPM         change the drift AT seconds after the start
  --step AT:S            the counter jumps by S seconds
  --reboot-at AT         the counter begins at 0 again, with a new boot id
  --same-boot-id         a reboot keeps the boot id
  --outage AT:S          no link for S seconds, AT seconds after the start
  --rebind-at AT         send from another port, as after a change of address
  --sensor-fails N       every Nth reading gets no answer

Prints one line of JSON at the end: counts, and under "truth" the counter's value and drift from each
change on, with the time of the change (raw_ns of CLOCK_MONOTONIC_RAW).
)";
}

namespace {

template <class T>
Read into(T HostNodeOptions::*member, T least, T most) {
  return [=](std::string_view text, HostNodeOptions& o) {
    return number(text, least, most, o.*member);
  };
}

Read into(std::uint32_t NodeSettings::*member, std::uint32_t most) {
  return [=](std::string_view text, HostNodeOptions& o) {
    return number(text, std::uint32_t{0}, most, o.node.*member);
  };
}

Read set(bool HostNodeOptions::*member) {
  return [=](std::string_view, HostNodeOptions& o) { return o.*member = true; };
}

Read event(EventKind kind) {
  return [=](std::string_view text, HostNodeOptions& o) { return at(text, kind, o); };
}

Read event(EventKind kind, double most) {
  return [=](std::string_view text, HostNodeOptions& o) { return at_with(text, kind, most, o); };
}

bool boot_id(std::string_view text, HostNodeOptions& o) {
  o.has_boot_id = true;
  return number(text, std::uint32_t{0}, UINT32_MAX, o.node.boot_id);
}

const std::vector<Flag>& flags() {
  using O = HostNodeOptions;
  static const std::vector<Flag> all{
      {"help", nullptr, set(&O::help)},
      {"script", nullptr, set(&O::script)},
      {"clockless", nullptr, set(&O::clockless)},
      {"orientation", nullptr, set(&O::orientation)},
      {"same-boot-id", nullptr, set(&O::same_boot_id)},
      {"narrow", nullptr, [](std::string_view, O& o) { return o.node.narrow_counter = true; }},
      {"server", "HOST:PORT, or [HOST]:PORT for IPv6", server},
      {"id", "a number of 32 bits", into(&NodeSettings::node_id, UINT32_MAX)},
      {"boot-id", "a number of 32 bits", boot_id},
      {"dither-us", "0 to 100000", into(&NodeSettings::dither_us, 100'000)},
      {"rate", "0.1 to 1000 Hz", into(&O::rate_hz, 0.1, 1000.0)},
      {"sample-rate", "0.1 to 1000 Hz", into(&O::sample_rate_hz, 0.1, 1000.0)},
      {"seconds", "0.001 to 1000000", into(&O::seconds, 0.001, 1e6)},
      {"drift-ppm", "-100000 to 100000", into(&O::drift_ppm, -1e5, 1e5)},
      {"offset", "0 to 1e12 s", into(&O::offset_s, 0.0, 1e12)},
      {"battery-mv", "1 to 65535", into(&O::battery_mv, 1, 65535)},
      {"sensor-fails", "1 or more", into(&O::sensor_fails_every, 1, INT32_MAX)},
      {"key-file", "a file",
       [](std::string_view text, O& o) { return !(o.key_file = text).empty(); }},
      {"reboot-at", "seconds", event(EventKind::reboot)},
      {"rebind-at", "seconds", event(EventKind::rebind)},
      {"step", "AT:S, both in seconds", event(EventKind::step, 1e6)},
      {"drift", "AT:PPM, up to 100000", event(EventKind::drift, 1e5)},
      {"outage", "AT:S, both in seconds", outage}};
  return all;
}

/// Whether the words differ in one letter or in two neighbouring ones, and in no more than half of
/// the longer word.
bool resembles(std::string_view word, std::string_view name) {
  const std::size_t longer = std::max(word.size(), name.size());
  while (!word.empty() && !name.empty() && word.front() == name.front()) {
    word.remove_prefix(1);
    name.remove_prefix(1);
  }
  while (!word.empty() && !name.empty() && word.back() == name.back()) {
    word.remove_suffix(1);
    name.remove_suffix(1);
  }
  const std::size_t differing = std::max(word.size(), name.size());
  return differing <= 2 && 2 * differing <= longer;
}

tl::unexpected<Trouble> no_option(const std::string& word) {
  const std::string_view name =
      std::string_view(word).substr(std::min(word.find_first_not_of('-'), word.size()));
  const auto near = std::find_if(flags().begin(), flags().end(),
                                 [&](const Flag& one) { return resembles(name, one.name); });
  const std::string meant =
      near == flags().end() ? "" : std::string("did you mean --") + near->name + "? ";
  return wrong_use("unknown option " + word + "; " + meant + "--help lists the options");
}

Tried<HostNodeOptions> completed(HostNodeOptions options) {
  if (options.help || options.script) return options;
  if (options.host.empty())
    return wrong_use("expected --server HOST:PORT; --help lists the options");
  options.node.frame_period_us = static_cast<std::uint32_t>(std::lround(1e6 / options.rate_hz));
  std::stable_sort(options.events.begin(), options.events.end(),
                   [](const Event& a, const Event& b) { return a.at_s < b.at_s; });
  return options;
}

}  // namespace

Tried<HostNodeOptions> options_from(std::span<const char* const> words) {
  HostNodeOptions options;
  options.node.node_id = 1;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    const auto flag = std::find_if(flags().begin(), flags().end(), [&](const Flag& one) {
      return word.substr(0, 2) == "--" && word.substr(2) == one.name;
    });
    if (flag == flags().end()) {
      return no_option(words[i]);
    }
    if (flag->expected != nullptr && i + 1 == words.size()) {
      return wrong_use(std::string(word) + ": expected a value after it (" + flag->expected +
                       "), found nothing");
    }
    const std::string value = flag->expected != nullptr ? words[++i] : "";
    if (!flag->read(value, options)) {
      return wrong_use(std::string(word) + ": expected " + flag->expected + ", found \"" + value +
                       "\"");
    }
  }
  return completed(std::move(options));
}

}  // namespace kinalign
