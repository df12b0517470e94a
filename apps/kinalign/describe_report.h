// SPDX-License-Identifier: Apache-2.0
// A take's facts and its report as lines for people. The report may come from outside: nothing in
// it is trusted, what is not of its type is left out.
#pragma once

#include <string>

namespace kinalign {

/// `json`: what `kinalign info take.h5 --json` prints.
std::string take_text(const std::string& json);

}  // namespace kinalign
