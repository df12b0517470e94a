// SPDX-License-Identifier: Apache-2.0
// A step of training of two bidirectional LSTM layers, beside the matrix product of the same
// library in the same run, on one thread. Arguments of Google Benchmark.
#include "kinalign/learn/torch_network.h"

#include <benchmark/benchmark.h>

namespace kinalign {

namespace {

constexpr std::int64_t batch = 32, frames = 64;

void rate(benchmark::State& state, double operations) {
  state.counters["GFLOP/s"] = benchmark::Counter(1e-9 * operations * double(state.iterations()),
                                                 benchmark::Counter::kIsRate);
}

void matrix_product(benchmark::State& state) {
  torch::set_num_threads(1);
  torch::NoGradGuard guard;
  const std::int64_t n = state.range(0);
  const auto a = torch::randn({n, n}), b = torch::randn({n, n});
  for (auto run : state) benchmark::DoNotOptimize(torch::mm(a, b).data_ptr<float>());
  rate(state, 2.0 * double(n) * double(n) * double(n));
}

void recurrent_step(benchmark::State& state) {
  torch::set_num_threads(1);
  torch::manual_seed(1);
  const std::int64_t units = state.range(0);
  const Layer recurrent{
      .kind = LayerKind::lstm, .out = static_cast<std::size_t>(units), .bidirectional = true};
  TorchNetwork network({static_cast<std::size_t>(units), {recurrent, recurrent}});
  const auto input = torch::randn({batch, frames, units});
  for (auto run : state) {
    for (auto& [name, tensor] : network.tensors()) tensor.mutable_grad().reset();
    network.forward(input, true).pow(2).mean().backward();
  }
  // Multiplications and additions, forward, and backward for the values and for the weights. Each
  // layer reads its input and its own last state, in both directions.
  const double weights = 2.0 * 4.0 * double(units) * (double(units + units) + double(3 * units));
  rate(state, 3.0 * 2.0 * weights * double(batch * frames));
}

BENCHMARK(matrix_product)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(recurrent_step)->Arg(192)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace kinalign
