// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/hash.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string sha256(std::string_view bytes, std::size_t piece) {
  Sha256 hash;
  for (std::size_t i = 0; i < bytes.size(); i += piece) hash.update(bytes.substr(i, piece));
  return hash.hex();
}

}  // namespace

TEST_CASE("SHA-256 gives the digests of FIPS 180-4's examples") {
  CHECK(sha256("", 1) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc", 3) == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 56) ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1000000, 'a'), 1000000) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 does not depend on the pieces") {
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i * 37);
  const std::string whole = sha256(bytes, bytes.size());
  for (const std::size_t piece : {1, 2, 3, 63, 64, 65, 999}) CHECK(sha256(bytes, piece) == whole);
}

TEST_CASE("a hash can be moved while it is under way") {
  Sha256 first;
  first.update("a");
  Sha256 second = std::move(first);
  second.update("bc");
  CHECK(second.hex() == sha256("abc", 3));
}
