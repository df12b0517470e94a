// SPDX-License-Identifier: Apache-2.0
// Networks in LibTorch compared with those that `infer` runs.
#include "kinalign/learn/torch_network.h"

#include "tests/infer/networks.h"
#include "tests/seeds.h"

#include "kinalign/infer/architecture_json.h"
#include "kinalign/learn/tensors.h"

#include <algorithm>
#include <cmath>

using namespace kinalign;

namespace {

/// Draws random architectures: up to `count` layers of any kind that fit each other.
class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return random_() % n; }

  std::vector<Layer> layers(std::size_t count, std::size_t& channels, std::size_t depth) {
    std::vector<Layer> out;
    for (std::size_t i = 0; i < count; ++i) {
      const auto kind = static_cast<LayerKind>(below(depth < 2 ? 18 : 14));
      if (kind == max_pool || kind == unpool) {
        out.push_back(layer(max_pool));
        if (below(2) == 0) out.push_back(one(relu, channels, depth));
        out.push_back(layer(unpool));
      } else {
        out.push_back(one(kind, channels, depth));
      }
    }
    return out;
  }

 private:
  Layer one(LayerKind kind, std::size_t& channels, std::size_t depth) {
    Layer out = layer(kind);
    if (kind == leaky_relu) out.slope = 0.125;
    if (kind == dropout) out.rate = 0.5;
    if (kind == linear || kind == conv || kind == lstm || kind == gru) out.out = 1 + below(20);
    if (kind == slice) {
      out.begin = below(channels);
      out.out = 1 + below(channels - out.begin);
    }
    if (kind == conv) {
      out.causal = below(2) == 0;
      out.kernel = out.causal ? 1 + below(5) : 1 + 2 * below(3);
      out.dilation = 1 + below(4);
    }
    if (kind == lstm || kind == gru) out.bidirectional = below(2) == 0;
    if (kind == sum || kind == product || kind == concat) add_branches(out, channels, depth);
    if (kind == along_time) out = smoother(1 + below(12));
    channels = outputs(out, channels);
    return out;
  }

  void add_branches(Layer& out, std::size_t channels, std::size_t depth) {
    for (std::size_t b = 1 + below(3); b > 0; --b) {
      std::size_t behind = channels;
      auto branch = layers(below(3), behind, depth + 1);
      if (out.kind != concat && behind != channels) branch.push_back(layer(linear, channels));
      out.branches.push_back(std::move(branch));
    }
  }

  std::mt19937_64 random_;
};

Tensors tensors_of(const TorchNetwork& network) {
  Tensors out;
  for (const auto& [name, tensor] : network.tensors()) out[name] = from_torch(tensor);
  return out;
}

/// The largest difference, as a share of the largest value or of 1.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  REQUIRE(a.size() == b.size());
  double worst = 0.0, largest = 1.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    largest = std::max(largest, std::abs(static_cast<double>(b[i])));
  }
  return worst / largest;
}

/// The result computed in doubles.
std::vector<float> exact(TorchNetwork network, const torch::Tensor& batch) {
  for (auto& [name, tensor] : network.tensors()) tensor = tensor.to(torch::kFloat64);
  return values_of(network.forward(batch.to(torch::kFloat64), false));
}

void compare(const Architecture& architecture, std::size_t frames, std::uint64_t seed) {
  CAPTURE(architecture_json(architecture));
  REQUIRE(validate(architecture));
  torch::manual_seed(seed);
  torch::NoGradGuard guard;
  const TorchNetwork network(architecture);
  const auto in = random_values(2 * frames * architecture.inputs, seed);
  const auto batch = to_torch(in, {2, whole(frames), whole(architecture.inputs)});
  const Network same = network_of(architecture, tensors_of(network));
  const std::size_t half = in.size() / 2;
  auto wanted = result_of(same, {in.begin(), in.begin() + static_cast<std::ptrdiff_t>(half)});
  const auto second = result_of(same, {in.begin() + static_cast<std::ptrdiff_t>(half), in.end()});
  wanted.insert(wanted.end(), second.begin(), second.end());
  // A layer_norm over nearly equal values enlarges rounding, in both networks alike.
  const double rounding =
      difference(values_of(network.forward(batch, false)), exact(network, batch));
  CHECK(difference(values_of(network.forward(batch, false)), wanted) < 1e-5 + 2.0 * rounding);
}

}  // namespace

