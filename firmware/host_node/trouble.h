// SPDX-License-Identifier: Apache-2.0
// The reason for which host_node does not go on, in one line for the user.
#pragma once

#include <tl/expected.hpp>

#include <string>

namespace kinalign {

struct Trouble {
  int exit_code = 3;  // 2: wrong use
  std::string text;
};

template <class T>
using Tried = tl::expected<T, Trouble>;

inline tl::unexpected<Trouble> wrong_use(std::string text) {
  return tl::unexpected(Trouble{2, std::move(text)});
}
inline tl::unexpected<Trouble> failure(std::string text) {
  return tl::unexpected(Trouble{3, std::move(text)});
}

}  // namespace kinalign
