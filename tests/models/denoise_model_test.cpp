// SPDX-License-Identifier: Apache-2.0
// A model's file: it is read as it was written, and refused if its parts do not fit together.
#include "tests/models/small_model.h"

#include "kinalign/infer/safetensors.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

using Json = nlohmann::ordered_json;

/// The small model's file with its header changed by `change`.
template <class Change>
std::string changed_file(const Change& change) {
  auto file = read_safetensors(write_denoise_model(small_model(1)), "m");
  REQUIRE(file);
  Json header = Json::parse(file->metadata.at("kinalign"));
  change(header);
  file->metadata["kinalign"] = header.dump();
  return write_safetensors(*file);
}

std::string refusal(const std::string& bytes) {
  const auto model = read_denoise_model(bytes, "m");
  if (!model) return to_string(model.error());
  const auto denoiser = Denoiser::make(*model);
  return denoiser ? "no error" : to_string(denoiser.error());
}

template <class Change>
std::string header_refusal(const Change& change) {
  return refusal(changed_file(change));
}

template <class Change>
std::string model_refusal(const Change& change) {
  DenoiseModel model = small_model(1);
  change(model);
  return refusal(write_denoise_model(model));
}

std::string misfit(const std::string& what) {
  return "m: expected parts that fit together, found " + what;
}

/// Any model that is accepted must run, and give answers of the right size.
void check_sound(const std::string& bytes) {
  auto model = read_denoise_model(bytes, "m");
  if (!model) return;
  auto denoiser = Denoiser::make(*std::move(model));
  if (!denoiser) return;
  const std::size_t joints = denoiser->model().layout.inputs.size();
  const JointFrames body{joints, std::vector<float>(6 * joints, 0.5F),
                         std::vector<std::uint8_t>(2 * joints, 2)};
  const Denoised out = denoiser->clean(body);
  CHECK(out.positions.size() == 2 * denoiser->model().layout.answers());
}

}  // namespace

TEST_CASE("model file: write, read, the same") {
  DenoiseModel model = small_model(7);
  model.layout.smoothing.causal = true;
  model.answer_scale = 0.3;
  model.spread_factor = 1.25;
  model.steadying = {false, {.window = 5, .order = 3}, false};
  model.second = Architecture{15, {layer(LayerKind::linear, 15)}};
  for (auto& [name, tensor] : random_tensors(*model.second, 3)) {
    model.tensors["second." + name] = tensor;
  }
  const std::string bytes = write_denoise_model(model);
  const auto again = read_denoise_model(bytes, "m");
  REQUIRE(again);
  CHECK(write_denoise_model(*again) == bytes);
  CHECK(again->facts.training == model.facts.training);
  CHECK(again->facts.metrics == model.facts.metrics);
  CHECK(again->facts.method == "refine");
  CHECK(again->layout.inputs == model.layout.inputs);
  CHECK(again->layout.bases == model.layout.bases);
  CHECK(again->layout.parents == model.layout.parents);
  CHECK(again->layout.smoothing == model.layout.smoothing);
  CHECK(again->steadying == model.steadying);
  CHECK(again->spread_factor == 1.25);
  CHECK(again->architecture == model.architecture);
  CHECK(again->second == model.second);
  CHECK(again->tensors == model.tensors);
  CHECK(again->input_scale == model.input_scale);
}

TEST_CASE("model file: a file of another kind is refused") {
  const std::string other =
      "m: expected a model of kinalign (schema kinalign.model/1), found a file of another kind";
  CHECK_FALSE(read_denoise_model("", "m"));
  CHECK(refusal(write_safetensors({})) == other);
  CHECK(header_refusal([](Json& h) { h["schema"] = "kinalign.model/2"; }) == other);
  CHECK(header_refusal([](Json& h) { h["schema"] = 1; }) == other);
  CHECK(header_refusal([](Json& h) { h = Json::array(); }) == other);
  CHECK(header_refusal([](Json& h) { h["task"] = "pose"; }) ==
        "m: expected a model that cleans skeletons, found task pose");
}

