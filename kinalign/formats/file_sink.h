// SPDX-License-Identifier: Apache-2.0
// Where writers of formats put the bytes of a file, in its order.
#pragma once

#include "kinalign/core/error.h"

#include <functional>
#include <string_view>

namespace kinalign {

using FileSink = std::function<Result<void>(std::string_view bytes)>;

}  // namespace kinalign
