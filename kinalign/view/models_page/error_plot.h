// SPDX-License-Identifier: Apache-2.0
// Errors over time as an SVG with axes, units and a legend.
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>

namespace kinalign {

/// A <figure>; a line of its own colour for each method. Empty without curves.
std::string error_plot_html(const ErrorPlot& plot);

}  // namespace kinalign
