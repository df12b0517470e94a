// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/simulate_folder.h"

#include "kinalign/documents/manifest_toml.h"
#include "kinalign/documents/truth_json.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/stream_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double motion_rate_hz = 120.0;
constexpr int bvh_decimals = 6;
// If stamps are by arrival, the samples pass over this link. The manifest states the link's mean
// delay, as a user would measure it.
constexpr Link arrival_link = Link::paper;
constexpr double arrival_delay_ms = 33.2;  // the link's mean delay (docs/simulated_links.md)

/// Writes a motion as BVH, a block of frames at a time: the numbers of an hour take a gigabyte of
/// memory.
Result<void> write_clip(const RehearsalFolder& folder, const std::string& name,
                        const Motion& motion, const MocapRun& run) {
  constexpr std::size_t block = 1024;
  OutputFile out =
      KA_TRY(OutputFile::create(folder.files, folder.path + "/" + name, Overwrite::no));
  // Every joint has position channels.
  const BvhChannels channels(motion.skeleton, BvhChannels::Positions::of_all);
  BvhHierarchy hierarchy = channels.hierarchy(run.frames, 1.0 / run.rate_hz);
  // With nine decimals of the frame time, the time of the last frame of an hour is right within 0.1
  // ms.
  hierarchy.frame_time = fmt::format("{:.9f}", 1.0 / run.rate_hz);
  BvhWriter writer(hierarchy, run.frames, bvh_decimals,
                   [&](std::string_view text) { return out.write(text); });
  for (std::size_t begin = 0; begin < run.frames; begin += block) {
    const ClipFrames frames =
        mocap_frames(motion, run, begin, std::min(begin + block, run.frames), Time{});
    std::vector<double> rows;
    channels.append(frames.local_positions, frames.local_rotations, rows);
    KA_TRY(writer.append(rows));
  }
  KA_TRY(writer.finish());
  return out.commit();
}

Result<void> write_text(const RehearsalFolder& folder, const std::string& name,
                        std::string_view text) {
  return write_whole(folder.files, folder.path + "/" + name, text, Overwrite::no);
}

/// Opens a text file for a table. The caller completes the file after the last row.
Result<TextOut> table(const RehearsalFolder& folder, const std::string& name) {
  return TextOut::create(folder.files, folder.path + "/" + name, Overwrite::no);
}

std::string node_file_name(const std::string& node) { return "imu_" + node + ".csv"; }

/// The largest error of a device's clock after `length_s` seconds, in ms, rounded up to hundredths.
double interval_ms(double length_s) {
  // 1e5 turns seconds into hundredths of a millisecond. 1e-5 s is the error at the start. 1e-6
  // keeps exact values from being rounded up.
  return std::ceil(1e5 * (most_drift * length_s + 1e-5) - 1e-6) / 100.0;
}

StreamOptions stream_of(std::string name, std::vector<StreamFile> files) {
  StreamOptions stream;
  stream.name = std::move(name);
  stream.files = std::move(files);
  return stream;
}

/// The manifest with which `align` aligns the files. The simulation knows the clicks, the errors of
/// the clocks and the mean delay.
Manifest manifest_of(const TrueRecording& truth, const DeviceChoice& devices) {
  Manifest manifest;
  manifest.subject = fmt::format("simulated_{}", truth.seed);
  manifest.action = truth.motion;
  // The frames of the take have the times of the suit's frames.
  manifest.align.reference = "mocap";

  StreamOptions mocap = stream_of("mocap", {{"mocap.bvh", ""}});
  mocap.start_ns = truth.mocap.start_click_ns;
  mocap.end_ns = truth.mocap.stop_click_ns;
  mocap.click_latency_ms = std::round(1e5 * click_latency_s) / 100.0;
  // The BVH file has no time of day. Only the user's clicks in the suit's program tell when it was
  // recorded.
  manifest.streams.push_back(mocap);

  if (devices.kinect) {
    StreamOptions kinect = stream_of("kinect", {{"kinect.csv", ""}});
    kinect.interval_ms = interval_ms(truth.length_s);
    manifest.streams.push_back(kinect);
    manifest.spaces["kinect"].method = "fit";
    // `align` fits the Kinect's coordinates to those of the suit.
  }
  if (!devices.nodes) return manifest;

  StreamOptions imu = stream_of("imu", {});
  for (const TrueNode& node : truth.nodes) {
    imu.files.push_back({node_file_name(node.node), node.node});
  }
  imu.root_node = "waist";
  if (devices.stamps == NodeStamps::arrival) {
    // Samples arrive later than they were measured. The offset removes the mean delay.
    imu.offset_ms = -arrival_delay_ms;
  } else {
    imu.interval_ms = interval_ms(truth.length_s);
  }
  manifest.streams.push_back(imu);
  return manifest;
}

