// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/online.h"

#include "tests/infer/allocations.h"
#include "tests/infer/networks.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string refusal(const std::vector<Layer>& layers) {
  const Architecture architecture{4, layers};
  const Network network = network_of(architecture, random_tensors(architecture, 1));
  const auto online = OnlineNetwork::make(network);
  return online ? "no error" : to_string(online.error());
}

OnlineNetwork online_of(const Network& network) {
  auto online = OnlineNetwork::make(network);
  REQUIRE(online);
  return *std::move(online);
}

std::vector<float> steps(OnlineNetwork& online, std::span<const float> in, std::size_t inputs) {
  std::vector<float> out;
  for (std::size_t at = 0; at < in.size(); at += inputs) {
    const auto result = online.step(in.subspan(at, inputs));
    out.insert(out.end(), result.begin(), result.end());
  }
  return out;
}

}  // namespace

TEST_CASE("frame by frame the results are those of the whole sequence, bit by bit") {
  const Architecture architecture = online_architecture();
  for (const Kernels* kernels : {&baseline_kernels(), &best_kernels()}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      CAPTURE(seed);
      const Network network =
          network_of(architecture, random_tensors(architecture, 100 * seed), *kernels);
      OnlineNetwork online = online_of(network);
      const auto in = random_values(6 * 100, seed);
      CHECK(steps(online, in, 6) == result_of(network, in));
    }
  }
}

TEST_CASE("after a reset a network knows no earlier frame") {
  const Architecture architecture = online_architecture();
  const Network network = network_of(architecture, random_tensors(architecture, 1));
  OnlineNetwork online = online_of(network);
  const auto in = random_values(6 * 30, 1);
  const auto first = steps(online, in, 6);
  CHECK(steps(online, in, 6) != first);
  online.reset();
  CHECK(steps(online, in, 6) == first);
}

TEST_CASE("the state of recurrent layers moves from one network to another") {
  const Architecture architecture{3, {layer(gru, 5), branches(concat, {{layer(lstm, 4)}, {}})}};
  const Network network = network_of(architecture, random_tensors(architecture, 1));
  OnlineNetwork first = online_of(network), second = online_of(network);
  REQUIRE(first.state_size() == 5 + 2 * 4);
  const auto in = random_values(3 * 20, 1);
  steps(first, in, 3);
  std::vector<float> state(first.state_size());
  first.get_state(state);
  second.set_state(state);
  CHECK(steps(second, in, 3) == steps(first, in, 3));
}

TEST_CASE("a step allocates nothing") {
  const Architecture architecture = online_architecture();
  const Network network = network_of(architecture, random_tensors(architecture, 1));
  OnlineNetwork online = online_of(network);
  const auto in = random_values(6, 1);
  const std::size_t before = allocations();
  for (int i = 0; i < 100; ++i) online.step(in);
  CHECK(allocations() == before);
}

TEST_CASE("a network may be moved below its online form") {
  const Architecture architecture = online_architecture();
  Network network = network_of(architecture, random_tensors(architecture, 1));
  OnlineNetwork online = online_of(network);
  const Network moved = std::move(network);
  const auto in = random_values(6 * 10, 1);
  CHECK(steps(online, in, 6) == result_of(moved, in));
}

TEST_CASE("a layer that needs later frames is named") {
  Layer both = layer(gru, 2);
  both.bidirectional = true;
  const std::string expected = "expected layers that need no later frames, to run frame by frame, ";
  CHECK(refusal({both}) == expected + "found a bidirectional layer as layer 0");
  CHECK(refusal({branches(sum, {{}, {layer(relu), centred_conv(4, 3, 1)}})}) ==
        expected + "found a centred convolution as layer 0.1.1");
  CHECK(refusal({layer(max_pool), layer(unpool)}) == expected + "found max_pool as layer 0");
  CHECK(refusal({smoother(2)}) == expected + "found along_time as layer 0");
  CHECK(refusal({centred_conv(4, 1, 1)}) == "no error");
}
