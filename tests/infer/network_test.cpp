// SPDX-License-Identifier: Apache-2.0
// Small networks computed by hand. tests/infer/network_check.py compares random ones with PyTorch.
#include "kinalign/infer/network.h"

#include "tests/infer/allocations.h"
#include "tests/infer/networks.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

std::string refusal(const Architecture& architecture, const Tensors& tensors,
                    const std::string& prefix = "") {
  const auto network = Network::make(architecture, tensors, prefix);
  return network ? "no error" : to_string(network.error());
}

std::vector<float> run(const std::vector<Layer>& layers, const Tensors& tensors,
                       const std::vector<float>& in) {
  return result_of(network_of({1, layers}, tensors), in);
}

}  // namespace

TEST_CASE("a convolution sees zeros beyond both ends") {
  const Tensors tensors{{"0.weight", {{1, 1, 3}, {1.0F, 10.0F, 100.0F}}},
                        {"0.bias", {{1}, {1000.0F}}}};
  CHECK(run({centred_conv(1, 3, 1)}, tensors, {1, 2, 3, 4}) ==
        std::vector<float>{1210, 1321, 1432, 1043});
  CHECK(run({centred_conv(1, 3, 2)}, tensors, {1, 2, 3, 4}) ==
        std::vector<float>{1310, 1420, 1031, 1042});
  CHECK(run({centred_conv(1, 3, 2)}, tensors, {1}) == std::vector<float>{1010});
  CHECK(run({causal_conv(1, 3, 1)}, tensors, {1, 2, 3, 4}) ==
        std::vector<float>{1100, 1210, 1321, 1432});
}

TEST_CASE("max_pool leaves an odd last frame, unpool brings as many frames back") {
  const Layer pool = layer(max_pool), up = layer(unpool);
  CHECK(run({pool}, {}, {1, 3, 2, 0, 5}) == std::vector<float>{3, 2, 5});
  CHECK(run({pool, up}, {}, {1, 3, 2, 0, 5}) == std::vector<float>{1.5F, 1.5F, 1, 1, 2.5F});
  CHECK(run({pool, pool, up, up}, {}, {1, 3, 2, 0, 5}) ==
        std::vector<float>{0.75F, 0.75F, 0.75F, 0.75F, 1.25F});
  CHECK(run({pool, up}, {}, {4}) == std::vector<float>{2});
  CHECK(run({pool, up}, {}, {}).empty());
}

TEST_CASE("along_time: each channel alone, the mean over all windows that a frame lies in") {
  const Layer two{.kind = along_time, .window = 2, .branches = {{layer(linear, 2)}}};
  const Tensors exchange{{"0.0.0.weight", {{2, 2}, {0.0F, 1.0F, 1.0F, 0.0F}}},
                         {"0.0.0.bias", {{2}, {0.0F, 0.0F}}}};
  // Windows 1 2 and 2 4 become 2 1 and 4 2.
  CHECK(run({two}, exchange, {1, 2, 4}) == std::vector<float>{2, 2.5F, 2});
  CHECK(run({two}, exchange, {1, 2}) == std::vector<float>{2, 1});
  CHECK(run({two}, exchange, {5}) == std::vector<float>{5});  // padded with the window's last frame
  CHECK(run({two}, exchange, {}).empty());
  const Network both = network_of({2, {two}}, exchange);
  CHECK(result_of(both, {1, 10, 2, 20, 4, 40}) == std::vector<float>{2, 20, 2.5F, 25, 2, 20});
  const Layer identity{.kind = along_time, .window = 7, .branches = {{}}};
  const auto long_one = random_values(1000, 1);  // several blocks of windows
  const auto same = run({identity}, {}, long_one);
  for (std::size_t i = 0; i < same.size(); ++i) CHECK(same[i] == doctest::Approx(long_one[i]));
}

TEST_CASE("branches are added, multiplied or joined") {
  const Tensors tensors{{"0.1.0.weight", {{1, 1}, {10.0F}}}, {"0.1.0.bias", {{1}, {1.0F}}}};
  const std::vector<std::vector<Layer>> two{{}, {layer(linear, 1)}};
  CHECK(run({branches(sum, two)}, tensors, {1, 2}) == std::vector<float>{12, 23});
  CHECK(run({branches(product, two)}, tensors, {1, 2}) == std::vector<float>{11, 42});
  CHECK(run({branches(concat, two)}, tensors, {1, 2}) == std::vector<float>{1, 11, 2, 21});
}

