// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/siphash.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>
#include <openssl/evp.h>
#include <openssl/params.h>

#include <array>
#include <memory>
#include <vector>

using namespace kinalign;

namespace {

/// Keys 00 01 .. 0f and messages 00 01 .. (n-1), as in the reference's vectors.
std::uint64_t of_counted_bytes(std::size_t n) {
  SipHashKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(i);
  std::vector<std::uint8_t> message(n);
  for (std::size_t i = 0; i < n; ++i) message[i] = static_cast<std::uint8_t>(i);
  return siphash_2_4(key, message);
}

std::uint64_t of_openssl(const SipHashKey& key, const std::vector<std::uint8_t>& message) {
  const std::unique_ptr<EVP_MAC, void (*)(EVP_MAC*)> mac(EVP_MAC_fetch(nullptr, "SIPHASH", nullptr),
                                                         EVP_MAC_free);
  const std::unique_ptr<EVP_MAC_CTX, void (*)(EVP_MAC_CTX*)> context(EVP_MAC_CTX_new(mac.get()),
                                                                     EVP_MAC_CTX_free);
  std::size_t size = 8;
  const OSSL_PARAM parameters[] = {OSSL_PARAM_construct_size_t("size", &size),
                                   OSSL_PARAM_construct_end()};
  std::array<std::uint8_t, 8> out{};
  REQUIRE(EVP_MAC_init(context.get(), key.data(), key.size(), parameters) == 1);
  REQUIRE(EVP_MAC_update(context.get(), message.data(), message.size()) == 1);
  REQUIRE(EVP_MAC_final(context.get(), out.data(), &size, out.size()) == 1);
  REQUIRE(size == 8);
  std::uint64_t value = 0;
  for (std::size_t i = 8; i-- > 0;) value = value << 8 | out[i];
  return value;
}

}  // namespace

TEST_CASE("SipHash-2-4 gives the vectors of its authors") {
  // github.com/veorq/SipHash, vectors_sip64; the value for 15 bytes is from appendix A of the
  // paper.
  CHECK(of_counted_bytes(0) == 0x726fdb47dd0e0e31);
  CHECK(of_counted_bytes(1) == 0x74f839c593dc67fd);
  CHECK(of_counted_bytes(7) == 0xab0200f58b01d137);
  CHECK(of_counted_bytes(8) == 0x93f5f5799a932462);
  CHECK(of_counted_bytes(9) == 0x9e0082df0ba9e4b0);
  CHECK(of_counted_bytes(15) == 0xa129ca6149be45e5);
  CHECK(of_counted_bytes(16) == 0x3f2acc7f57c29bdb);
  CHECK(of_counted_bytes(31) == 0x32d892fad841c342);
  CHECK(of_counted_bytes(32) == 0x7127512f72f27cce);
  CHECK(of_counted_bytes(62) == 0xe51b38608ef25f57);
  CHECK(of_counted_bytes(63) == 0x958a324ceb064572);
}

TEST_CASE("SipHash-2-4 agrees with OpenSSL's at any length") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    SipHashKey key{};
    for (auto& byte : key) byte = static_cast<std::uint8_t>(random());
    std::vector<std::uint8_t> message(random() % 1500);
    for (auto& byte : message) byte = static_cast<std::uint8_t>(random());
    CHECK(siphash_2_4(key, message) == of_openssl(key, message));
  }
}
