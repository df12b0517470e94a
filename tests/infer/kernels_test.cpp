// SPDX-License-Identifier: Apache-2.0
// Each build of the kernels compared with plain loops in double.
#include "kinalign/infer/kernels.h"

#include "tests/infer/networks.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

const Kernels* const builds[] = {&baseline_kernels(), &best_kernels()};

/// [panels, depth, panel_width] from [depth, outputs].
std::vector<float> packed(const std::vector<float>& weights, std::size_t depth,
                          std::size_t outputs) {
  const std::size_t panels = (outputs + panel_width - 1) / panel_width;
  std::vector<float> out(panels * depth * panel_width);
  for (std::size_t k = 0; k < depth; ++k) {
    for (std::size_t n = 0; n < outputs; ++n) {
      out[(n / panel_width * depth + k) * panel_width + n % panel_width] = weights[k * outputs + n];
    }
  }
  return out;
}

/// The largest error of a function of one value over -100 ... 100.
double worst_error(void (*function)(float*, std::size_t), double (*truth)(double)) {
  std::vector<float> values;
  for (int i = -100'000; i <= 100'000; ++i) values.push_back(static_cast<float>(i) * 1e-3F);
  const auto in = values;
  function(values.data(), values.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const double expected = truth(in[i]);
    worst = std::max(worst, std::abs(values[i] - expected) / std::max(1.0, std::abs(expected)));
  }
  return worst;
}

double true_sigmoid(double x) { return 1.0 / (1.0 + std::exp(-x)); }
double true_gelu(double x) { return 0.5 * x * std::erfc(-x * std::sqrt(0.5)); }
double true_tanh(double x) { return std::tanh(x); }

}  // namespace

TEST_CASE("products of every size") {
  for (const Kernels* kernels : builds) {
    for (std::size_t frames = 0; frames < 16; ++frames) {
      for (const std::size_t outputs : {1, 15, 16, 17, 40, 64, 65, 100}) {
        CAPTURE(std::string(kernels->name));
        CAPTURE(frames);
        CAPTURE(outputs);
        const std::size_t taps = 1 + frames % 3, channels = 1 + (frames * outputs) % 9;
        const std::size_t depth = taps * channels, stride = outputs + 3;
        const auto in = random_values((frames + taps) * channels, frames);
        const auto weights = random_values(depth * outputs, outputs);
        const auto panels = packed(weights, depth, outputs);
        std::vector<float> out(frames * stride, 1.0F);
        Product p;
        p.in = in.data();
        p.in_stride = p.tap_stride = p.channels = channels;
        p.taps = taps;
        p.weights = panels.data();
        p.out = out.data();
        p.out_stride = stride;
        p.outputs = outputs;
        p.frames = frames;
        kernels->multiply(p);
        for (std::size_t t = 0; t < frames; ++t) {
          for (std::size_t n = 0; n < stride; ++n) {
            double expected = 1.0;
            for (std::size_t k = 0; n < outputs && k < depth; ++k) {
              expected += double{in[t * channels + k]} * double{weights[k * outputs + n]};
            }
            CHECK(out[t * stride + n] == doctest::Approx(expected).epsilon(1e-5));
          }
        }
      }
    }
  }
}

TEST_CASE("functions of one value are right to 5e-7 and keep NaN") {
  for (const Kernels* kernels : builds) {
    CAPTURE(std::string(kernels->name));
    CHECK(worst_error(kernels->sigmoid, true_sigmoid) < 5e-7);
    CHECK(worst_error(kernels->tanh, true_tanh) < 5e-7);
    CHECK(worst_error(kernels->gelu, true_gelu) < 5e-7);
    for (const auto function : {kernels->sigmoid, kernels->tanh, kernels->gelu, kernels->relu}) {
      float nan = std::numeric_limits<float>::quiet_NaN();
      function(&nan, 1);
      CHECK(std::isnan(nan));
    }
  }
}

TEST_CASE("tanh keeps small values to their last digits") {
  for (const Kernels* kernels : builds) {
    float value = 1e-6F;
    kernels->tanh(&value, 1);
    CHECK(value == doctest::Approx(1e-6).epsilon(1e-6));
  }
}
