// SPDX-License-Identifier: Apache-2.0
// The models that come with the program, on 30 s of any motion: whole sequences, and live, frame by
// frame, as --live runs them. Arguments of Google Benchmark.
#include "kinalign/models/live/live_cleaner.h"
#include "kinalign/models/live/live_fuser.h"
#include "kinalign/models/pose/window_solver.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace kinalign {

namespace {

constexpr std::size_t frames = 900;
constexpr std::size_t filling = 150;   // frames after which every window is full
constexpr std::size_t look_ahead = 2;  // the default of --live

std::string bytes_of(const std::string& name) {
  std::ifstream in(KINALIGN_MODELS "/" + name + ".safetensors", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

float wave(std::size_t i) { return 0.3F * std::sin(0.37F * static_cast<float>(i)); }

JointFrames any_joints(std::size_t joints, std::size_t count, std::size_t first = 0) {
  JointFrames out{joints, {}, std::vector<std::uint8_t>(count * joints, 2)};
  for (std::size_t i = 0; i < 3 * count * joints; ++i)
    out.positions.push_back(wave(first + i) + 0.9F);
  return out;
}

NodeFrames any_nodes(std::size_t nodes, std::size_t count, std::size_t first = 0) {
  NodeFrames out;
  out.nodes = nodes;
  for (std::size_t i = first; i < first + count * nodes; ++i) {
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

FuseInput any_both(const FuseModel& model, std::size_t count, std::size_t first = 0) {
  return {any_nodes(model.layout.nodes.nodes.size(), count, first),
          any_joints(model.layout.joints.size(), count, first)};
}

/// Counts how many times faster than real time a clip at 30 Hz is processed.
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

double thread_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Measures the time within which half of the frames, and 99 of 100, are done. `input(t)` makes
/// frame t, which `push(frame)` takes.
template <class Input, class Push>
void time_frames(benchmark::State& state, const Input& input, const Push& push) {
  std::size_t t = 0;
  while (t < filling) push(input(t++));
  std::vector<double> took;
  for (auto _ : state) {
    const auto frame = input(t++);
    const double before = thread_ms();
    push(frame);
    took.push_back(thread_ms() - before);
  }
  std::sort(took.begin(), took.end());
  state.counters["p50_ms"] = took[took.size() / 2];
  state.counters["p99_ms"] = took[took.size() * 99 / 100];
}

void denoise_live(benchmark::State& state) {
  auto denoiser = Denoiser::make(*read_denoise_model(bytes_of("denoise"), "denoise"));
  LiveCleaner cleaner(*denoiser, look_ahead);
  const std::size_t joints = denoiser->model().layout.inputs.size();
  time_frames(
      state, [&](std::size_t t) { return any_joints(joints, 1, t); },
      [&](const JointFrames& frame) { benchmark::DoNotOptimize(cleaner.step(frame)); });
}
BENCHMARK(denoise_live)->Unit(benchmark::kMillisecond)->Iterations(frames);

void pose_live(benchmark::State& state) {
  const auto solver = PoseSolver::make(*read_pose_model(bytes_of("pose"), "pose"));
  WindowSolver window(*solver, look_ahead);
  const std::size_t nodes = solver->model().layout.nodes.size();
  time_frames(
      state, [&](std::size_t t) { return any_nodes(nodes, 1, t); },
      [&](const NodeFrames& frame) { benchmark::DoNotOptimize(window.step(frame, 0)); });
}
BENCHMARK(pose_live)->Unit(benchmark::kMillisecond)->Iterations(frames);

void fuse_live(benchmark::State& state) {
  auto fuser = Fuser::make(*read_fuse_model(bytes_of("fuse"), "fuse"));
  LiveFuser live(*fuser, look_ahead);
  std::vector<FusedFramePose> poses;
  time_frames(
      state, [&](std::size_t t) { return any_both(fuser->model(), 1, t); },
      [&](const FuseInput& frame) {
        poses.clear();
        live.add(frame);
        live.answer(poses);
      });
  if (poses.size() != 1) state.SkipWithError("no pose");
}
BENCHMARK(fuse_live)->Unit(benchmark::kMillisecond)->Iterations(frames);

}  // namespace

}  // namespace kinalign
