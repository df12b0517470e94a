// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/side_by_side.h"

#include "kinalign/view/page/packed_series.h"
#include "kinalign/view/page/page_json.h"

#include <nlohmann/json.hpp>

#include <array>
#include <span>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// Rounding steps. Smaller differences are not visible.
constexpr double moving_step_m = 1e-3, moving_step_cm = 0.01;
// In the order of FigureColour. The script finds its colours by these words.
constexpr std::array<const char*, 5> colour_words{"truth", "kinect", "imu", "method", "both"};

}  // namespace

// The series are packed like those of a take, so the same script unpacks them.
std::string side_by_side_json(const SideBySide& motion) {
  Json bodies = Json::array();
  for (const MovingBody& body : motion.bodies) {
    const std::size_t joints = body.parents.size();
    Json one{{"name", body.name},
             {"colour", colour_words[static_cast<std::size_t>(body.colour)]},
             {"parents", body.parents},
             {"positions", series_json(body.positions, 3 * joints, moving_step_m)}};
    // Absent arrays mean that all joints are tracked and that no error is displayed.
    if (!body.states.empty()) one["states"] = series_json(body.states, joints);
    if (!body.cm.empty()) one["cm"] = series_json(body.cm, 1, moving_step_cm);
    bodies.push_back(std::move(one));
  }
  return safe_in_script(Json{{"rate_hz", motion.rate_hz}, {"bodies", std::move(bodies)}}.dump(
      -1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace kinalign
