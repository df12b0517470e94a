// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/window_network.h"

#include "tests/infer/allocations.h"
#include "tests/infer/networks.h"

#include "kinalign/infer/shapes.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

namespace {

constexpr std::size_t window_inputs = 6;

/// Every kind of layer that works on a window, centred and causal.
Architecture windowed_architecture() {
  Layer part = layer(slice, 8);
  part.begin = 3;
  return {
      window_inputs,
      {layer(linear, 20),
       branches(sum, {{}, {centred_conv(20, 5, 2), layer(gelu), centred_conv(20, 3, 1)}}),
       branches(product, {{part, causal_conv(8, 3, 4)}, {centred_conv(8, 5, 1), layer(sigmoid)}}),
       layer(layer_norm), branches(concat, {{}, {centred_conv(4, 7, 1), layer(gelu)}}),
       layer(dropout), centred_conv(7, 3, 8), layer(linear, 5)}};
}

/// A window of the rows of `all` before `end`, which moves on frame by frame.
struct Moving {
  const std::vector<float>& all;
  std::size_t first = 0, end = 0;

  std::span<const float> rows() const {
    return std::span(all).subspan(first * window_inputs, (end - first) * window_inputs);
  }
};

bool same_row(std::span<const float> a, std::span<const float> b, std::size_t row_a,
              std::size_t row_b, std::size_t width) {
  return std::equal(a.begin() + static_cast<std::ptrdiff_t>(row_a * width),
                    a.begin() + static_cast<std::ptrdiff_t>((row_a + 1) * width),
                    b.begin() + static_cast<std::ptrdiff_t>(row_b * width));
}

}  // namespace

TEST_CASE("results in a moving window are those of all frames since the start, bit by bit") {
  const Architecture architecture = windowed_architecture();
  const std::size_t back = *look_back(architecture);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const Network network = network_of(architecture, random_tensors(architecture, seed + 1));
    const std::size_t outputs = network.outputs();
    WindowNetwork window(network);
    std::mt19937_64 random(seed);
    const std::size_t ahead = random() % 25, kept = back + random() % 5;
    const auto all = random_values(window_inputs * 120, seed);
    Moving moving{all};
    for (std::size_t t = ahead; t < 120; ++t) {
      const std::size_t before = moving.end;
      moving.end = t + 1;
      const std::size_t wanted = t - ahead;  // the row for which the answer is
      const auto found = window.run(moving.rows(), moving.end - moving.first, before - moving.first,
                                    wanted + 1 - moving.first);
      const auto whole = result_of(
          network, std::vector<float>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(
                                                                     window_inputs * moving.end)));
      REQUIRE(same_row(found, whole, wanted - moving.first, wanted, outputs));
      if (wanted + 1 - moving.first > kept) {
        window.forget(1);
        ++moving.first;
      }
    }
  }
}

TEST_CASE("changed rows are computed again") {
  const Architecture architecture = windowed_architecture();
  const Network network = network_of(architecture, random_tensors(architecture, 3));
  WindowNetwork window(network);
  auto rows = random_values(window_inputs * 60, 5);
  (void)window.run(rows, 60, 0, 40);
  for (std::size_t i = window_inputs * 50; i < rows.size(); ++i) rows[i] += 1.0F;
  const auto found = window.run(rows, 60, 50, 60);
  const auto whole = result_of(network, rows);
  CHECK(std::equal(found.begin(), found.end(), whole.begin(), whole.end()));
}

TEST_CASE("a network that remembers everything runs over the window as it is") {
  const Architecture architecture{window_inputs, {layer(lstm, 4)}};
  const Network network = network_of(architecture, random_tensors(architecture, 3));
  WindowNetwork window(network);
  const auto rows = random_values(window_inputs * 30, 5);
  (void)window.run(rows, 30, 0, 20);
  window.forget(10);
  const std::vector<float> left(rows.begin() + window_inputs * 10, rows.end());
  const auto found = window.run(left, 20, 20, 20);
  const auto whole = result_of(network, left);
  CHECK(std::equal(found.begin(), found.end(), whole.begin(), whole.end()));
}

TEST_CASE("a window that has reached its size allocates nothing") {
  const Architecture architecture = windowed_architecture();
  const Network network = network_of(architecture, random_tensors(architecture, 3));
  WindowNetwork window(network);
  const auto rows = random_values(window_inputs * 60, 5);
  (void)window.run(rows, 60, 0, 60);
  const std::size_t before = allocations();
  for (int i = 0; i < 10; ++i) {
    window.forget(1);
    (void)window.run(rows, 60, 58, 55);
  }
  CHECK(allocations() == before);
}
