// SPDX-License-Identifier: Apache-2.0
// What is in a model's file, as lines for people and as JSON.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include <string>
#include <string_view>

namespace kinalign {

inline constexpr std::size_t most_model_bytes = std::size_t{1} << 30U;

/// `bytes`: of the whole file. Fails where they are no model of kinalign, or one that can't be
/// used.
Result<Description> describe_model(const std::string& path, std::string_view bytes);

/// The error of a model that can't be used, with its file.
template <class Usable>
Result<void> check_usable(const Result<Usable>& usable, const std::string& path) {
  if (usable) return {};
  Error error = usable.error();
  error.file = path;
  return Failure(std::move(error));
}

}  // namespace kinalign
