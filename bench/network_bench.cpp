// SPDX-License-Identifier: Apache-2.0
// A temporal convolutional network of 0.46 million weights (441 channels in, 4 residual blocks of
// 128 channels, 100 out) over 900 frames and frame by frame, and a step of two GRUs of 256 units,
// against the same sums written with Eigen, which is built for every processor here.
#include "kinalign/infer/network.h"
#include "kinalign/infer/online.h"
#include "kinalign/infer/shapes.h"

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

using namespace kinalign;

namespace {

constexpr std::size_t frames = 900, inputs = 441, channels = 128, blocks = 4, results = 100;
constexpr std::size_t units = 256, node_channels = 48;
constexpr Eigen::Index taps = 5;

using Matrix = Eigen::MatrixXf;  // a frame in each column
using Vector = Eigen::VectorXf;

Layer layer(LayerKind kind, std::size_t out = 0) {
  Layer one;
  one.kind = kind;
  one.out = out;
  return one;
}

Architecture convolutions() {
  Architecture out{inputs, {layer(LayerKind::linear, channels)}};
  for (std::size_t b = 0; b < blocks; ++b) {
    Layer conv = layer(LayerKind::conv, channels);
    conv.kernel = taps;
    conv.dilation = std::size_t{1} << b;
    conv.causal = true;
    Layer block = layer(LayerKind::sum);
    block.branches = {{},
                      {layer(LayerKind::layer_norm), conv, layer(LayerKind::gelu),
                       layer(LayerKind::linear, channels)}};
    out.layers.push_back(block);
  }
  out.layers.push_back(layer(LayerKind::linear, results));
  return out;
}

Architecture recurrent() {
  return {node_channels, {layer(LayerKind::gru, units), layer(LayerKind::gru, units)}};
}

Network network_of(const Architecture& architecture, const Kernels& kernels) {
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal(0.0F, 0.05F);
  std::map<std::string, Tensor> tensors;
  for (const Parameter& parameter : parameters(architecture)) {
    std::size_t n = 1;
    for (const std::size_t size : parameter.shape) n *= size;
    Tensor& tensor = tensors[parameter.name] = {parameter.shape, std::vector<float>(n)};
    for (float& value : tensor.values) value = normal(random);
  }
  auto network = Network::make(architecture, tensors, "", kernels);
  if (!network) {
    std::fprintf(stderr, "%s\n", to_string(network.error()).c_str());
    std::exit(3);
  }
  return *std::move(network);
}

// ---- the same network in Eigen

void activate(Matrix& values) {
  values = values.unaryExpr([](float x) { return 0.5F * x * (1.0F + std::erf(x * 0.70710678F)); });
}

void normalise(const Matrix& in, Matrix& out) {
  out = in.rowwise() - in.colwise().mean();
  const Eigen::RowVectorXf scale =
      (out.colwise().squaredNorm().array() / static_cast<float>(channels) + 1e-5F).rsqrt();
  out = out * scale.asDiagonal();
}

struct EigenConvolutions {
  Matrix stem = Matrix::Random(channels, inputs) * 0.05F;
  Matrix head = Matrix::Random(results, channels) * 0.05F;
  std::vector<Matrix> conv, mix;
  Matrix x, normal, all_taps, hidden, out;
  std::vector<Matrix> rings;
  Eigen::Index row = 0;

  EigenConvolutions() {
    for (std::size_t b = 0; b < blocks; ++b) {
      conv.emplace_back(Matrix::Random(channels, channels * taps) * 0.05F);
      mix.emplace_back(Matrix::Random(channels, channels) * 0.05F);
      rings.emplace_back(Matrix::Zero(channels, (taps - 1) * (Eigen::Index{1} << b) + 1));
    }
  }

  void sequence(const Matrix& in) {
    x.noalias() = stem * in;
    const Eigen::Index n = in.cols(), size = channels;
    for (std::size_t b = 0; b < blocks; ++b) {
      normalise(x, normal);
      all_taps.setZero(size * taps, n);
      for (Eigen::Index k = 0; k < taps; ++k) {
        const Eigen::Index shift = (taps - 1 - k) * (Eigen::Index{1} << b);
        all_taps.block(k * size, shift, size, n - shift) = normal.leftCols(n - shift);
      }
      mix_block(b);
    }
    out.noalias() = head * x;
  }

