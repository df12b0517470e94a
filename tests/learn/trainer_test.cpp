// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/trainer.h"

#include "tests/infer/networks.h"

#include "kinalign/learn/checkpoint.h"
#include "kinalign/learn/tensors.h"
#include "kinalign/simulate/random.h"

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

/// Learns y = x W for a given W. Batches follow from seed and step; judgements are given.
class LineTask : public TrainingTask {
 public:
  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override {
    const RandomStream random(seed, step);
    std::vector<float> in(2 * 5 * 3), out;
    for (std::size_t i = 0; i < in.size(); ++i) in[i] = static_cast<float>(random.normal(i, 0));
    for (std::size_t i = 0; i < in.size(); i += 3) out.push_back(in[i] - 2.0F * in[i + 2] + 0.5F);
    const auto answer = network.forward(to_torch(in, {2, 5, 3}), true);
    return (answer - to_torch(out, {2, 5, 1})).pow(2).mean() * scale;
  }
  std::optional<double> judge(const TorchNetwork&) override {
    if (judgements.empty()) return std::nullopt;
    const double out = judgements.front();
    if (judgements.size() > 1) judgements.erase(judgements.begin());
    return out;
  }

  std::vector<double> judgements;
  float scale = 1.0F;
};

TorchNetwork line_network(std::uint64_t seed) {
  torch::manual_seed(seed);
  return TorchNetwork({3, {{.kind = dropout, .rate = 0.1}, layer(linear, 6), layer(linear, 1)}});
}

TrainingState trained(TorchNetwork& network, LineTask& task, const TrainingOptions& options,
                      TrainingState state = {}, const TrainingHooks& hooks = {}) {
  auto out = train(network, task, options, std::move(state), hooks);
  REQUIRE(out);
  return *std::move(out);
}

}  // namespace

TEST_CASE("trainer: the learning rate is that of PyTorch's OneCycleLR") {
  // PyTorch 1.13: OneCycleLR(optimizer, 3e-3, total_steps=1200, pct_start=0.3), before each step
  const TrainingOptions options{.steps = 1200, .rate = 3e-3, .rise = 0.3};
  const std::vector<std::pair<std::int64_t, double>> wanted{{0, 0.00012},
                                                            {1, 0.00012005513667507619},
                                                            {100, 0.0006370700221015788},
                                                            {358, 0.0029999448633249238},
                                                            {359, 0.003},
                                                            {360, 0.002999989509403254},
                                                            {700, 0.0019367731839631697},
                                                            {1198, 2.2490596745838784e-08},
                                                            {1199, 1.2e-08}};
  for (const auto& [step, rate] : wanted) {
    CAPTURE(step);
    CHECK(rate_at(options, step) == doctest::Approx(rate).epsilon(1e-9));
  }
  const std::vector<double> ten{0.00012,
                                0.00156,
                                0.003,
                                0.002851453896040421,
                                0.0024352369618492894,
                                0.0018337860658088677,
                                0.0011662259341911321,
                                0.0005647750381507109,
                                0.00014855810395957884,
                                1.2e-08};
  for (std::int64_t i = 0; i < 10; ++i) {
    CHECK(rate_at({.steps = 10, .rate = 3e-3}, i) ==
          doctest::Approx(ten[static_cast<std::size_t>(i)]).epsilon(1e-9));
  }
  CHECK(std::isfinite(rate_at({.steps = 1}, 0)));
}

TEST_CASE("trainer: a step is AdamW's") {
  // By hand: the first step of Adam moves each weight by the rate, against the gradient's sign.
  // Matrices also lose rate x decay of themselves.
  TorchNetwork network({1, {layer(linear, 1)}});
  {
    torch::NoGradGuard guard;
    network.tensors().at("0.weight").fill_(2.0);
    network.tensors().at("0.bias").fill_(1.0);
  }
  class One : public TrainingTask {
    torch::Tensor loss(const TorchNetwork& n, std::uint64_t, std::uint64_t) override {
      return n.forward(torch::ones({1, 1, 1}), true).sum();
    }
    std::optional<double> judge(const TorchNetwork&) override { return std::nullopt; }
  } task;
  const TrainingOptions options{.steps = 1, .rate = 0.1, .weight_decay = 0.5, .average = false};
  REQUIRE(train(network, task, options, {}, {}));
  const double rate = 0.1 / 25.0;
  CHECK(network.tensors().at("0.weight").item<double>() ==
        doctest::Approx(2.0 * (1.0 - rate * 0.5) - rate).epsilon(1e-6));
  CHECK(network.tensors().at("0.bias").item<double>() == doctest::Approx(1.0 - rate).epsilon(1e-6));
}

TEST_CASE("trainer: it learns") {
  LineTask task;
  TorchNetwork network = line_network(1);
  const auto state = trained(network, task, {.steps = 300, .rate = 3e-2, .average = false});
  CHECK(state.step == 300);
  CHECK(state.points.size() == 6);
  CHECK(state.points.back().loss < 0.3 * state.points.front().loss);
}