TEST_CASE("model file: each part that does not fit is named") {
  CHECK(header_refusal([](Json& h) { h["output"]["parents"] = {-1, 0}; }) == misfit("parents"));
  CHECK(header_refusal([](Json& h) { h["output"]["parents"][1] = 5; }) == misfit("parents"));
  CHECK(header_refusal([](Json& h) { h["output"]["parents"][1] = -2; }) == misfit("parents"));
  CHECK(header_refusal([](Json& h) {
          h["output"]["parents"] = {1, 0, 0, 1, 2};
        }) == misfit("parents in a circle"));
  CHECK(header_refusal([](Json& h) { h["output"]["bases"][0] = 5; }) == misfit("bases"));
  CHECK(header_refusal([](Json& h) { h["output"]["joints"] = Json::array(); }) ==
        misfit("number of joints"));
  CHECK(header_refusal([](Json& h) { h["output"]["joints"][1] = "SpineBase"; }) ==
        misfit("a joint twice"));
  CHECK(header_refusal([](Json& h) { h["input"]["joints"][2] = "HipMiddle"; }) ==
        misfit("input without a root or both hips"));
  CHECK(header_refusal([](Json& h) { h["rate_hz"] = 0; }) == misfit("rate_hz"));
  CHECK(header_refusal([](Json& h) { h["rate_hz"] = -30; }) == misfit("rate_hz"));
  CHECK(header_refusal([](Json& h) { h["output"]["scale_m"] = 0; }) == misfit("scale_m"));
  CHECK(header_refusal([](Json& h) { h["output"]["spread_factor"] = 1e300; }) ==
        misfit("spread_factor"));
  for (const char* where : {"input", "steadying"}) {
    CHECK(header_refusal([&](Json& h) { h[where]["smoothing"]["window"] = 8; }) ==
          misfit("smoothing"));
    CHECK(header_refusal([&](Json& h) { h[where]["smoothing"]["window"] = -1; }) ==
          misfit("smoothing"));
    CHECK(header_refusal([&](Json& h) { h[where]["smoothing"]["order"] = 6; }) ==
          misfit("smoothing"));
  }
}

TEST_CASE("model file: rows of numbers must be there, whole and finite") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(model_refusal([](DenoiseModel& m) { m.input_mean.pop_back(); }) == misfit("input.mean"));
  CHECK(model_refusal([](DenoiseModel& m) { m.input_scale.pop_back(); }) == misfit("input.scale"));
  CHECK(model_refusal([](DenoiseModel& m) { m.answer_mean.pop_back(); }) == misfit("answer.mean"));
  CHECK(model_refusal([](DenoiseModel& m) { m.input_scale[3] = 0.0F; }) == misfit("input.scale"));
  CHECK(model_refusal([&](DenoiseModel& m) { m.input_scale[3] = nan; }) == misfit("input.scale"));
  CHECK(model_refusal([&](DenoiseModel& m) { m.input_mean[3] = nan; }) == misfit("input.mean"));
  CHECK(model_refusal([&](DenoiseModel& m) { m.answer_mean[3] = nan; }) == misfit("answer.mean"));
  auto file = read_safetensors(write_denoise_model(small_model(1)), "m");
  REQUIRE(file);
  file->tensors.erase("input.scale");
  CHECK(refusal(write_safetensors(*file)) == "m: expected a tensor input.scale, found none");
}

TEST_CASE("model file: members of another type or name are refused") {
  for (const char* key :
       {"task", "method", "rate_hz", "input", "output", "steadying", "networks"}) {
    CAPTURE(key);
    CHECK(header_refusal([&](Json& h) {
            h.erase(key);
          }).starts_with("m: expected a complete header"));
    CHECK(header_refusal([&](Json& h) {
            h[key] = Json::array({true});
          }).starts_with("m: expected a complete header"));
  }
  CHECK(header_refusal([](Json& h) { h["networks"]["net"]["layers"][0]["kind"] = "magic"; }) !=
        "no error");
}

TEST_CASE("model: networks must fit the joints") {
  CHECK(model_refusal([](DenoiseModel& m) { m.states_spread = false; }) ==
        "expected 35 channels in and 15 out, found 35 and 20");
  CHECK(model_refusal([](DenoiseModel& m) { m.tensors.clear(); }) ==
        "expected tensor 0.weight [20,35], found none");
  CHECK(model_refusal([](DenoiseModel& m) {
          m.second = Architecture{15, {{.kind = LayerKind::slice, .out = 14}}};
        }) == "expected 15 channels in and 15 out, found 15 and 14");
  CHECK(model_refusal([](DenoiseModel& m) {
          m.architecture.layers.push_back(layer(LayerKind::max_pool));
        }) == "expected a network with as many frames out as in, found a max_pool without unpool");
}

