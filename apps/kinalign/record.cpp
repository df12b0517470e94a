// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/json_text.h"
#include "apps/kinalign/key_advice.h"
#include "apps/kinalign/settings.h"
#include "apps/kinalign/summary.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/capture/node_keys.h"
#include "kinalign/capture/recording_session.h"
#include "kinalign/io/bvh_head.h"
#include "kinalign/io/lab_toml.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

struct Record {
  std::string subject, action;
  std::vector<std::string> devices;
  std::string lab_key;
  std::optional<double> seconds;
  RecordOptions options;
};

/// What --device says, over the devices of a lab.toml.
Result<Lab> lab_of(const Record& o, std::vector<DeviceOptions> in_file) {
  Lab lab{std::move(in_file), o.options};
  for (const std::string& text : o.devices) {
    const auto device = parse_device(text);
    if (!device) {
      return Failure(Error{"--device", 0, device.error().expected, device.error().found});
    }
    come_from(lab, *device);
  }
  KA_TRY(validate(lab));
  return lab;
}

/// A file of settings that says which devices there are; of others nothing.
struct LabFile {
  std::string text;
  std::vector<DeviceOptions> devices;
};
Result<LabFile> read_lab_file(const Call& call) {
  constexpr std::size_t most_bytes = std::size_t{1} << 20;
  const std::string path = project_settings(call.surroundings, call.common.config);
  if (path.empty()) return LabFile{};
  LabFile lab{KA_TRY(read_whole(call.surroundings.files, path, most_bytes)), {}};
  lab.devices = KA_TRY(read_devices(lab.text, path));
  if (lab.devices.empty()) lab.text.clear();
  return lab;
}

Usage describe_record(Record& o) {
  Usage usage;
  usage.flags = {
      {"device", "NAME=PROTOCOL[:TRANSPORT[:ADDRESS]]:PORT, as in imu=nodes:5005; may be repeated",
       &o.devices},
      {"subject", "who moves: part of the file's name", &o.subject},
      {"action", "what they do: part of the file's name", &o.action},
      {"seconds", "end by itself after so long", &o.seconds, 0.0, 1e6}};
  usage.settings = {{"lab_key", "file of the key that the nodes' keys come from", &o.lab_key}};
  for (const Field& field : describe(o.options)) usage.settings.push_back(field);
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    if (common.out.empty()) return Failure(Error{"--out", 0, "a folder for the files", "none"});
    KA_TRY(lab_of(o, {}));
    return {};
  };
  return usage;
}

/// What of a text may stand in a file's name.
std::string in_name(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    out += plain || c == '-' ? c : '-';
  }
  return out;
}

/// FOLDER/SUBJECT_ACTION_01.mcap, with the next number that is free.
std::string free_path(const std::string& folder, const Record& o) {
  std::string name;
  for (const std::string& part : {o.subject, o.action}) {
    if (!part.empty()) name += in_name(part) + "_";
  }
  if (name.empty()) name = "take_";
  for (int run = 1;; ++run) {
    std::string path = fmt::format("{}/{}{:02}.mcap", folder, name, run);
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) return path;
  }
}