TEST_CASE("torch network: every kind of layer computes what infer does") {
  compare(offline_architecture(), 37, 1);
  compare(offline_architecture(), 4, 2);
  compare(online_architecture(), 20, 3);
}

TEST_CASE("torch network: random networks compute what infer does") {
  for (const std::uint64_t seed : fresh_seeds(40)) {
    CAPTURE(seed);
    Drawer drawer(seed);
    Architecture architecture{1 + drawer.below(20), {}};
    std::size_t channels = architecture.inputs;
    architecture.layers = drawer.layers(1 + drawer.below(6), channels, 0);
    compare(architecture, 1 + drawer.below(40), seed);
  }
}

TEST_CASE("torch network: it has the tensors that infer wants, by name and shape") {
  const TorchNetwork network(offline_architecture());
  const auto wanted = parameters(offline_architecture());
  CHECK(network.tensors().size() == wanted.size());
  for (const Parameter& parameter : wanted) {
    REQUIRE(network.tensors().contains(parameter.name));
    CHECK(from_torch(network.tensors().at(parameter.name)).shape == parameter.shape);
  }
}

TEST_CASE("torch network: the same seed draws the same weights, another seed others") {
  const auto drawn = [](std::uint64_t seed) {
    torch::manual_seed(seed);
    return tensors_of(TorchNetwork(offline_architecture()));
  };
  CHECK((drawn(4) == drawn(4)));  // glog would print the values that doctest compares
  CHECK((drawn(4) != drawn(5)));
}

TEST_CASE("torch network: with the last layer at 0 the answer is 0") {
  torch::manual_seed(1);
  TorchNetwork network({3,
                        {layer(linear, 8), layer(relu), branches(sum, {{}, {layer(linear, 8)}}),
                         layer(linear, 2), layer(dropout)}});
  network.zero_last();
  torch::NoGradGuard guard;
  CHECK(values_of(network.forward(torch::ones({1, 2, 3}), false)) == std::vector<float>(4, 0.0F));
}

TEST_CASE("torch network: dropout and unpool are random in training alone") {
  torch::manual_seed(1);
  torch::NoGradGuard guard;
  const TorchNetwork network({4, {{.kind = dropout, .rate = 0.5}, layer(max_pool), layer(unpool)}});
  const auto x = torch::ones({1, 9, 4});
  CHECK(values_of(network.forward(x, false)) == std::vector<float>(36, 0.5F));
  CHECK(values_of(network.forward(x, true)) != values_of(network.forward(x, true)));
}

TEST_CASE("torch network: parts of a batch drop and unpool what the whole batch does") {
  torch::manual_seed(1);
  torch::NoGradGuard guard;
  const Layer half{.kind = dropout, .rate = 0.5};
  // Values have another order in memory after convolutions than after recurrent layers.
  const TorchNetwork network({4,
                              {half,
                               {.kind = conv, .out = 6, .kernel = 3},
                               half,
                               {.kind = lstm, .out = 5, .bidirectional = true},
                               half,
                               layer(max_pool),
                               layer(unpool)}});
  const auto x = torch::randn({7, 9, 4});
  const auto trained = [&](const torch::Tensor& input, const BatchPart& part) {
    torch::manual_seed(2);
    return network.forward(input, part);
  };
  torch::manual_seed(2);
  const auto whole_batch = network.forward(x, true);
  CHECK(torch::equal(trained(x, {0, 7, 7}), whole_batch));
  for (const std::int64_t processes : {2, 3, 7}) {
    std::vector<torch::Tensor> parts;
    for (std::int64_t rank = 0; rank < processes; ++rank) {
      const BatchPart part = BatchShare(rank, processes, {}).part(7);
      parts.push_back(trained(x.slice(0, part.begin, part.begin + part.count), part));
    }
    CAPTURE(processes);
    CHECK(torch::allclose(torch::cat(parts), whole_batch, 1e-5, 1e-6));
  }
}