/// Writes a file for each node. With stamps by arrival the truth gets these stamps, since the file
/// has no others.
Result<void> write_nodes(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                         NodeStamps stamps, TrueRecording& truth) {
  const Time zero = utc_time(truth.start_ns);
  for (std::size_t n = 0; n < rehearsal.nodes.size(); ++n) {
    const SimulatedNode& node = rehearsal.nodes[n];
    TextOut out = KA_TRY(table(folder, node_file_name(node.mounting.node_name)));
    // Each node gets one file, of one of three kinds.
    if (stamps == NodeStamps::own) {
      KA_TRY(write_node(node_file(node, zero), out));
    } else if (stamps == NodeStamps::received) {
      KA_TRY(write_node(received_node(node, arrival_link, zero), out));
    } else {
      ArrivedNode arrived = arrived_node(node, arrival_link, zero);
      KA_TRY(write_node(arrived.stream, out));
      truth.nodes[n].clock = std::move(arrived.clock);
    }
    KA_TRY(out.commit());
  }
  // The truth names the link only if the link changed the stamps or lost samples.
  if (stamps != NodeStamps::own) truth.link = letter(arrival_link);
  return {};
}

}  // namespace

Result<void> write_motion(const RehearsalFolder& folder, const Motion& motion) {
  MocapRun all{.rate_hz = motion_rate_hz};
  // The last frame is at the end of the motion or just before it. 1e-6 allows for rounding errors.
  all.frames = static_cast<std::size_t>(motion.length_s * motion_rate_hz + 1e-6) + 1;
  return write_clip(folder, "truth/motion.bvh", motion, all);
}

Result<void> write_suit_head(const RehearsalFolder& folder, const Motion& motion) {
  return write_clip(folder, "suit.bvh", motion, {.frames = 1});
}

Result<void> write_lab(const RehearsalFolder& folder, const LiveOptions& options,
                       const Rehearsal& rehearsal) {
  std::string nodes;
  // The ids begin with 1, like the ids in the datagrams.
  for (std::size_t n = 0; n < rehearsal.nodes.size(); ++n) {
    nodes += fmt::format("{}\"{}\" = \"{}\"", n == 0 ? "" : ", ", n + 1,
                         rehearsal.nodes[n].mounting.node_name);
  }
  return write_text(folder, "lab.toml",
                    fmt::format(R"([record]
marks_port = {}

[device.mocap]
protocol = "noitom"
port = {}
skeleton = "suit.bvh"
rate_hz = {}

[device.kinect]
protocol = "kinect"
port = {}

[device.imu]
protocol = "nodes"
port = {}
nodes = {{ {} }}
)",
                                options.marks_port, options.mocap_port, rehearsal.mocap.rate_hz,
                                options.kinect_port, options.node_port, nodes));
}

Result<void> write_live_manifest(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                                 std::optional<double> clockless_hz) {
  const std::string take = live_take_name;
  Manifest manifest;
  manifest.streams = {stream_of("mocap", {{take, ""}}), stream_of("kinect", {{take, ""}}),
                      // One recording contains all three streams, so all three name the same file.
                      stream_of("imu", {})};
  StreamOptions& imu = manifest.streams.back();
  for (const SimulatedNode& node : rehearsal.nodes) {
    imu.files.push_back({take, node.mounting.node_name});
  }
  imu.root_node = "waist";
  imu.rate_hz = clockless_hz.value_or(0.0);
  manifest.spaces["kinect"].method = "fit";
  return write_text(folder, "recording.toml", manifest_toml(manifest));
}

Result<void> write_truth(const RehearsalFolder& folder, const TrueRecording& truth) {
  return write_text(folder, "truth/truth.json", truth_json(truth));
}

Result<void> write_devices(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                           const Motion& motion, const DeviceChoice& devices,
                           TrueRecording& truth) {
  const Time zero = utc_time(truth.start_ns);
  KA_TRY(write_clip(folder, "mocap.bvh", motion, rehearsal.mocap));
  if (devices.kinect) {
    TextOut kinect = KA_TRY(table(folder, "kinect.csv"));
    KA_TRY(write_points(kinect_file(rehearsal, zero), kinect));
    KA_TRY(kinect.commit());
  }
  if (devices.nodes) {
    // The truth must not contain nodes without a file.
    KA_TRY(write_nodes(folder, rehearsal, devices.stamps, truth));
  } else {
    truth.nodes.clear();
  }
  return write_text(folder, "recording.toml", manifest_toml(manifest_of(truth, devices)));
}

}  // namespace kinalign
