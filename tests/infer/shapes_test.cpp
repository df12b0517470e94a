// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/shapes.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string message(const std::vector<Layer>& layers, std::size_t inputs = 4) {
  const auto valid = validate({inputs, layers});
  return valid ? "no error" : to_string(valid.error());
}

const Layer pool{.kind = LayerKind::max_pool}, unpool{.kind = LayerKind::unpool};

}  // namespace

TEST_CASE("the tensors of an architecture, in the order of the layers") {
  const Layer conv{.kind = LayerKind::conv, .out = 3, .kernel = 5};
  const Layer norm{.kind = LayerKind::layer_norm};
  const Architecture network{2,
                             {{.kind = LayerKind::concat, .branches = {{}, {norm, conv}}},
                              {.kind = LayerKind::gru, .out = 7, .bidirectional = true},
                              {.kind = LayerKind::linear, .out = 1}}};
  REQUIRE(validate(network));
  CHECK(outputs(network) == 1);
  const std::vector<Parameter> expected{{"0.1.0.weight", {2}},
                                        {"0.1.0.bias", {2}},
                                        {"0.1.1.weight", {3, 2, 5}},
                                        {"0.1.1.bias", {3}},
                                        {"1.weight_ih_l0", {21, 5}},
                                        {"1.weight_hh_l0", {21, 7}},
                                        {"1.bias_ih_l0", {21}},
                                        {"1.bias_hh_l0", {21}},
                                        {"1.weight_ih_l0_reverse", {21, 5}},
                                        {"1.weight_hh_l0_reverse", {21, 7}},
                                        {"1.bias_ih_l0_reverse", {21}},
                                        {"1.bias_hh_l0_reverse", {21}},
                                        {"2.weight", {1, 14}},
                                        {"2.bias", {1}}};
  CHECK(parameters(network) == expected);
}

TEST_CASE("frames that a frame of the result depends on") {
  const Layer centred{.kind = LayerKind::conv, .out = 4, .kernel = 5, .dilation = 3};
  const Layer causal{.kind = LayerKind::conv, .out = 4, .kernel = 4, .dilation = 2, .causal = true};
  const Architecture both{4, {{.kind = LayerKind::sum, .branches = {{centred}, {causal}}}, causal}};
  CHECK(look_ahead(both) == 6);
  CHECK(look_back(both) == 12);
  const Architecture forward{4, {{.kind = LayerKind::lstm, .out = 4}, centred}};
  CHECK(look_ahead(forward) == 6);
  CHECK_FALSE(look_back(forward));
  CHECK_FALSE(look_ahead({4, {{.kind = LayerKind::gru, .out = 4, .bidirectional = true}}}));
  CHECK_FALSE(look_ahead({4, {pool, unpool}}));
  const Layer windows{.kind = LayerKind::along_time, .window = 8, .branches = {{}}};
  CHECK(look_ahead({4, {windows, centred}}) == 13);
  CHECK(look_back({4, {windows}}) == 7);
}

TEST_CASE("a layer that does not fit is named") {
  CHECK(message({{.kind = LayerKind::linear}}) ==
        "expected 1 to 16384 channels in layer 0, found 0");
  CHECK(message({{.kind = LayerKind::lstm, .out = 8193, .bidirectional = true}}) ==
        "expected 1 to 8192 channels in layer 0, found 8193");
  CHECK(message({{.kind = LayerKind::conv, .out = 1, .kernel = 4}}) ==
        "expected an odd number of taps, as the convolution is centred in layer 0, found 4");
  CHECK(message({{.kind = LayerKind::conv, .out = 1, .kernel = 1025}}) ==
        "expected 1 to 1023 taps in layer 0, found 1025");
  CHECK(message({{.kind = LayerKind::slice, .out = 3, .begin = 2}}) ==
        "expected a slice of 4 channels in layer 0, found channels 2 to 4");
  CHECK(message({{.kind = LayerKind::slice, .out = 1, .begin = ~std::size_t{0}}}) != "no error");
  CHECK(message({{.kind = LayerKind::relu, .out = 3}}) ==
        "expected only members of relu in layer 0, found others");
  CHECK(message({{.kind = LayerKind::dropout, .rate = 1.0}}) ==
        "expected a rate from 0 to below 1 in layer 0, found 1.000000");
  CHECK(message({{.kind = LayerKind::sum,
                  .branches = {{}, {{.kind = LayerKind::linear, .out = 3}}}}}) ==
        "expected 4 channels, as in branch 0, in layer 0.1, found 3");
  const auto along_time = [](std::vector<std::vector<Layer>> all) {
    return message({{.kind = LayerKind::along_time, .window = 8, .branches = std::move(all)}});
  };
  CHECK(along_time({{}}) == "no error");
  CHECK(along_time({}) == "expected one branch in layer 0, found 0");
  CHECK(along_time({{{.kind = LayerKind::linear, .out = 3}}}) ==
        "expected 8 channels after the branch in layer 0, found 3");
  CHECK(along_time({{{.kind = LayerKind::gru, .out = 8}}}) ==
        "expected a branch whose layers process each row separately in layer 0, found others");
  CHECK(along_time(
            {{{.kind = LayerKind::sum, .branches = {{{.kind = LayerKind::conv, .out = 8}}}}}}) ==
        "expected a branch whose layers process each row separately in layer 0, found others");
  CHECK(message({{.kind = LayerKind::concat}}) ==
        "expected 1 to 1000 branches in layer 0, found 0");
}

TEST_CASE("a max_pool and its unpool stand in the same list of layers") {
  CHECK(message({pool, pool, unpool, unpool}) == "no error");
  CHECK(message({pool}) == "no error");  // an encoder
  CHECK(message({unpool}) == "expected a max_pool before the unpool in layer 0, found none");
  const Layer open{.kind = LayerKind::sum, .branches = {{pool}}};
  CHECK(message({open}) ==
        "expected an unpool for each max_pool of a branch in layer 0.0, found 1 without one");
  const Layer inside{.kind = LayerKind::sum, .branches = {{unpool}}};
  CHECK(message({pool, inside}) ==
        "expected a max_pool before the unpool in layer 1.0.0, found none");
}

TEST_CASE("an architecture has an upper size") {
  CHECK(message(std::vector<Layer>(1000, {.kind = LayerKind::relu})) == "no error");
  CHECK(message(std::vector<Layer>(1001, {.kind = LayerKind::relu})).find("at most 1000 layers") !=
        std::string::npos);
  Layer deep{.kind = LayerKind::sum, .branches = {{}}};
  for (int i = 0; i < 7; ++i) deep = {.kind = LayerKind::sum, .branches = {{deep}}};
  CHECK(message({deep}) == "no error");
  CHECK(message({{.kind = LayerKind::sum, .branches = {{deep}}}}) ==
        "expected at most 8 branches within branches in layer 0.0.0.0.0.0.0.0.0.0.0.0.0.0.0.0.0, "
        "found more");
  CHECK(message({{.kind = LayerKind::linear, .out = 16384}}, 16384) !=
        "no error");  // 268 million weights
  CHECK(message({{.kind = LayerKind::conv, .out = 1, .kernel = 1023, .dilation = 4096}}, 64) !=
        "no error");
  CHECK(message({}, 16385) == "expected 1 to 16384 inputs of a network, found 16385");
}