Result<void> make_folder(const std::string& folder) {
  struct stat status {};
  if (::mkdir(folder.c_str(), 0755) == 0) return {};
  if (errno == EEXIST && ::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) return {};
  return Failure(Error{folder, 0, "a folder for the files", std::strerror(errno)});
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

Json json_of(const StreamStatus& stream, HostTime now) {
  Json json = Json::parse(to_json(stream.stream, stream.sender, stream.node, stream.counts));
  json["rate_hz"] = stream.rate_hz;
  json["silent_s"] = seconds(now - stream.heard);
  return json;
}

/// "mocap from 192.168.7.5:51234: 7,500 messages, 11.1 MB; 3 frames lost"
std::string line_of(const StreamStatus& stream) {
  const SenderCounts& counts = stream.counts;
  std::string line =
      fmt::format("  {} from {}: {} messages, {:.1f} MB", stream.stream, stream.sender,
                  grouped(counts.messages), static_cast<double>(counts.bytes) / 1e6);
  std::string_view between = "; ";
  for (const auto& [count, what] :
       {std::pair(counts.order.lost, "lost"), std::pair(counts.order.late, "late"),
        std::pair(counts.order.duplicates, "twice"), std::pair(counts.refused, "refused")}) {
    if (count == 0) continue;
    line += fmt::format("{}{} {}", between, grouped(count), what);
    between = ", ";
  }
  return line + "\n";
}

/// Says what happens while a take lasts.
class RecordHerald {
 public:
  RecordHerald(RecordingSession& session, Console& console)
      : session_(session), console_(console), progress_(console.progress()) {}

  void tell_start(const std::string& path) {
    Json event{{"event", "started"}, {"file", path}};
    std::string heard;
    for (const auto& [name, port] : session_.ports()) {
      event["ports"][name] = port;
      heard += fmt::format("{}{} on port {}", heard.empty() ? "" : ", ", name, port);
    }
    console_.print(harmless(fmt::format("recording to {}\n  {}\n", path, heard)));
    console_.print_json(json_text(event));
    console_.flush();
  }

  /// Whether to go on. Asked after each datagram, it looks ten times a second.
  bool operator()() {
    const HostTime now = session_.now();
    if (now < next_look_) return !interrupted();
    next_look_ = now + 100ms;
    for (const PartFailure& failure : session_.take_disk_failures()) tell(failure);
    const DiskStatus disk = *session_.disk();
    std::uint64_t messages = 0;
    for (const StreamStatus& stream : session_.streams()) messages += stream.counts.messages;
    if (now >= next_status_) {
      next_status_ = now + 1s;
      tell_status(now, disk);
    }
    return progress_(fmt::format("recording: {} messages, {:.1f} MB", grouped(messages),
                                 static_cast<double>(disk.bytes) / 1e6),
                     0, 0);
  }

  void tell_end() {
    for (const PartFailure& failure : session_.take_disk_failures()) tell(failure);
    const DiskStatus disk = *session_.disk();
    Json event{{"event", "stopped"},
               {"files", disk.paths},
               {"bytes", disk.bytes},
               {"dropped", disk.dropped}};
    std::string lines;
    for (const StreamStatus& stream : session_.streams()) {
      event["streams"].push_back(json_of(stream, session_.now()));
      lines += line_of(stream);
    }
    std::string files;
    for (const std::string& path : disk.paths) files.append(path).append("\n");
    console_.print(harmless(files.append(lines)));
    console_.print_json(json_text(event));
  }

 private:
  void tell(const PartFailure& failure) {
    console_.complain(harmless(fmt::format(
        "kinalign record: {}: {}\n", to_string(failure.why),
        failure.next.empty() ? "kept in memory and tried again" : "goes on in " + failure.next)));
    console_.print_json(json_text(Json{
        {"event", "disk_failed"}, {"what", to_string(failure.why)}, {"goes_on_in", failure.next}}));
  }
  void tell_status(HostTime now, const DiskStatus& disk) {
    Json event{{"event", "status"}, {"bytes", disk.bytes}, {"waiting_bytes", disk.waiting_bytes}};
    event["streams"] = Json::array();
    for (const StreamStatus& stream : session_.streams()) {
      event["streams"].push_back(json_of(stream, now));
    }
    console_.print_json(json_text(event));
    console_.flush();
  }

  RecordingSession& session_;
  Console& console_;
  Progress progress_;
  HostTime next_look_ = HostTime::min(), next_status_ = HostTime::min();
};

/// The files that the devices need beside lab.toml.
Result<void> read_files(const Record& o, Call& call, RecordingSession::Options& options) {
  FileSystem& files = call.surroundings.files;
  std::string lab_key = o.lab_key;
  for (const DeviceOptions& device : options.lab.devices) {
    if (lab_key.empty()) lab_key = device.lab_key;
    if (device.skeleton.empty()) continue;
    options.skeletons[device.name] = KA_TRY(read_bvh_head(files, device.skeleton));
  }
  if (lab_key.empty()) return {};
  call.console.if_it_fails(key_advice);
  options.desk.lab_key = KA_TRY(read_lab_key(files, lab_key));
  call.console.if_it_fails({});
  return {};
}

Result<RecordingSession::Options> session_options(const Record& o, Call& call) {
  auto file = read_lab_file(call);
  if (!file) return call.console.refuse(std::move(file).error());
  RecordingSession::Options options;
  auto lab = lab_of(o, std::move(file->devices));
  if (!lab) return call.console.refuse(std::move(lab).error());
  options.lab = *std::move(lab);
  if (options.lab.devices.empty()) {
    return call.console.refuse(
        Error{"--device", 0, "at least one device, or a lab.toml for --config", "none"});
  }
  options.lab_toml = std::move(file->text);
  options.host = host_name();
  options.desk.secret = KA_TRY(new_secret());
  KA_TRY(read_files(o, call, options));
  return options;
}

/// Until somebody or --seconds ends it, and all is on the disk.
void serve(RecordingSession& session, RecordHerald& herald, std::optional<double> most_s) {
  const HostTime begun = session.now();
  while (herald() && !(most_s && seconds(session.now() - begun) >= *most_s)) session.turn(50ms);
  session.stop();
  while (!session.disk()->finished) std::this_thread::sleep_for(5ms);
}

Result<int> run(Record& o, Call& call) {
  Console& console = call.console;
  console.never_wait();
  take_signals();
  RecordingSession::Options options = KA_TRY(session_options(o, call));
  KA_TRY(make_folder(call.common.out));
  SystemClocks ports_clock, nodes_clock;
  const auto session = KA_TRY(RecordingSession::open(
      std::move(options), {call.surroundings.files, ports_clock, nodes_clock}));
  const std::string path = free_path(call.common.out, o);
  KA_TRY(session->start(path, o.subject, o.action));
  RecordHerald herald(*session, console);
  herald.tell_start(path);
  serve(*session, herald, o.seconds);
  herald.tell_end();
  const DiskStatus disk = *session->disk();
  if (disk.refused) return Failure(*disk.refused);
  return disk.dropped > 0 || disk.paths.size() > 1 ? 1 : 0;
}

}  // namespace

Verb record_verb() {
  return make_verb<Record>(
      {.name = "record",
       .summary = "devices into a recording, nothing lost",
       .text = "Receives, stamps and stores until Ctrl-C what devices send. The file (MCAP) is "
               "whole up to the last quarter of a second at any time, whatever becomes of the "
               "program; no file is ever overwritten. Protocols: nodes, noitom, xsens, kinect, "
               "slimevr; transports: udp, tcp (to the device's address), tcp-listen. Exit code 1 "
               "where the disk failed and the recording went on in another file.",
       .examples =
           {{"kinalign record -o takes --device imu=nodes:5005 --device mocap=noitom:udp:7012",
             "inertial nodes, and Axis Studio sending to this machine"},
            {"kinalign record -o takes --subject 03 --action S1A02 --device "
             "mocap=noitom:tcp:192.168.7.5:7001",
             "Axis Neuron serving; takes/03_S1A02_01.mcap"},
            {"kinalign record -o takes --config lab.toml",
             "the devices of a lab: docs/recording.md"}},
       .common = {"out", "json"},
       .out_is_folder = true},
      describe_record, run);
}

}  // namespace kinalign
