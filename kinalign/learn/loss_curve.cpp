// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/loss_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace kinalign {

namespace {

// In the picture's units. `right` and `left` are wide enough for the labels of both axes.
constexpr double width = 640.0, height = 320.0, left = 70.0, right = 70.0, top = 40.0,
                 bottom = 45.0;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Escapes any text for XML.
std::string within_xml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

/// Maps values to the picture's height.
struct Axis {
  double least = 0.0, most = 1.0;

  // Values grow upwards, and y of SVG grows downwards. If all values are equal, they lie at the
  // bottom.
  double at(double value) const {
    const double span = most > least ? most - least : 1.0;
    return height - bottom - (value - least) / span * (height - top - bottom);
  }
};

/// One value at a step.
struct CurvePoint {
  double step, value;
};

Axis axis_of(const std::vector<CurvePoint>& points) {
  Axis out;
  if (points.empty()) return out;
  const auto [least, most] = std::minmax_element(
      points.begin(), points.end(),
      [](const CurvePoint& a, const CurvePoint& b) { return a.value < b.value; });
  return {least->value, most->value};
}

std::string line_of(const std::vector<CurvePoint>& points, const Axis& axis, double last_step,
                    const char* colour) {
  std::string out = "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" + std::string(colour) +
                    "\" points=\"";
  for (const CurvePoint& one : points) {
    out += number(left + one.step / last_step * (width - left - right)) + "," +
           number(axis.at(one.value)) + " ";
  }
  return out + "\"/>\n";
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const char* colour = "#333") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor +
         "\" fill=\"" + colour + "\">" + within_xml(text) + "</text>\n";
}

}  // namespace

std::string loss_curve(const std::vector<TrainingPoint>& points, const std::string& title) {
  std::vector<CurvePoint> losses, judgements;
  double last_step = 1.0;
  for (const TrainingPoint& one : points) {
    const double step = static_cast<double>(one.step);
    last_step = std::max(last_step, step);
    // A loss with a likelihood can be negative; such points have no logarithm and are left out.
    if (one.loss > 0.0) losses.push_back({step, std::log10(one.loss)});
    if (one.judgement) judgements.push_back({step, *one.judgement});
  }
  const Axis loss = axis_of(losses), judged = axis_of(judgements);
  const char *red = "#b3261e", *blue = "#1f5fa8";
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 320\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"640\" height=\"320\" fill=\"#fff\"/>\n";
  out += "<path fill=\"none\" stroke=\"#888\" d=\"M70 40V275H570V40\"/>\n";
  out += text_at(width / 2, 22.0, "middle", title);
  out += text_at(width / 2, height - 10.0, "middle", "step");
  out += text_at(left, height - bottom + 18.0, "middle", "0");
  out += text_at(width - right, height - bottom + 18.0, "middle", number(last_step));
  if (!losses.empty()) {
    out += text_at(left - 6.0, top + 4.0, "end", number(std::pow(10.0, loss.most)), red);
    out += text_at(left - 6.0, height - bottom, "end", number(std::pow(10.0, loss.least)), red);
    out += text_at(left - 6.0, height / 2, "end", "loss", red);
    out += line_of(losses, loss, last_step, red);
  }
  if (!judgements.empty()) {
    out += text_at(width - right + 6.0, top + 4.0, "start", number(judged.most), blue);
    out += text_at(width - right + 6.0, height - bottom, "start", number(judged.least), blue);
    out += text_at(width - right + 6.0, height / 2, "start", "validation", blue);
    out += line_of(judgements, judged, last_step, blue);
  }
  return out + "</svg>\n";
}

}  // namespace kinalign
