// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/describe_model.h"

#include "tests/models/small_model.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

using namespace kinalign;

namespace {

DenoiseModel model_with_facts() {
  DenoiseModel model = small_model(1);
  model.facts.training =
      R"({"data":[{"name":"walks","licence":"CC-BY-4.0","citation":"Someone, 2026","frames":600}],)"
      R"("steps":1200,"rate":0.003,"seed":1})";
  model.facts.metrics = R"({"mpjpe_cm":3.5})";
  return model;
}

}  // namespace

TEST_CASE("info prints a model: joints, network, training, metrics, smoothing") {
  const auto found = describe_model("m.safetensors", write_denoise_model(model_with_facts()));
  REQUIRE(found);
  CHECK(found->text ==
        "m.safetensors\n"
        "  model       denoise, method refine\n"
        "  rate        30 Hz\n"
        "  input       5 joints: SpineBase, HipLeft, HipRight, KneeLeft, KneeRight\n"
        "  output      5 joints: SpineBase, HipLeft, HipRight, KneeLeft, KneeRight\n"
        "  spread      stated for each joint\n"
        "  network     net: 35 in, 20 out, 720 parameters; a frame sees 0 before and 0 after it\n"
        "              linear 20\n"
        "  steadying   smoothed over 11 frames (order 2), mean with the mirror image, bones of "
        "constant length\n"
        "  trained on  walks, 600 frames, licence CC-BY-4.0\n"
        "    cite      Someone, 2026\n"
        "  training    steps 1200, rate 0.003, seed 1\n"
        "  metric      mpjpe_cm 3.5\n");
  const auto json = nlohmann::json::parse(found->json);
  CHECK(json.at("kind") == "model");
  CHECK(json.at("task") == "denoise");
  CHECK(json.at("networks").at("net").at("parameters") == 720);
  CHECK(json.at("training").at("data").at(0).at("licence") == "CC-BY-4.0");
  CHECK(json.at("metrics").at("mpjpe_cm") == 3.5);
}

TEST_CASE("info prints branches and unused channels") {
  DenoiseModel model = small_model(1);
  model.architecture.layers = {
      branches(sum, {{}, {causal_conv(35, 3, 2), {.kind = LayerKind::dropout, .rate = 0.25}}}),
      {.kind = LayerKind::lstm, .out = 10, .bidirectional = true}};
  model.tensors.clear();
  for (auto& [name, tensor] : random_tensors(model.architecture, 1)) {
    model.tensors["net." + name] = tensor;
  }
  const auto found = describe_model("m", write_denoise_model(model));
  REQUIRE(found);
  CHECK(found->text.find("a frame sees all before and all after it\n"
                         "              sum\n"
                         "                branch: unchanged input\n"
                         "                branch\n"
                         "                  conv 35, kernel 3, dilation 2, causal\n"
                         "                  dropout 0.25\n"
                         "              lstm 10, both directions\n") != std::string::npos);
}

TEST_CASE("info refuses an unusable model, and accepts facts of any shape") {
  DenoiseModel model = small_model(1);
  model.tensors.erase("net.0.bias");
  const auto broken = describe_model("m", write_denoise_model(model));
  REQUIRE_FALSE(broken);
  CHECK(to_string(broken.error()) == "m: expected tensor 0.bias [20], found none");
  CHECK_FALSE(describe_model("m", "no model"));
  for (const char* facts : {"{}", "[]", R"({"data":3,"steps":"x"})", R"({"data":[1,{"name":2}]})",
                            R"({"data":[{"citation":"two\nlines"}]})"}) {
    CAPTURE(facts);
    model = small_model(1);
    model.facts.training = model.facts.metrics = facts;
    const auto found = describe_model("m", write_denoise_model(model));
    REQUIRE(found);
    CHECK(found->text.find("two\n") == std::string::npos);
  }
}

TEST_CASE("info prints a model for poses: nodes, bones, body, network, training, metrics") {
  std::ifstream in(KINALIGN_SOURCE_DIR "/tests/data/fuzz/pose_model_fuzz/two.safetensors",
                   std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  const auto found = describe_model("m.safetensors", bytes);
  REQUIRE(found);
  CHECK(
      found->text ==
      "m.safetensors\n"
      "  model       pose, method small\n"
      "  rate        30 Hz\n"
      "  input       5 nodes: wrist_left, wrist_right, ankle_left, ankle_right, waist; 48 channels "
      "(dip)\n"
      "  output      rotations of 4 bones\n"
      "  body        9 joints, 1.37 m from the lowest to the highest at rest\n"
      "  network     net: 48 in, 24 out, 1,440 parameters; a frame sees all before and all after "
      "it\n"
      "              lstm 3, both directions\n"
      "              linear 24\n"
      "  smoothing   over 5 frames\n"
      "  trained on  small, licence own\n"
      "  training    steps 1, seed 1\n"
      "  metric      calibrated_position_cm 12.5\n");
  const auto json = nlohmann::json::parse(found->json);
  CHECK(json.at("kind") == "model");
  CHECK(json.at("task") == "pose");
  CHECK(json.at("input").at("nodes").size() == 5);
  CHECK(json.at("output").at("bones").size() == 4);
  CHECK(json.at("output").at("height_m") == doctest::Approx(1.37));
  CHECK(json.at("metrics").at("calibrated_position_cm") == 12.5);
}

TEST_CASE("info prints the model that training continued from, with its licence") {
  DenoiseModel model = small_model(1);
  model.facts.training =
      R"({"data":[{"name":"own","frames":9}],"from":{"data":[{"name":"base","licence":"PDDL"}]}})";
  const auto found = describe_model("m", write_denoise_model(model));
  REQUIRE(found);
  const std::size_t own = found->text.find("trained on  own"),
                    base = found->text.find("trained on  base");
  CHECK(own < found->text.find("went on     from a model of the same method"));
  CHECK(own < base);
  CHECK(base != std::string::npos);
  CHECK(found->text.find("licence PDDL") != std::string::npos);
  for (const char* broken : {R"({"from":3})", R"({"from":{"data":4}})"}) {
    model.facts.training = broken;
    CHECK(describe_model("m", write_denoise_model(model)));
  }
}
