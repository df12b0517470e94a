// SPDX-License-Identifier: Apache-2.0
// The errors over time as an SVG with axes, units and a legend.
#pragma once

#include "kinalign/view/models_page/models_page.h"

#include <string>

namespace kinalign {

/// Returns a <figure> with one line for each method, each in a different colour. Empty if there are
/// no curves.
std::string error_plot_html(const ErrorPlot& plot);

}  // namespace kinalign