  void frame(const Vector& in) {
    x.noalias() = stem * in;
    const Eigen::Index size = channels;
    all_taps.resize(size * taps, 1);
    for (std::size_t b = 0; b < blocks; ++b) {
      Matrix& ring = rings[b];
      normalise(x, normal);
      ring.col(row % ring.cols()) = normal;
      for (Eigen::Index k = 0; k < taps; ++k) {
        const Eigen::Index at = row + ring.cols() - (taps - 1 - k) * (Eigen::Index{1} << b);
        all_taps.block(k * size, 0, size, 1) = ring.col(at % ring.cols());
      }
      mix_block(b);
    }
    ++row;
    out.noalias() = head * x;
  }

  void mix_block(std::size_t b) {
    hidden.noalias() = conv[b] * all_taps;
    activate(hidden);
    x.noalias() += mix[b] * hidden;
  }
};

struct EigenGru {
  Matrix from_input, from_state;
  Vector state = Vector::Zero(units), input_sums, state_sums;

  explicit EigenGru(std::size_t in)
      : from_input(Matrix::Random(3 * units, static_cast<Eigen::Index>(in)) * 0.05F),
        from_state(Matrix::Random(3 * units, units) * 0.05F) {}

  const Vector& step(const Vector& in) {
    input_sums.noalias() = from_input * in;
    state_sums.noalias() = from_state * state;
    const Eigen::Index n = units;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto gate = [](float sum) { return 1.0F / (1.0F + std::exp(-sum)); };
      const float r = gate(input_sums[i] + state_sums[i]);
      const float z = gate(input_sums[n + i] + state_sums[n + i]);
      const float next = std::tanh(input_sums[2 * n + i] + r * state_sums[2 * n + i]);
      state[i] = (1.0F - z) * next + z * state[i];
    }
    return state;
  }
};

// ---- the benchmarks; an item is a frame

Matrix random_frames(std::size_t n, std::size_t size) {
  return Matrix::Random(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(n));
}

template <auto kernels>
void sequence(benchmark::State& state) {
  const Network network = network_of(convolutions(), kernels());
  const Matrix in = random_frames(frames, inputs);
  Workspace workspace;
  std::vector<float> out;
  for (auto _ : state) {
    network.run({in.data(), frames * inputs}, frames, workspace, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames));
}

void eigen_sequence(benchmark::State& state) {
  EigenConvolutions network;
  const Matrix in = random_frames(frames, inputs);
  for (auto _ : state) {
    network.sequence(in);
    benchmark::DoNotOptimize(network.out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames));
}

template <auto architecture, auto kernels>
void frame(benchmark::State& state) {
  const Network network = network_of(architecture(), kernels());
  auto online = OnlineNetwork::make(network);
  if (!online) std::exit(3);
  const Matrix in = random_frames(1, network.inputs());
  for (auto _ : state) {
    benchmark::DoNotOptimize(online->step({in.data(), network.inputs()}).data());
  }
  state.SetItemsProcessed(state.iterations());
}

void eigen_frame(benchmark::State& state) {
  EigenConvolutions network;
  const Vector in = random_frames(1, inputs);
  for (auto _ : state) {
    network.frame(in);
    benchmark::DoNotOptimize(network.out.data());
  }
  state.SetItemsProcessed(state.iterations());
}

void eigen_gru(benchmark::State& state) {
  EigenGru first(node_channels), second(units);
  const Vector in = random_frames(1, node_channels);
  for (auto _ : state) benchmark::DoNotOptimize(second.step(first.step(in)).data());
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(sequence<best_kernels>)->Name("network/kinalign")->Unit(benchmark::kMillisecond);
BENCHMARK(sequence<baseline_kernels>)->Name("network/baseline")->Unit(benchmark::kMillisecond);
BENCHMARK(eigen_sequence)->Name("network/eigen")->Unit(benchmark::kMillisecond);
BENCHMARK(frame<convolutions, best_kernels>)->Name("network_frame/kinalign");
BENCHMARK(frame<convolutions, baseline_kernels>)->Name("network_frame/baseline");
BENCHMARK(eigen_frame)->Name("network_frame/eigen");
BENCHMARK(frame<recurrent, best_kernels>)->Name("gru_step/kinalign");
BENCHMARK(frame<recurrent, baseline_kernels>)->Name("gru_step/baseline");
BENCHMARK(eigen_gru)->Name("gru_step/eigen");

}  // namespace
