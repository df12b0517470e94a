// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/architecture_json.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string message(const std::string& text) {
  const auto network = parse_architecture_json(text, "m");
  return network ? "no error" : to_string(network.error());
}

std::string layers(const std::string& text) { return R"({"inputs":4,"layers":[)" + text + "]}"; }

}  // namespace

TEST_CASE("an architecture as JSON, and back") {
  const Layer conv{.kind = LayerKind::conv, .out = 4, .kernel = 3, .dilation = 2, .causal = true};
  const Layer sum{.kind = LayerKind::sum, .branches = {{conv, {.kind = LayerKind::gelu}}, {}}};
  const Architecture network{4, {sum, {.kind = LayerKind::lstm, .out = 2, .bidirectional = true}}};
  const std::string text =
      R"({"inputs":4,"layers":[{"kind":"sum","branches":[[)"
      R"({"kind":"conv","out":4,"kernel":3,"dilation":2,"causal":true},{"kind":"gelu"}],[]]},)"
      R"({"kind":"lstm","out":2,"bidirectional":true}]})";
  CHECK(architecture_json(network) == text);
  const auto again = parse_architecture_json(text, "m");
  REQUIRE(again);
  CHECK(*again == network);
}

TEST_CASE("members left out have the defaults of Layer, but out and branches") {
  const auto network = parse_architecture_json(
      layers(R"({"kind":"conv","out":3},{"kind":"leaky_relu"},{"kind":"dropout"})"), "m");
  REQUIRE(network);
  CHECK(network->layers[0].kernel == 1);
  CHECK(network->layers[1].slope == 0.01);
  CHECK(message(layers(R"({"kind":"linear"})")) == "m: expected out in layer 0, found none");
  CHECK(message(layers(R"({"kind":"sum"})")) == "m: expected branches in layer 0, found none");
}

TEST_CASE("an error names the layer") {
  CHECK(message(layers(R"({"kind":"sum","branches":[[],[{"kind":"relu"},{"kind":"rely"}]]})")) ==
        "m: expected a known kind of layer in layer 0.1.1, found \"rely\"");
  CHECK(message(layers(R"({"kind":"relu","slope":1})")) ==
        "m: expected members of relu in layer 0, found \"slope\"");
  CHECK(message(layers(R"({"kind":"linear","out":-1})")) ==
        "m: expected a whole number as out in layer 0, found a JSON number");
  CHECK(message(layers(R"({"kind":"conv","out":1,"causal":1})")) ==
        "m: expected true or false as causal in layer 0, found a JSON number");
  CHECK(message(layers(R"({"out":1})")) == "m: expected a kind in layer 0, found none");
  CHECK(message(layers("1")) == "m: expected a JSON object in layer 0, found a JSON number");
}

TEST_CASE("the network itself is read as strictly") {
  CHECK(message("[]") == "m: expected a network as JSON object in the text, found a JSON array");
  CHECK(message("{}") == "m: expected layers in the network, found none");
  CHECK(message(R"({"layers":[]})") == "m: expected 1 to 16384 inputs of a network, found 0");
  CHECK(message(R"({"inputs":1,"layers":[],"name":""})") ==
        "m: expected inputs and layers in the network, found \"name\"");
  CHECK(message(R"({"inputs":1,"inputs":2,"layers":[]})") ==
        "m: expected each key of a JSON object once, found \"inputs\" twice");
  CHECK(message(R"({"inputs":1,"layers":)" + std::string(100, '[') + std::string(100, ']') + "}") ==
        "m: expected JSON of at most 64 levels, found more levels");
}
