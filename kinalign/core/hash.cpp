// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/hash.h"

#include "kinalign/wire/hex.h"

#include <openssl/evp.h>

#include <array>
#include <cstdlib>

namespace kinalign {

/// Owns OpenSSL's context. A context can't be copied by assignment, so a State is never copied.
struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();

  State() {
    // Both calls fail only without memory or if the library lacks SHA-256. No file could be
    // verified then.
    if (context == nullptr || EVP_DigestInit_ex(context, EVP_sha256(), nullptr) != 1) std::abort();
  }
  State(const State&) = delete;
  State(State&&) = delete;
  State& operator=(const State&) = delete;
  State& operator=(State&&) = delete;
  ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

void Sha256::update(std::string_view bytes) {
  if (EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()) != 1) std::abort();
}

std::string Sha256::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_DigestFinal_ex(state_->context, digest.data(), &size) != 1) std::abort();
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