TEST_CASE("a network of no layers hands its input on") {
  CHECK(run({}, {}, {1, 2}) == std::vector<float>{1, 2});
  CHECK(run({{.kind = dropout, .rate = 0.5}}, {}, {1, 2}) == std::vector<float>{1, 2});
}

TEST_CASE("any number of frames has a finite result") {
  const Architecture architecture = offline_architecture();
  const Network network = network_of(architecture, random_tensors(architecture, 1));
  for (std::size_t frames = 0; frames < 20; ++frames) {
    CAPTURE(frames);
    const auto out = result_of(network, random_values(frames * 6, frames));
    CHECK(out.size() == frames * network.outputs());
    CHECK(std::all_of(out.begin(), out.end(), [](float x) { return std::isfinite(x); }));
  }
}

TEST_CASE("both builds of the kernels agree") {
  const Architecture architecture = offline_architecture();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const Tensors tensors = random_tensors(architecture, 100 * seed);
    const auto in = random_values(6 * 200, seed);
    const auto best = result_of(network_of(architecture, tensors), in);
    const auto baseline = result_of(network_of(architecture, tensors, baseline_kernels()), in);
    REQUIRE(best.size() == baseline.size());
    float largest = 1.0F, apart = 0.0F;
    for (std::size_t i = 0; i < best.size(); ++i) {
      largest = std::max(largest, std::abs(best[i]));
      apart = std::max(apart, std::abs(best[i] - baseline[i]));
    }
    CHECK(apart < 1e-5F * largest);  // some hundred roundings of 6e-8 each
  }
}

TEST_CASE("tensors may have a prefix, and other tensors may be in the file") {
  const Architecture architecture{1, {layer(linear, 1)}};
  const Tensors tensors{{"head.0.weight", {{1, 1}, {2.0F}}},
                        {"head.0.bias", {{1}, {1.0F}}},
                        {"other", {{1}, {1.0F}}}};
  const auto network = Network::make(architecture, tensors, "head.");
  REQUIRE(network);
  CHECK(result_of(*network, {3.0F}) == std::vector<float>{7.0F});
}

TEST_CASE("a tensor that is missing, has another shape or no finite values is named") {
  const Architecture architecture{2, {layer(linear, 1)}};
  Tensors tensors{{"0.weight", {{1, 2}, {1.0F, 2.0F}}}, {"0.bias", {{1}, {1.0F}}}};
  CHECK(refusal(architecture, {}) == "expected tensor 0.weight [1,2], found none");
  CHECK(refusal(architecture, tensors, "a.") == "expected tensor a.0.weight [1,2], found none");
  tensors["0.bias"] = {{1, 1}, {1.0F}};
  CHECK(refusal(architecture, tensors) == "expected tensor 0.bias [1], found [1,1]");
  tensors["0.bias"] = {{1}, {std::numeric_limits<float>::quiet_NaN()}};
  CHECK(refusal(architecture, tensors) == "expected finite numbers in tensor 0.bias, found others");
  CHECK(refusal({2, {layer(linear)}}, tensors) ==
        "expected 1 to 16384 channels in layer 0, found 0");
}

TEST_CASE("a run over as many frames as an earlier one allocates nothing") {
  const Architecture architecture = offline_architecture();
  const Network network = network_of(architecture, random_tensors(architecture, 1));
  const auto in = random_values(6 * 101, 1);
  Workspace workspace;
  std::vector<float> out;
  network.run(in, 101, workspace, out);
  const auto first = out;
  const std::size_t before = allocations();
  network.run(in, 101, workspace, out);
  const bool same = out == first;
  network.run(std::span(in).first(6 * 50), 50, workspace, out);
  const std::size_t after = allocations();
  CHECK(after == before);
  CHECK(same);
}

TEST_CASE("a run takes tiny numbers for 0, and the processor does not afterwards") {
#ifdef __SSE__
  const Tensors tensors{{"0.weight", {{1, 1}, {1e-30F}}}, {"0.bias", {{1}, {0.0F}}}};
  CHECK(run({layer(linear, 1)}, tensors, {1e-10F}) == std::vector<float>{0.0F});
  volatile float tiny = 1e-30F;
  CHECK(tiny * 1e-10F > 0.0F);
#endif
}
