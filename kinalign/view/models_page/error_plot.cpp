// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/error_plot.h"

#include "kinalign/view/page/page_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace kinalign {

namespace {

// The picture is scaled with the page, so these lengths are proportions.
constexpr float plot_left = 46, plot_top = 10, plot_wide = 820, plot_high = 250;  // units
constexpr std::size_t curve_colours = 12;  // .c0 to .c11 of assets/models.css

/// Returns a step of 1, 2 or 5 times a power of ten that divides a length into 4 to 10 parts. Steps
/// are tried from the coarsest to the finest; the first that gives four parts is used.
float step_for(float length) {
  const float power = std::pow(10.0F, std::floor(std::log10(length / 4.0F)));
  for (const float times : {5.0F, 2.0F}) {
    if (times * power * 4.0F <= length) return times * power;
  }
  return power;
}

/// Returns the numbers on an axis from 0 to `length`.
std::vector<float> marks_up_to(float length) {
  const float step = step_for(length);
  std::vector<float> out;
  for (int i = 0; static_cast<float>(i) * step <= length * 1.001F; ++i) {
    out.push_back(static_cast<float>(i) * step);
  }
  return out;
}

/// Converts seconds and centimetres to positions in the picture. Both axes begin at 0, so that
/// errors can be compared visually.
struct Axes {
  float seconds = 1.0F, cm = 1.0F;  // values at the right and at the upper end

  float x(float s) const { return plot_left + plot_wide * s / seconds; }
  float y(float value) const { return plot_top + plot_high * (1.0F - value / cm); }
};

/// Returns axes that contain all curves, rounded up to a whole step.
Axes axes_of(const ErrorPlot& plot) {
  Axes out{plot.step_s, 1.0F};
  for (const ErrorCurve& curve : plot.curves) {
    out.seconds = std::max(out.seconds, plot.step_s * static_cast<float>(curve.cm.size()));
    for (const float value : curve.cm) out.cm = std::max(out.cm, value);
  }
  const float step = step_for(out.cm);
  // The axis is rounded up, so that the highest curve is below the top grid line.
  out.cm = step * std::ceil(out.cm / step);
  return out;
}

/// Returns the grid lines, numbers and titles of both axes.
std::string grid_of(const Axes& axes) {
  std::string out;
  for (const float value : marks_up_to(axes.cm)) {
    out += fmt::format(
        "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}H{2:.1f}\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:g}</text>",
        plot_left, axes.y(value), plot_left + plot_wide, plot_left - 6, axes.y(value) + 4, value);
  }
  for (const float s : marks_up_to(axes.seconds)) {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:g}</text>",
                       axes.x(s), plot_top + plot_high + 18, s);
  }
  return out + fmt::format(
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">time in the take, "
                   "s</text><text transform=\"translate(12 {:.1f}) rotate(-90)\" "
                   "text-anchor=\"middle\">position error, cm</text>",
                   plot_left + plot_wide / 2, plot_top + plot_high + 36, plot_top + plot_high / 2);
}

/// Returns the path of one curve through all its values.
std::string line_of(const ErrorCurve& curve, const ErrorPlot& plot, const Axes& axes) {
  std::string out;
  for (std::size_t k = 0; k < curve.cm.size(); ++k) {
    // A value covers a whole step, so its point is in the middle of the step.
    const float s = plot.step_s * (static_cast<float>(k) + 0.5F);
    out += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", axes.x(s), axes.y(curve.cm[k]));
  }
  return out;
}

}  // namespace

std::string error_plot_html(const ErrorPlot& plot) {
  if (plot.curves.empty()) return "";
  const Axes axes = axes_of(plot);
  std::string svg = fmt::format(
      "<svg class=\"errors\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" aria-label=\"position error "
      "over time\">{}",
      plot_left + plot_wide + 14, plot_top + plot_high + 42, grid_of(axes));
  std::string legend = "<p class=\"legend\">";
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    // If there are more methods than colours, colours are used again.
    const std::size_t colour = i % curve_colours;
    svg +=
        fmt::format("<path class=\"c{}\" d=\"{}\"/>", colour, line_of(plot.curves[i], plot, axes));
    legend += fmt::format(
        "<span><svg class=\"key\" viewBox=\"0 0 26 8\"><path class=\"c{}\" "
        "d=\"M1 4H25\"/></svg>{}</span>",
        colour, escaped(plot.curves[i].method));
  }
  return "<figure><div class=\"scroll\">" + svg + "</svg></div>" + legend + "</p><figcaption>" +
         escaped(plot.caption) + "</figcaption></figure>\n";
}

}  // namespace kinalign
