// SPDX-License-Identifier: Apache-2.0
// SHA-256 (FIPS 180-4) of bytes that arrive in pieces.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace kinalign {

/// The state is hidden in a pointer, so that only hash.cpp includes OpenSSL.
class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  ~Sha256();

  void update(std::string_view bytes);
  /// Ends the hash and returns 64 lower-case hexadecimal digits.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The hash of one text, in hexadecimal digits.
std::string sha256_of(std::string_view bytes);

}  // namespace kinalign
