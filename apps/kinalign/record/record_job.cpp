// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_job.h"

#include "apps/cli/field_text.h"
#include "apps/cli/settings.h"
#include "apps/cli/verb.h"
#include "apps/kinalign/text/advice.h"

#include "kinalign/capture/nodes/node_keys.h"
#include "kinalign/documents/lab_toml.h"
#include "kinalign/formats/bvh/head.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/syntax/toml.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <map>
#include <set>
#include <utility>

namespace kinalign {

namespace {

/// The places that describe the lab's devices: a file, flags, or both. A flag changes the device of
/// the same name in the file.
struct LabSources {
  std::string file;               // the file with tables [device.NAME]; empty: no file
  std::set<std::string> by_flag;  // the devices that a --device flag names
};

LabSources sources_of(const RecordJob& job, const Call& call) {
  LabSources sources{project_settings(call.surroundings, call.common.config), {}};
  // parse_device() has accepted these texts, so each of them contains a '='.
  for (const std::string& text : job.devices) {
    sources.by_flag.insert(text.substr(0, text.find('=')));
  }
  return sources;
}

struct MarkFlag {
  const char* name = "";
  const char* flag = "";
  std::optional<std::int64_t> port;
};

/// The two ports for marks, in one list for checks and advice.
std::array<MarkFlag, 2> mark_flags(const RecordJob& job) {
  return {
      {{"marks", "--marks-port", job.marks_port}, {"trigger", "--trigger-port", job.trigger_port}}};
}

/// Fails if the UDP port of a device is also a port for marks.
Result<void> check_mark_ports(const RecordJob& job, const Lab& lab) {
  for (const auto& [name, flag, port] : mark_flags(job)) {
    for (const DeviceOptions& device : lab.devices) {
      // For port 0 the system chooses a free port. A TCP port and a UDP port may have the same
      // number.
      if (port.value_or(0) == 0 || device.port != *port || !is_datagrams(device.transport))
        continue;
      return Failure(Error{flag, 0, "another UDP port than that of device " + device.name,
                           std::to_string(*port)});
    }
  }
  return {};
}

/// Advice for a file that could not be read: "skeleton of [device.mocap] in lab.toml names it".
std::string named_by(const std::string& key, const DeviceOptions& device,
                     const LabSources& sources) {
  return fmt::format("{} of [device.{}] in {} names it", key, toml_key(device.name), sources.file);
}

/// Refuses a lab that can't be recorded. If a settings file caused the error, the error names the
/// file and line in place of the flag.
Failure refuse_lab(Error error, Call& call) {
  for (const char* name : {"marks_port", "trigger_port"}) {
    // A file may set a port for marks, so the error names the place in that file.
    if (error.file != flag_of(name)) continue;
    const SettingPlace place = setting_place("record", name, call);
    if (!place.file.empty()) error.file = place.file;
    error.line = place.line;
  }
  const bool in_file = error.line > 0;
  // refuse() makes the error wrong use, with exit code 2.
  Failure refused = call.console.refuse(std::move(error));
  if (in_file) {
    call.console.if_it_fails(
        [](const Error&) { return std::vector<std::string>{std::string(settings_pages)}; });
  }
  return refused;
}

/// A settings file and its devices. The text is empty if the file has no devices.
struct LabFile {
  std::string text;
  std::vector<DeviceOptions> devices;
};
/// Reads the project's settings file, if it exists. An error in its devices is wrong use.
Result<LabFile> read_lab_file(Call& call) {
  // People write settings files by hand, so a larger file is refused.
  constexpr std::size_t most_bytes = std::size_t{1} << 20;
  const std::string path = project_settings(call.surroundings, call.common.config);
  if (path.empty()) return LabFile{};
  LabFile lab{KA_TRY(read_whole(call.surroundings.files, path, most_bytes)), {}};
  auto devices = read_devices(lab.text, path);
  if (!devices) return refuse_lab(std::move(devices).error(), call);
  lab.devices = *std::move(devices);
  // Only a file that describes the lab's devices is copied into the recording.
  if (lab.devices.empty()) lab.text.clear();
  return lab;
}

/// The name of this machine, which the recording states. Empty if the machine has no name.
std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// True if the device sends rotations only and has no skeleton. Its data can then be recorded, but
/// not shown or aligned.
bool needs_skeleton(const DeviceOptions& device) {
  const auto protocol = find_protocol(device.protocol);
  return protocol && row_of(*protocol).needs_skeleton;
}

std::string without_skeleton(const std::string& device) {
  return fmt::format(
      "note: {0} has no skeleton: Noitom's stream does not say whose body it moves. Put skeleton = "
      "\"a.bvh\" under [device.{1}] of a lab.toml now, or give it to align afterwards",
      device, toml_key(device));
}

/// Reads the lab's key. A flag or setting overrides the key file of the nodes' device. `named`: the
/// device's key in the settings file, for the advice; empty for a flag. The advice is removed after
/// reading.
Result<void> read_key(Call& call, const std::string& path, const std::string& named,
                      RecordingSession::Options& options) {
  call.console.if_it_fails([named](const Error& error) {
    std::vector<std::string> lines = key_advice(error);
    if (!named.empty()) lines.insert(lines.begin(), named);
    return lines;
  });
  options.node_responder.lab_key = KA_TRY(read_lab_key(call.surroundings.files, path));
  call.console.if_it_fails({});
  return {};
}

Result<void> read_skeleton(Call& call, const DeviceOptions& device, const std::string& named,
                           RecordingSession::Options& options) {
  // The error names the BVH file; the advice states which setting names this file.
  call.console.if_it_fails([named](const Error&) { return std::vector<std::string>{named}; });
  options.skeletons[device.name] = KA_TRY(read_bvh_head(call.surroundings.files, device.skeleton));
  call.console.if_it_fails({});
  return {};
}

/// Reads the key files and skeletons that the devices in lab.toml name.
Result<void> read_files(const RecordJob& job, Call& call, RecordingSession::Options& options) {
  const LabSources sources = sources_of(job, call);
  // A flag or setting overrides the key files of the devices.
  if (!job.lab_key.empty()) KA_TRY(read_key(call, job.lab_key, "", options));
  for (const DeviceOptions& device : options.lab.devices) {
    if (!device.lab_key.empty() && job.lab_key.empty()) {
      KA_TRY(read_key(call, device.lab_key, named_by("lab_key", device, sources), options));
    }
    if (!device.skeleton.empty()) {
      KA_TRY(read_skeleton(call, device, named_by("skeleton", device, sources), options));
    } else if (needs_skeleton(device)) {
      // Recording goes on, because the skeleton can be given to `align` later.
      call.console.note(without_skeleton(device.name));
    }
  }
  return {};
}

/// A device's port, and the flag or the key of the settings file that sets it.
WantedPort wanted_by(const DeviceOptions& device, const LabSources& sources) {
  WantedPort wanted{static_cast<std::uint16_t>(device.port), "", "",
                    !is_datagrams(device.transport)};
  // A flag overrides the file, so the user must change the flag.
  if (sources.by_flag.contains(device.name)) {
    const std::string place =
        fmt::format("--device {}={}:{}:", device.name, device.protocol, device.transport);
    wanted.port_from = place + "PORT";
    wanted.address_from = place + "ADDRESS:PORT";
  } else {
    const std::string place = fmt::format("[device.{}] in {}", toml_key(device.name), sources.file);
    wanted.port_from = "port of " + place;
    wanted.address_from = "address of " + place;
  }
  return wanted;
}

std::optional<std::uint16_t> port_of(const std::optional<std::int64_t>& port) {
  return port ? std::optional(static_cast<std::uint16_t>(*port)) : std::nullopt;
}

}  // namespace

Result<Lab> lab_of(const RecordJob& job, std::vector<DeviceOptions> in_file) {
  Lab lab{std::move(in_file), job.options};
  std::set<std::string> named;
  // Each device may have one --device flag, which may also change a device of the file.
  for (const std::string& text : job.devices) {
    const auto device = parse_device(text);
    if (!device) {
      return Failure(Error{"--device", 0, device.error().expected, device.error().found});
    }
    if (!named.insert(device->name).second) {
      return Failure(
          Error{"--device", 0, "devices of different names", shown(device->name) + " twice"});
    }
    // set_device() replaces the device of the same name, or adds a new one.
    set_device(lab, *device);
  }
  KA_TRY(validate(lab));
  KA_TRY(check_mark_ports(job, lab));
  return lab;
}

Result<RecordingSession::Options> session_options(const RecordJob& job, Call& call) {
  LabFile file = KA_TRY(read_lab_file(call));
  RecordingSession::Options options;
  auto lab = lab_of(job, std::move(file.devices));
  if (!lab) return refuse_lab(std::move(lab).error(), call);
  options.lab = *std::move(lab);
  if (options.lab.devices.empty()) {
    return call.console.refuse(
        Error{"--device", 0, "at least one device, or a lab.toml for --config", "none"});
  }
  // Without a port for marks and without a keyboard, no mark could ever start a take.
  if (job.wait && !job.marks_port && !job.trigger_port && ::isatty(STDIN_FILENO) == 0) {
    return call.console.refuse(
        Error{"--wait", 0, "--marks-port, --trigger-port or a keyboard for the start", "none"});
  }
  options.lab_toml = std::move(file.text);
  options.marks_port = port_of(job.marks_port);
  options.trigger_port = port_of(job.trigger_port);
  options.live_port = port_of(job.live_port);
  options.host = host_name();
  // The secret of the node receiver is new for each run.
  options.node_responder.secret = KA_TRY(new_secret());
  KA_TRY(read_files(job, call, options));
  return options;
}

Advice lab_port_advice(const RecordJob& job, const Lab& lab, const Call& call) {
  const LabSources sources = sources_of(job, call);
  std::map<std::string, WantedPort> wanted;
  // The error of a port names the device, so the map's key is the device's name.
  for (const DeviceOptions& device : lab.devices) wanted[device.name] = wanted_by(device, sources);
  for (const auto& [name, flag, port] : mark_flags(job)) {
    wanted[name] = {static_cast<std::uint16_t>(port.value_or(0)), flag, "", false};
  }
  // The advice is used after this function has returned, so it has a copy of the map.
  return [wanted](const Error& error) -> std::vector<std::string> {
    const auto whose = wanted.find(error.file);
    if (whose == wanted.end()) return {};
    return port_advice(error, whose->second);
  };
}

}  // namespace kinalign
