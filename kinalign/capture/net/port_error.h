// SPDX-License-Identifier: Apache-2.0
// Adds the device's name to the error of a port that could not be opened. Users know devices by
// name, not by port number.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <utility>

namespace kinalign {

/// Returns the error with the device's name in place of the address and port. Example: "mocap:
/// expected a UDP port to serve on at 0.0.0.0:7012, found a port that another program uses".
template <class T>
Result<T> with_name(const std::string& name, Result<T> opened) {
  return std::move(opened).map_error([&name](Error error) {
    if (!error.file.empty()) error.expected += " at " + error.file;
    error.file = name;
    return error;
  });
}

}  // namespace kinalign
