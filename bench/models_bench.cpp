// SPDX-License-Identifier: Apache-2.0
// The models that come with the program, on 30 s of any motion: whole sequences, and frame by frame
// with the same networks made causal. Arguments of Google Benchmark.
#include "kinalign/infer/online.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/pose/pose_model.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

namespace {

constexpr std::size_t frames = 900;

std::string bytes_of(const std::string& name) {
  std::ifstream in(KINALIGN_MODELS "/" + name + ".safetensors", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void make_causal(std::vector<Layer>& layers) {
  for (Layer& layer : layers) {
    if (layer.kind == LayerKind::conv) layer.causal = true;
    for (auto& branch : layer.branches) make_causal(branch);
  }
}

float wave(std::size_t i) { return 0.3F * std::sin(0.37F * static_cast<float>(i)); }

JointFrames any_joints(std::size_t joints, std::size_t count) {
  JointFrames out{joints, {}, std::vector<std::uint8_t>(count * joints, 2)};
  for (std::size_t i = 0; i < 3 * count * joints; ++i) out.positions.push_back(wave(i) + 0.9F);
  return out;
}

NodeFrames any_nodes(std::size_t nodes, std::size_t count) {
  NodeFrames out;
  out.nodes = nodes;
  for (std::size_t i = 0; i < count * nodes; ++i) {
    const Eigen::Quaternionf q(Eigen::AngleAxisf(wave(i), Eigen::Vector3f::UnitY()));
    out.orientation.insert(out.orientation.end(), {q.w(), q.x(), q.y(), q.z()});
    for (std::size_t k = 0; k < 3; ++k) {
      out.acceleration.push_back(wave(3 * i + k));
      out.angular_velocity.push_back(wave(5 * i + k));
    }
    out.valid.push_back(1);
  }
  return out;
}

FuseInput any_both(const FuseModel& model, std::size_t count) {
  return {any_nodes(model.layout.nodes.nodes.size(), count),
          any_joints(model.layout.joints.size(), count)};
}

/// Times real time, of a clip at 30 Hz.
void count_frames(benchmark::State& state, std::size_t count) {
  state.counters["x_real_time"] = benchmark::Counter(static_cast<double>(count) / 30.0,
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

void denoise_whole(benchmark::State& state) {
  auto denoiser = Denoiser::make(*read_denoise_model(bytes_of("denoise"), "denoise"));
  const JointFrames body = any_joints(denoiser->model().layout.inputs.size(), frames);
  for (auto _ : state) benchmark::DoNotOptimize(denoiser->clean(body));
  count_frames(state, frames);
}
BENCHMARK(denoise_whole)->Unit(benchmark::kMillisecond);

void pose_whole(benchmark::State& state) {
  auto solver = PoseSolver::make(*read_pose_model(bytes_of("pose"), "pose"));
  const NodeFrames nodes = any_nodes(solver->model().layout.nodes.size(), frames);
  for (auto _ : state) benchmark::DoNotOptimize(solver->solve(nodes));
  count_frames(state, frames);
}
BENCHMARK(pose_whole)->Unit(benchmark::kMillisecond);

void fuse_whole(benchmark::State& state) {
  auto fuser = Fuser::make(*read_fuse_model(bytes_of("fuse"), "fuse"));
  const FuseInput input = any_both(fuser->model(), frames);
  for (auto _ : state) benchmark::DoNotOptimize(fuser->solve(input));
  count_frames(state, frames);
}
BENCHMARK(fuse_whole)->Unit(benchmark::kMillisecond);

/// The network alone: live, whole windows are cleaned.
void denoise_network_online(benchmark::State& state) {
  DenoiseModel model = *read_denoise_model(bytes_of("denoise"), "denoise");
  make_causal(model.architecture.layers);
  const auto network = Network::make(model.architecture, model.tensors, "net.");
  auto online = OnlineNetwork::make(*network);
  std::vector<float> frame(model.layout.channels());
  for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = wave(i);
  for (auto _ : state) benchmark::DoNotOptimize(online->step(frame).data());
}
BENCHMARK(denoise_network_online)->Unit(benchmark::kMicrosecond);

void pose_online(benchmark::State& state) {
  PoseModel model = *read_pose_model(bytes_of("pose"), "pose");
  make_causal(model.architecture.layers);
  const auto solver = PoseSolver::make(std::move(model));
  auto online = OnlinePoseSolver::make(*solver);
  const NodeFrames nodes = any_nodes(solver->model().layout.nodes.size(), frames);
  std::size_t t = 0;
  for (auto _ : state) benchmark::DoNotOptimize(online->step(nodes, t++ % frames).data());
}
BENCHMARK(pose_online)->Unit(benchmark::kMicrosecond);

void fuse_online(benchmark::State& state) {
  FuseModel model = *read_fuse_model(bytes_of("fuse"), "fuse");
  make_causal(model.architecture.layers);
  const auto fuser = Fuser::make(std::move(model));
  auto online = OnlineFuser::make(*fuser);
  const FuseInput input = any_both(fuser->model(), 1);
  for (auto _ : state) benchmark::DoNotOptimize(online->step(input).data());
}
BENCHMARK(fuse_online)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace kinalign
