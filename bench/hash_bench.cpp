// SPDX-License-Identifier: Apache-2.0
// Checking every byte of a warm 64 MB file: InputFile and Sha256 against read() and OpenSSL alone.
#include "kinalign/core/files.h"
#include "kinalign/core/hash.h"

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::size_t piece = std::size_t{256} << 10, pieces = 256;

class WarmFile {
 public:
  WarmFile() : path_(std::filesystem::temp_directory_path() / "kinalign_hash_bench") {
    const std::string bytes(piece, 'k');
    std::ofstream file(path_, std::ios::binary);
    for (std::size_t i = 0; i < pieces; ++i) file << bytes;
  }
  WarmFile(const WarmFile&) = delete;
  WarmFile& operator=(const WarmFile&) = delete;
  ~WarmFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void count(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(piece * pieces));
}

void openssl(benchmark::State& state) {
  const WarmFile file;
  std::vector<unsigned char> buffer(piece), digest(EVP_MAX_MD_SIZE);
  for (auto _ : state) {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    EVP_DigestInit_ex(context, EVP_sha256(), nullptr);
    const int fd = ::open(file.path().c_str(), O_RDONLY);
    ssize_t got = 0;
    while ((got = ::read(fd, buffer.data(), buffer.size())) > 0) {
      EVP_DigestUpdate(context, buffer.data(), static_cast<std::size_t>(got));
    }
    ::close(fd);
    EVP_DigestFinal_ex(context, digest.data(), nullptr);
    EVP_MD_CTX_free(context);
    benchmark::DoNotOptimize(digest.data());
  }
  count(state);
}

void ours(benchmark::State& state) {
  const WarmFile file;
  PosixFiles files;
  for (auto _ : state) {
    Sha256 hash;
    auto input = InputFile::open(files, file.path());
    if (!input) std::abort();
    for (auto next = input->next(); next && !next->empty(); next = input->next()) {
      hash.update(*next);
    }
    benchmark::DoNotOptimize(hash.hex());
  }
  count(state);
}

BENCHMARK(openssl)->Name("sha256/read_and_openssl")->Unit(benchmark::kMillisecond);
BENCHMARK(ours)->Name("sha256/kinalign")->Unit(benchmark::kMillisecond);

}  // namespace
