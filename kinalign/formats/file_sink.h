// SPDX-License-Identifier: Apache-2.0
// A function that receives the bytes of a file from a format's writer, in the file's order. It may
// store, hash or write the bytes. They are valid during the call only.
#pragma once

#include "kinalign/core/error.h"

#include <functional>
#include <string_view>

namespace kinalign {

using FileSink = std::function<Result<void>(std::string_view bytes)>;

}  // namespace kinalign
