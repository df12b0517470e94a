// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/lab_advice.h"

#include "apps/kinalign/text/advice.h"

#include "kinalign/protocols/protocols.h"
#include "kinalign/syntax/toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace kinalign {

namespace {

using Port = std::optional<std::int64_t>;

struct MarkFlag {
  const char* name = "";
  const char* flag = "";
  Port port;
};

/// Both ports of marks, so that all checks and advice treat them alike.
std::array<MarkFlag, 2> mark_flags(const Port& marks, const Port& trigger) {
  return {{{"marks", "--marks-port", marks}, {"trigger", "--trigger-port", trigger}}};
}

/// The device's port with the flag, or the key of the settings file, that states it.
WantedPort wanted_by(const DeviceOptions& device, const LabSources& sources) {
  WantedPort wanted{static_cast<std::uint16_t>(device.port), "", "",
                    !is_datagrams(device.transport)};
  // The flag wins over the file, so it is the one to change.
  if (sources.by_flag.contains(device.name)) {
    const std::string said =
        fmt::format("--device {}={}:{}:", device.name, device.protocol, device.transport);
    wanted.port_from = said + "PORT";
    wanted.address_from = said + "ADDRESS:PORT";
  } else {
    const std::string said = fmt::format("[device.{}] in {}", toml_key(device.name), sources.file);
    wanted.port_from = "port of " + said;
    wanted.address_from = "address of " + said;
  }
  return wanted;
}

}  // namespace

Result<void> check_mark_ports(const Lab& lab, const Port& marks, const Port& trigger) {
  for (const auto& [name, flag, port] : mark_flags(marks, trigger)) {
    for (const DeviceOptions& device : lab.devices) {
      // Port 0 is chosen by the system and never collides. TCP and UDP have ports of their own.
      if (port.value_or(0) == 0 || device.port != *port || !is_datagrams(device.transport))
        continue;
      return Failure(Error{flag, 0, "another UDP port than that of device " + device.name,
                           std::to_string(*port)});
    }
  }
  return {};
}

Advice lab_port_advice(const Lab& lab, const LabSources& sources, const Port& marks,
                       const Port& trigger) {
  std::map<std::string, WantedPort> wanted;
  // The error of a port names its device, which is the key here.
  for (const DeviceOptions& device : lab.devices) wanted[device.name] = wanted_by(device, sources);
  for (const auto& [name, flag, port] : mark_flags(marks, trigger)) {
    wanted[name] = {static_cast<std::uint16_t>(port.value_or(0)), flag, "", false};
  }
  // The advice outlives this call, so it holds the map by value.
  return [wanted](const Error& error) -> std::vector<std::string> {
    const auto whose = wanted.find(error.file);
    if (whose == wanted.end()) return {};
    return port_advice(error, whose->second);
  };
}

std::string named_by(const std::string& key, const DeviceOptions& device,
                     const LabSources& sources) {
  return fmt::format("{} of [device.{}] in {} names it", key, toml_key(device.name), sources.file);
}

}  // namespace kinalign
