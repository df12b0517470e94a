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
#include <set>
#include <utility>

namespace kinalign {

namespace {

/// Refuses a lab that can't be recorded as stated. An error about a flag may be about the same
/// setting in a file; then it names the file and line.
Failure refuse_lab(Error error, Call& call) {
  for (const char* name : {"marks_port", "trigger_port"}) {
    // A port for marks may come from a file. The user needs the place where it stands.
    if (error.file != flag_of(name)) continue;
    const SettingPlace place = setting_place("record", name, call);
    if (!place.file.empty()) error.file = place.file;
    error.line = place.line;
  }
  const bool in_file = error.line > 0;
  // refuse() makes it wrong use, with exit code 2.
  Failure refused = call.console.refuse(std::move(error));
  if (in_file) {
    call.console.if_it_fails(
        [](const Error&) { return std::vector<std::string>{std::string(settings_pages)}; });
  }
  return refused;
}

/// The settings file if it has devices; without devices the text is empty.
struct LabFile {
  std::string text;
  std::vector<DeviceOptions> devices;
};
/// Reads the project's settings file, if there is one. Faults in its devices are wrong use.
Result<LabFile> read_lab_file(Call& call) {
  // A settings file is written by hand; a larger one is refused.
  constexpr std::size_t most_bytes = std::size_t{1} << 20;
  const std::string path = project_settings(call.surroundings, call.common.config);
  if (path.empty()) return LabFile{};
  LabFile lab{KA_TRY(read_whole(call.surroundings.files, path, most_bytes)), {}};
  auto devices = read_devices(lab.text, path);
  if (!devices) return refuse_lab(std::move(devices).error(), call);
  lab.devices = *std::move(devices);
  // The text goes into the recording only if it describes the lab.
  if (lab.devices.empty()) lab.text.clear();
  return lab;
}

/// Empty if the system has no name. It becomes a fact of the recording.
std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Some streams have rotations only. Without a skeleton they can be recorded but not shown or
/// aligned.
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

/// Reads the lab's key. The key of the nodes' device counts unless a flag or setting names another.
/// `named`: the device's key of the settings file for the error; empty for a flag.
/// The advice is for reading the key only, and is removed after it.
Result<void> read_key(Call& call, const std::string& path, const std::string& named,
                      RecordingSession::Options& options) {
  call.console.if_it_fails([named](const Error& error) {
    std::vector<std::string> lines = key_advice(error);
    if (!named.empty()) lines.insert(lines.begin(), named);
    return lines;
  });
  options.desk.lab_key = KA_TRY(read_lab_key(call.surroundings.files, path));
  call.console.if_it_fails({});
  return {};
}

Result<void> read_skeleton(Call& call, const DeviceOptions& device, const std::string& named,
                           RecordingSession::Options& options) {
  // The error is about the BVH; the advice tells where it is named.
  call.console.if_it_fails([named](const Error&) { return std::vector<std::string>{named}; });
  options.skeletons[device.name] = KA_TRY(read_bvh_head(call.surroundings.files, device.skeleton));
  call.console.if_it_fails({});
  return {};
}

/// Reads the files that the devices need besides lab.toml.
Result<void> read_files(const RecordJob& job, Call& call, RecordingSession::Options& options) {
  const LabSources sources = sources_of(job, call);
  // A flag or setting wins over the devices' own keys.
  if (!job.lab_key.empty()) KA_TRY(read_key(call, job.lab_key, "", options));
  for (const DeviceOptions& device : options.lab.devices) {
    if (!device.lab_key.empty() && job.lab_key.empty()) {
      KA_TRY(read_key(call, device.lab_key, named_by("lab_key", device, sources), options));
    }
    if (!device.skeleton.empty()) {
      KA_TRY(read_skeleton(call, device, named_by("skeleton", device, sources), options));
    } else if (needs_skeleton(device)) {
      // Recording goes on: a skeleton can still be given to `align`.
      call.console.note(without_skeleton(device.name));
    }
  }
  return {};
}

std::optional<std::uint16_t> port_of(const std::optional<std::int64_t>& port) {
  return port ? std::optional(static_cast<std::uint16_t>(*port)) : std::nullopt;
}

}  // namespace

Result<Lab> lab_of(const RecordJob& job, std::vector<DeviceOptions> in_file) {
  Lab lab{std::move(in_file), job.options};
  std::set<std::string> named;
  // A flag names each device once. A device of the file may be changed by one flag.
  for (const std::string& text : job.devices) {
    const auto device = parse_device(text);
    if (!device) {
      return Failure(Error{"--device", 0, device.error().expected, device.error().found});
    }
    if (!named.insert(device->name).second) {
      return Failure(
          Error{"--device", 0, "devices of different names", shown(device->name) + " twice"});
    }
    // set_device() changes the device of that name, or adds it.
    set_device(lab, *device);
  }
  KA_TRY(validate(lab));
  KA_TRY(check_mark_ports(lab, job.marks_port, job.trigger_port));
  return lab;
}

LabSources sources_of(const RecordJob& job, const Call& call) {
  LabSources sources{project_settings(call.surroundings, call.common.config), {}};
  for (const std::string& text : job.devices)
    // parse_device() has accepted these texts before, so each has a '='.
    sources.by_flag.insert(text.substr(0, text.find('=')));
  return sources;
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
  // Nothing could ever start the take.
  if (job.wait && !job.marks_port && !job.trigger_port && ::isatty(STDIN_FILENO) == 0) {
    return call.console.refuse(
        Error{"--wait", 0, "--marks-port, --trigger-port or a keyboard for the start", "none"});
  }
  options.lab_toml = std::move(file.text);
  options.marks_port = port_of(job.marks_port);
  options.trigger_port = port_of(job.trigger_port);
  options.live_port = port_of(job.live_port);
  options.host = host_name();
  // The secret is new for each run.
  options.desk.secret = KA_TRY(new_secret());
  KA_TRY(read_files(job, call, options));
  return options;
}

}  // namespace kinalign
