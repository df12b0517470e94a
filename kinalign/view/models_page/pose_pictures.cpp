// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/pose_pictures.h"

#include "kinalign/motion/streams.h"
#include "kinalign/view/page/page_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// A unit is a centimetre of the body. Positions are whole units, which keeps the page small.
constexpr float units_per_m = 100.0F;
constexpr int picture_margin = 8;  // units
constexpr double from_left_deg = 25.0, from_above_deg = 8.0;
constexpr float farthest_m = 10.0F;  // from the picture's origin; joints farther away are not drawn

constexpr std::array<std::string_view, 5> colour_names{"mocap", "kinect", "imu", "method", "both"};

/// A position in a picture: units to the right of the origin and above it.
struct Spot {
  int right = 0, up = 0;
};

/// Projects a position onto the picture by parallel projection.
Spot seen_from_camera(const float* place) {
  constexpr double degree = std::numbers::pi / 180.0;
  // Computed once, in the first call.
  static const auto side = static_cast<float>(std::sin(from_left_deg * degree)),
                    front = static_cast<float>(std::cos(from_left_deg * degree)),
                    above = static_cast<float>(std::sin(from_above_deg * degree)),
                    level = static_cast<float>(std::cos(from_above_deg * degree));
  // The position is rotated about the vertical and then tilted. There is no perspective, so lengths
  // can be compared.
  const float right = front * place[0] - side * place[2];
  const float near = side * place[0] + front * place[2];
  const float up = level * place[1] - above * near;
  return {static_cast<int>(std::lround(units_per_m * right)),
          static_cast<int>(std::lround(units_per_m * up))};
}

/// Returns whether a position is near enough. A distant joint would shrink all pictures of the
/// table.
bool is_near(const float* place) {
  return std::all_of(place, place + 3, [](float v) { return std::abs(v) < farthest_m; });
}

/// A bone in the picture.
struct Line {
  Spot from, to;
  bool inferred = false;
};

/// Returns the bones of a figure. A bone with a missing or distant end is omitted. Called twice for
/// each figure: for the common area, and for drawing.
std::vector<Line> lines_of(const StickFigure& figure) {
  const auto state = [&](std::size_t joint) {
    return figure.states.empty() ? Tracking::tracked : static_cast<Tracking>(figure.states[joint]);
  };
  std::vector<Line> out;
  for (std::size_t j = 0; j < figure.parents.size(); ++j) {
    if (figure.parents[j] < 0) continue;
    const auto p = static_cast<std::size_t>(figure.parents[j]);
    const float *from = &figure.positions[3 * p], *to = &figure.positions[3 * j];
    const Tracking least = std::min(state(j), state(p));
    if (least == Tracking::missing || !is_near(from) || !is_near(to)) continue;
    out.push_back({seen_from_camera(from), seen_from_camera(to), least == Tracking::inferred});
  }
  return out;
}

/// The area that all pictures of a table must show, in units. It always contains the origin, so a
/// picture without bones has a size too.
struct Bounds {
  int left = 0, right = 0, bottom = 0, top = 0;

  void add(const Spot& spot) {
    left = std::min(left, spot.right);
    right = std::max(right, spot.right);
    bottom = std::min(bottom, spot.up);
    top = std::max(top, spot.up);
  }
};

/// Returns the common area of all pictures, which gives them the same scale.
Bounds bounds_of(const PosePictures& pictures) {
  Bounds out;
  for (const auto& [name, row] : pictures.rows) {
    for (const PosePicture& picture : row) {
      for (const StickFigure& figure : picture.figures) {
        for (const Line& line : lines_of(figure)) {
          out.add(line.from);
          out.add(line.to);
        }
      }
    }
  }
  return out;
}

// In SVG, y points down; in positions, `up` points up.
std::string path_of(const std::vector<Line>& lines, bool inferred, const Bounds& bounds) {
  std::string out;
  for (const Line& line : lines) {
    if (line.inferred != inferred) continue;
    out += fmt::format("M{} {}L{} {}", line.from.right - bounds.left, bounds.top - line.from.up,
                       line.to.right - bounds.left, bounds.top - line.to.up);
  }
  return out;
}

/// Returns the figures of a picture. Each has one path for tracked and one for inferred bones.
std::string svg_of(const PosePicture& picture, const Bounds& bounds, const std::string& label) {
  std::string out =
      fmt::format("<svg viewBox=\"{} {} {} {}\" role=\"img\" aria-label=\"{}\">", -picture_margin,
                  -picture_margin, bounds.right - bounds.left + 2 * picture_margin,
                  bounds.top - bounds.bottom + 2 * picture_margin, escaped(label));
  for (const StickFigure& figure : picture.figures) {
    const auto lines = lines_of(figure);
    for (const bool inferred : {false, true}) {
      const std::string path = path_of(lines, inferred, bounds);
      if (path.empty()) continue;
      out += fmt::format("<path class=\"{}{}{}\" d=\"{}\"/>",
                         colour_names[static_cast<std::size_t>(figure.colour)],
                         figure.is_pale ? " pale" : "", inferred ? " dashed" : "", path);
    }
  }
  return out + "</svg>";
}

}  // namespace

std::string pictures_html(const PosePictures& pictures) {
  if (pictures.rows.empty()) return "";
  const Bounds bounds = bounds_of(pictures);
  std::string out = "<div class=\"scroll\"><table class=\"poses\"><thead><tr><th></th>";
  for (const auto& [what, where] : pictures.columns) {
    out += fmt::format("<th>{}<small>{}</small></th>", escaped(what), escaped(where));
  }
  out += "</tr></thead><tbody>";
  for (const auto& [name, row] : pictures.rows) {
    out += fmt::format("<tr><th>{}</th>", escaped(name));
    for (std::size_t c = 0; c < row.size(); ++c) {
      const PosePicture& picture = row[c];
      // The label describes the picture for screen readers.
      const std::string label =
          fmt::format("{}, {}: {}", name, pictures.columns[c].first, picture.below);
      out += fmt::format("<td>{}<small>{}</small></td>",
                         picture.figures.empty() ? "" : svg_of(picture, bounds, label),
                         escaped(picture.below));
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>";
}

}  // namespace kinalign