TEST_CASE("model file: each byte of the header changed is refused or a sound model") {
  const std::string bytes = write_denoise_model(small_model(1));
  std::size_t header = 8;
  for (std::size_t i = 0; i < 8; ++i) {
    header += static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  REQUIRE(header < bytes.size());
  for (std::size_t at = 0; at < header; ++at) {
    CAPTURE(at);
    for (const char other : {'\0', '9', '"', '-', static_cast<char>(bytes[at] ^ 1)}) {
      if (other == bytes[at]) continue;
      std::string altered = bytes;
      altered[at] = other;
      check_sound(altered);
    }
  }
  for (std::size_t size = 0; size < bytes.size(); size += 7) check_sound(bytes.substr(0, size));
}

TEST_CASE("denoiser: with weights of 0 the answer is the smoothed input") {
  Denoiser denoiser = denoiser_of(small_model(0));
  JointFrames body = moving_legs(40, 1);
  const Denoised answer = denoiser.answer(body);
  smooth(denoiser.model().layout.smoothing, 15, body.positions);
  REQUIRE(answer.positions.size() == body.positions.size());
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    CHECK(std::abs(answer.positions[i] - body.positions[i]) < 2e-6F);
  }
}

TEST_CASE("denoiser: the answer is base + mean + scale x network, the spread e^network cm") {
  DenoiseModel model = small_model(0);
  model.layout.bases.assign(5, -1);               // the root
  model.answer_mean[3] = 0.2F;                    // HipLeft, to the body's left
  model.tensors["net.0.bias"].values[4] = 2.0F;   // HipLeft, up
  model.tensors["net.0.bias"].values[15] = 0.5F;  // spread of SpineBase
  model.answer_scale = 0.1;
  model.spread_factor = 2.0;
  Denoiser denoiser = denoiser_of(model);
  const JointFrames body = moving_legs(20, 1);
  const Denoised answer = denoiser.answer(body);
  for (std::size_t t = 0; t < 20; ++t) {
    const float* root = &answer.positions[15 * t];
    CHECK(std::abs(std::hypot(root[3] - root[0], root[5] - root[2]) - 0.2F) < 1e-6F);
    CHECK(std::abs(root[4] - root[1] - 0.2F) < 1e-6F);
    CHECK(answer.spread[5 * t] == doctest::Approx(0.02 * std::exp(0.5)).epsilon(1e-6));
    CHECK(answer.spread[5 * t + 1] == doctest::Approx(0.02).epsilon(1e-6));
  }
}

TEST_CASE("denoiser: a mirrored body has the mirrored answer") {
  Denoiser denoiser = denoiser_of(small_model(5));
  const auto partners = mirror_partners(leg_names());
  const JointFrames body = moving_legs(30, 2);
  JointFrames other = body;
  mirror(other, partners);
  const Denoised a = denoiser.clean(body);
  Denoised b = denoiser.clean(other);
  mirror_positions(b.positions, partners);
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    CHECK(std::abs(a.positions[i] - b.positions[i]) < 1e-5F);
  }
  const Denoised plain = denoiser.answer(body), mirrored = denoiser.answer(other);
  // The network itself is not mirror-symmetric.
  CHECK(std::abs(plain.positions[0] + mirrored.positions[0]) > 1e-4F);
}

TEST_CASE("denoiser: what is cleaned has bones of constant length") {
  Denoiser denoiser = denoiser_of(small_model(5));
  const Denoised out = denoiser.clean(moving_legs(30, 2));
  const auto& parents = denoiser.model().layout.parents;
  for (std::size_t j = 1; j < 5; ++j) {
    const auto p = static_cast<std::size_t>(parents[j]);
    const auto length = [&](std::size_t t) {
      const float* a = &out.positions[15 * t + 3 * p];
      const float* b = &out.positions[15 * t + 3 * j];
      return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    for (std::size_t t = 1; t < 30; ++t) CHECK(std::abs(length(t) - length(0)) < 1e-6F);
  }
}

TEST_CASE("denoiser: a second network gets the answers in the body's frame") {
  DenoiseModel model = small_model(5);
  model.states_spread = false;
  model.architecture.layers[0].out = 15;
  model.tensors.clear();
  for (auto& [name, tensor] : random_tensors(model.architecture, 5)) {
    model.tensors["net." + name] = tensor;
  }
  Denoiser alone = denoiser_of(model);
  model.second = Architecture{15, {layer(LayerKind::linear, 15)}};
  Tensor identity{{15, 15}, std::vector<float>(225, 0.0F)};
  for (std::size_t i = 0; i < 15; ++i) identity.values[16 * i] = 1.0F;
  model.tensors["second.0.weight"] = identity;
  model.tensors["second.0.bias"] = {{15}, std::vector<float>(15, 0.0F)};
  Denoiser both = denoiser_of(model);
  const JointFrames body = moving_legs(10, 2);
  const auto a = alone.answer(body).positions, b = both.answer(body).positions;
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) < 1e-6F);
}

TEST_CASE("denoiser: one frame, or none, gives one, or none") {
  Denoiser denoiser = denoiser_of(small_model(5));
  CHECK(denoiser.clean(moving_legs(1, 2)).positions.size() == 15);
  CHECK(denoiser.clean(moving_legs(0, 2)).positions.empty());
}
