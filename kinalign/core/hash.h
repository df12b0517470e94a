// SPDX-License-Identifier: Apache-2.0
// SHA-256 (FIPS 180-4) of bytes that arrive in pieces.
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX; only hash.cpp includes OpenSSL

namespace kinalign {

class Sha256 {
 public:
  Sha256();

  void update(std::string_view bytes);
  /// Ends the hash and returns 64 lower-case hexadecimal digits.
  std::string hex();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

}  // namespace kinalign
