// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_cleaner.h"

#include "tests/models/small_model.h"

using namespace kinalign;

TEST_CASE("a frame that waits for all that it depends on is cleaned as in the whole sequence") {
  DenoiseModel model = small_model(1);
  model.architecture = {35, {{.kind = LayerKind::conv, .out = 20, .kernel = 5}}};
  model.tensors.clear();
  for (auto& [name, tensor] : random_tensors(model.architecture, 1)) {
    model.tensors["net." + name] = tensor;
  }
  // The whole sequence has other bone lengths than its last ten seconds.
  model.steadying.bones = false;
  Denoiser denoiser = denoiser_of(model);
  JointFrames body = moving_legs(120, 1);
  for (std::size_t t = 40; t < 48; ++t) {  // a knee is lost
    body.seen[5 * t + 3] = 0;
    std::fill_n(&body.positions[15 * t + 9], 3, 0.0F);
  }
  const std::vector<float> whole = denoiser.clean(body).positions;
  LiveCleaner live(denoiser, 100);
  CHECK(live.look_ahead() == 2 + 4 + 5);  // network, smoothing of the input and of the answer
  for (std::size_t newest = 0; newest < 120; ++newest) {
    const auto at = static_cast<std::ptrdiff_t>(newest);
    const auto found =
        live.step({5,
                   {body.positions.begin() + 15 * at, body.positions.begin() + 15 * at + 15},
                   {body.seen.begin() + 5 * at, body.seen.begin() + 5 * at + 5}});
    REQUIRE(found.has_value() == (newest >= 11));
    if (newest < 11 + 5) continue;              // at the begin smoothing needs more later frames
    if (newest >= 40 && newest < 48) continue;  // the knee's position is not known
    const float* expected = &whole[15 * (newest - 11)];
    for (std::size_t i = 0; i < 15; ++i) {
      CAPTURE(newest);
      CHECK((*found)[i] == doctest::Approx(expected[i]).epsilon(1e-5));
    }
  }
}
