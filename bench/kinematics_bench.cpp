// SPDX-License-Identifier: Apache-2.0
// Channels of 59 joints (x y z m, then angles about y, x, z in degrees) to local quaternions and
// world positions, in blocks of frames, against Eigen joint by joint as commonly written.
#include "kinalign/motion/kinematics.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::size_t frames = 20480, joints = 59, channels = 6 * joints, block = 256;

/// The hands, spine and legs of Perception Neuron's skeleton.
Skeleton neuron() {
  Skeleton s;
  const auto add = [&](int parent) {
    s.parents.push_back(parent);
    return static_cast<int>(s.parents.size()) - 1;
  };
  const auto limb = [&](int parent, int n) {
    for (; n > 0; --n) parent = add(parent);
    return parent;
  };
  const int hips = add(-1);
  limb(hips, 3);
  limb(hips, 3);
  const int spine = limb(hips, 4);
  limb(spine, 2);
  for (int side = 0; side < 2; ++side) {
    const int hand = limb(spine, 4);
    limb(hand, 3);
    for (int finger = 0; finger < 4; ++finger) limb(hand, 4);
  }
  s.rest_offsets.assign(s.parents.size(), Vec3::Zero());
  return s;
}

struct Data {
  Skeleton skeleton = neuron();
  std::vector<double> values = std::vector<double>(frames * channels);
  std::unique_ptr<double[]> memory;
  std::span<double> positions, rotations;  // [frames, joints, 3 and 4]

  /// Allocates memory that was not touched before, as for a whole file's results.
  void renew() {
    constexpr std::size_t cells = frames * joints;
    memory.reset(new double[7 * cells]);
    positions = {memory.get(), 3 * cells};
    rotations = {memory.get() + 3 * cells, 4 * cells};
  }

  Data() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-30, 30);
    for (auto& v : values) v = uniform(random);
  }
};

void by_eigen(Data& d) {
  const auto about = [](double degrees, const Vec3& axis) {
    return Eigen::AngleAxisd(degrees * (std::numbers::pi / 180.0), axis);
  };
  std::vector<Eigen::Isometry3d> world(joints);
  for (std::size_t i = 0; i < frames * joints; ++i) {
    const double* c = &d.values[6 * i];
    const std::size_t j = i % joints;
    const Quat q =
        about(c[3], Vec3::UnitY()) * about(c[4], Vec3::UnitX()) * about(c[5], Vec3::UnitZ());
    const Eigen::Isometry3d local = Eigen::Translation3d(c[0], c[1], c[2]) * q;
    const int parent = d.skeleton.parents[j];
    world[j] = parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local;
    vec3(d.positions, i) = world[j].translation();
    put_quat(d.rotations, i, q);
  }
}

void turn_some(const double* values, double* rotations) {
  for (std::size_t j = 0; j < joints; ++j) {
    const double* angle = values + 6 * j + 3;
    rotations_from_euler({1, 0, 2},
                         {{angle, angle + 1, angle + 2}, channels, rotations + 4 * j, 4 * joints},
                         euler_frames);
  }
}

void by_kinalign(Data& d, ClipFrames& part) {
  for (std::size_t first = 0; first < frames; first += block) {
    for (std::size_t some = 0; some < block; some += euler_frames) {
      turn_some(&d.values[(first + some) * channels], &part.local_rotations[some * joints * 4]);
    }
    for (std::size_t i = 0; i < block * joints; ++i) {
      vec3(part.local_positions, i) = Eigen::Map<const Vec3>(&d.values[first * channels + 6 * i]);
    }
    forward_kinematics(d.skeleton, part,
                       d.positions.subspan(first * joints * 3, block * joints * 3));
    std::copy(part.local_rotations.begin(), part.local_rotations.end(),
              d.rotations.begin() + static_cast<std::ptrdiff_t>(first * joints * 4));
  }
}

ClipFrames empty_block() {
  ClipFrames part;
  part.stamps.resize(block);
  part.local_positions.resize(block * joints * 3);
  part.local_rotations.resize(block * joints * 4);
  return part;
}

/// Checks once before timing that both give the same positions.
void check() {
  Data ours, theirs;
  ClipFrames part = empty_block();
  ours.renew();
  theirs.renew();
  by_kinalign(ours, part);
  by_eigen(theirs);
  for (std::size_t i = 0; i < ours.positions.size(); ++i) {
    if (!(std::abs(ours.positions[i] - theirs.positions[i]) <= 1e-10)) std::abort();
  }
}

enum class Memory { used, fresh };

template <Memory memory>
void kinalign_way(benchmark::State& state) {
  check();
  Data data;
  data.renew();
  ClipFrames part = empty_block();
  for (auto _ : state) {
    if (memory == Memory::fresh) data.renew();
    by_kinalign(data, part);
    benchmark::DoNotOptimize(data.positions.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames * joints));
}

void eigen_way(benchmark::State& state) {
  Data data;
  data.renew();
  for (auto _ : state) {
    by_eigen(data);
    benchmark::DoNotOptimize(data.positions.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames * joints));
}

/// Reads and writes the same bytes without the computation.
void traffic(benchmark::State& state) {
  Data data;
  double total = 0.0;
  for (auto _ : state) {
    data.renew();
    const Eigen::Map<const Eigen::VectorXd> values(data.values.data(),
                                                   static_cast<Eigen::Index>(data.values.size()));
    total += values.sum();
    std::fill(data.positions.begin(), data.positions.end(), total);
    std::fill(data.rotations.begin(), data.rotations.end(), total);
    benchmark::DoNotOptimize(data.positions.data());
    benchmark::DoNotOptimize(data.rotations.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames * joints));
}

BENCHMARK(eigen_way)->Name("kinematics/eigen")->Unit(benchmark::kMillisecond);
BENCHMARK(kinalign_way<Memory::used>)->Name("kinematics/kinalign")->Unit(benchmark::kMillisecond);
BENCHMARK(traffic)->Name("kinematics_fresh/traffic")->Unit(benchmark::kMillisecond);
BENCHMARK(kinalign_way<Memory::fresh>)
    ->Name("kinematics_fresh/kinalign")
    ->Unit(benchmark::kMillisecond);

}  // namespace
