// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/point_rows.h"

#include <algorithm>
#include <cstdlib>

namespace kinalign {

PointUnits point_units(const PointUnits& of_format, const StreamOptions& options) {
  return {axes_of(of_format.axes, options),
          options.metres_per_unit > 0.0 ? options.metres_per_unit : of_format.metres};
}

void append_points(const PointUnits& units, const double* file, std::span<const Tracking> states,
                   PointFrames& out) {
  const std::size_t first = out.positions.size();
  out.positions.resize(first + 3 * states.size());
  out.state.insert(out.state.end(), states.begin(), states.end());
  const auto [x, y, z] = units.axes;
  const auto metres = [&](int axis) { return axis < 0 ? -units.metres : units.metres; };
  const double x_metres = metres(x), y_metres = metres(y), z_metres = metres(z);
  const double* from_x = file + std::abs(x) - 1;
  const double* from_y = file + std::abs(y) - 1;
  const double* from_z = file + std::abs(z) - 1;
  double* to = out.positions.data() + first;
  for (std::size_t j = 0; j < states.size(); ++j, to += 3) {
    // For a missing joint, resize() has set zeros already.
    if (states[j] == Tracking::missing) continue;
    to[0] = from_x[3 * j] * x_metres;
    to[1] = from_y[3 * j] * y_metres;
    to[2] = from_z[3 * j] * z_metres;
  }
}

MirrorWatch::MirrorWatch(const std::vector<std::string>& joint_names) {
  const auto index = [&](std::string_view name) {
    const auto at = std::find(joint_names.begin(), joint_names.end(), name);
    return static_cast<std::size_t>(at - joint_names.begin());
  };
  left_ = index("ShoulderLeft");
  right_ = index("ShoulderRight");
  present_ = std::max(left_, right_) < joint_names.size();
}

void MirrorWatch::watch(const double* positions, const Tracking* states) {
  if (!present_) return;
  if (states[left_] == Tracking::missing || states[right_] == Tracking::missing) return;
  ++rows_;
  mirrored_ += positions[3 * left_] > positions[3 * right_] ? 1 : 0;
}

void MirrorWatch::report(const std::string& file, Findings& findings) const {
  if (mirrored_ * 2 <= rows_) return;
  add_warning(findings,
              {file, 0, "the left shoulder at smaller x than the right one",
               "the left shoulder at larger x in " + std::to_string(mirrored_) + " of " +
                   std::to_string(rows_) + " rows"},
              "the file is mirrored, or the person stood with the back to the sensor",
              "if the file is mirrored, use a layout with x = \"-x\" and mirrored = true");
}

}  // namespace kinalign
