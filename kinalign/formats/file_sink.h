// SPDX-License-Identifier: Apache-2.0
// Target to which a format's writer hands the bytes of a file, in the file's order.
// The sink may keep, hash or write the bytes; they are valid during the call only.
#pragma once

#include "kinalign/core/error.h"

#include <functional>
#include <string_view>

namespace kinalign {

using FileSink = std::function<Result<void>(std::string_view bytes)>;

}  // namespace kinalign
