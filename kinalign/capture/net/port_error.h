// SPDX-License-Identifier: Apache-2.0
// Whose port it is that could not be opened: nobody knows a device by its port's number.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <utility>

namespace kinalign {

/// "mocap: expected a UDP port to serve on at 0.0.0.0:7012, found another program on it": the
/// device's name in the place of the address and port.
template <class T>
Result<T> told_of(const std::string& name, Result<T> opened) {
  return std::move(opened).map_error([&name](Error error) {
    if (!error.file.empty()) error.expected += " at " + error.file;
    error.file = name;
    return error;
  });
}

}  // namespace kinalign