TEST_CASE("trainer: some steps, a checkpoint and the rest give the bytes of all steps at once") {
  const TrainingOptions options{.steps = 300, .rate = 1e-2, .judge_every = 60, .seed = 9};
  const auto run = [&](TrainingState from, std::string* kept) {
    LineTask task;
    task.judgements = {3.0, 2.0, 2.5, 1.0, 1.5};
    if (from.step > 0) task.judgements.erase(task.judgements.begin(), task.judgements.begin() + 2);
    TorchNetwork network = line_network(from.step > 0 ? 77 : 1);
    TrainingHooks hooks{.progress = {}, .keep = {}, .every = 150};
    hooks.keep = [&](const TrainingState& state) -> Result<void> {
      if (kept != nullptr && kept->empty()) *kept = write_checkpoint(state, "job");
      return {};
    };
    return trained(network, task, options, std::move(from), hooks);
  };
  std::string half;
  const auto whole_run = run({}, &half);
  REQUIRE_FALSE(half.empty());
  auto from = read_checkpoint(half, "job", "c");
  REQUIRE(from);
  CHECK(from->step == 150);
  const auto rest = run(*std::move(from), nullptr);
  CHECK(write_checkpoint(rest, "job") == write_checkpoint(whole_run, "job"));
  CHECK(csv_of(rest.points) == csv_of(whole_run.points));
  CHECK(events_of(rest.points) == events_of(whole_run.points));
}

TEST_CASE("trainer: the same seed gives the same weights, another seed others") {
  const auto weights = [](std::uint64_t seed) {
    LineTask task;
    TorchNetwork network = line_network(1);
    return write_checkpoint(trained(network, task, {.steps = 60, .seed = seed}), "");
  };
  CHECK(weights(3) == weights(3));
  CHECK(weights(3) != weights(4));
}

TEST_CASE("trainer: the best judgement's weights are kept, and patience ends the run") {
  LineTask task;
  task.judgements = {2.0, 1.0, 3.0, 3.0, 3.0, 3.0, 3.0};
  TorchNetwork network = line_network(1);
  const auto state =
      trained(network, task,
              {.steps = 1000, .rate = 1e-2, .average = false, .judge_every = 10, .patience = 3});
  CHECK(state.step == 50);
  CHECK(state.best_judgement == 1.0);
  LineTask other;
  TorchNetwork twenty = line_network(1);
  // The rate depends on the number of steps, so the shorter run must be stopped by its judgements,
  // too.
  other.judgements = {2.0, 1.0, 3.0};
  const auto short_run =
      trained(twenty, other,
              {.steps = 1000, .rate = 1e-2, .average = false, .judge_every = 10, .patience = 1});
  CHECK(short_run.step == 30);
  for (const auto& [name, tensor] : network.tensors()) {
    CHECK(torch::equal(tensor, twenty.tensors().at(name)));
  }
}

TEST_CASE("trainer: a loss that is no number five times in a row is refused") {
  LineTask task;
  task.scale = std::numeric_limits<float>::quiet_NaN();
  TorchNetwork network = line_network(1);
  const auto out = train(network, task, {.steps = 100}, {}, {});
  REQUIRE_FALSE(out);
  CHECK(to_string(out.error()) == "expected a finite loss, found NaN or infinity at steps up to 4");
}

TEST_CASE("trainer: it stops on request") {
  LineTask task;
  TorchNetwork network = line_network(1);
  const TrainingHooks hooks{
      .progress = [](std::string_view, std::uint64_t done, std::uint64_t) { return done < 7; }};
  const auto out = train(network, task, {.steps = 100}, {}, hooks);
  REQUIRE_FALSE(out);
  CHECK(out.error().kind == ErrorKind::interrupted);
}

TEST_CASE("checkpoint: another job, a file of another kind and a cut one are refused") {
  LineTask task;
  TorchNetwork network = line_network(1);
  const std::string bytes = write_checkpoint(trained(network, task, {.steps = 3}), "job");
  const auto refusal = [](const Result<TrainingState>& state) {
    return state ? "no error" : to_string(state.error());
  };
  CHECK(refusal(read_checkpoint(bytes, "job", "c")) == "no error");
  CHECK(refusal(read_checkpoint(bytes, "other", "c")) ==
        "c: expected the run of this method, data and settings, found another run");
  CHECK(refusal(read_checkpoint(write_safetensors({}), "job", "c")) ==
        "c: expected a training run to continue, found a file of another kind");
  for (std::size_t size = 0; size < bytes.size(); size += 50) {
    CHECK_FALSE(read_checkpoint(bytes.substr(0, size), "job", "c"));
  }
}

TEST_CASE("training log: a line a point") {
  const std::vector<TrainingPoint> points{{50, 1.25, 1e-3, 0.5, std::nullopt},
                                          {100, 0.0625, 5e-8, 2.0, 3.5}};
  CHECK(csv_of(points) ==
        "step,loss,rate,gradient,judgement\n50,1.25,0.001,0.5,\n100,0.0625,5e-08,2,3.5\n");
}

TEST_CASE("trainer: the parts of all processes are the batch, each example once") {
  for (const std::int64_t size : {1, 2, 3, 5, 32}) {
    std::int64_t at = 0;
    for (std::int64_t rank = 0; rank < size; ++rank) {
      const BatchPart part = BatchShare(rank, size, {}).part(32);
      CHECK((part.begin == at && part.count >= 32 / size && part.whole == 32));
      at += part.count;
    }
    CHECK(at == 32);
  }
}

TEST_CASE("trainer: where another process has ended the training fails and says so") {
  LineTask task;
  TorchNetwork network = line_network(1);
  TrainingHooks hooks;
  int sums = 0;
  hooks.share = BatchShare(1, 2, [&](torch::Tensor&) { return ++sums < 3; });
  const auto out = train(network, task, {.steps = 10}, {}, hooks);
  REQUIRE_FALSE(out);
  CHECK(out.error().kind == ErrorKind::lost_process);
  CHECK(sums == 3);
}
