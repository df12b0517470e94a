// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/hash.h"

#include "kinalign/wire/hex.h"

#include <openssl/evp.h>

#include <array>
#include <cstdlib>

namespace kinalign {

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  // Both calls fail only without memory, or if the library lacks SHA-256. The program then can't
  // verify any file.
  if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) std::abort();
}

void Sha256::update(std::string_view bytes) {
  if (EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1) std::abort();
}

std::string Sha256::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_DigestFinal_ex(context_.get(), digest.data(), &size) != 1) std::abort();
  std::string text(std::size_t{2} * size, ' ');
  put_hex(std::span(digest).first(size), text);
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hex();
}

}  // namespace kinalign
