// SPDX-License-Identifier: Apache-2.0
// A lab's messages written into an MCAP file as fast as that goes: chunks of 1 MiB, uncompressed,
// with checksums and index. Run by mcap_write.py beside the same in @mcap/core.
//   mcap_write FILE MESSAGES          prints the seconds that it took
#include "kinalign/core/growing_file.h"
#include "kinalign/mcap/writer.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace kinalign;

/// The messages of one second of a lab: 100 of each of five nodes, 125 of mocap, 30 of a Kinect.
std::vector<std::pair<std::uint16_t, std::string>> second_of_a_lab() {
  std::mt19937 random(1);
  const auto payload = [&](std::size_t size) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    return bytes;
  };
  std::vector<std::pair<std::uint16_t, std::string>> out;
  for (int k = 0; k < 500; ++k)
    out.emplace_back(static_cast<std::uint16_t>(3 + k % 5), payload(61));
  for (int k = 0; k < 125; ++k) out.emplace_back(std::uint16_t{1}, payload(1480));
  for (int k = 0; k < 30; ++k) out.emplace_back(std::uint16_t{2}, payload(413));
  std::shuffle(out.begin(), out.end(), random);
  return out;
}

Result<void> write_all(const std::string& path, std::uint64_t count) {
  constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
  PosixFiles files;
  GrowingFile file = KA_TRY(GrowingFile::create(files, path));
  McapWriter writer({[&](std::string_view bytes) { return file.append(bytes); },
                     [&](std::uint64_t at, std::span<char> to) { return file.read_at(at, to); }});
  KA_TRY(writer.begin({"", "bench"}));
  const auto messages = second_of_a_lab();
  McapChunkContent chunk;
  std::uint64_t in_chunk = 0;  // channels with messages in the chunk, one bit each
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto& [channel, payload] = messages[k % messages.size()];
    if ((in_chunk >> channel & 1U) == 0) {
      chunk.add(McapChannel{channel, 0, "/topic" + std::to_string(channel), "raw", {}});
      in_chunk |= std::uint64_t{1} << channel;
    }
    chunk.add(
        McapMessage{channel, static_cast<std::uint32_t>(k), 1'000'000 * k, 1'000'000 * k, payload});
    if (chunk.size() < chunk_bytes && k + 1 < count) continue;
    KA_TRY(writer.write(store(chunk, McapCompression::none)));
    chunk = {};
    in_chunk = 0;
  }
  KA_TRY(writer.finish());
  file.close();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto begin = std::chrono::steady_clock::now();
  const auto written = write_all(argv[1], std::strtoull(argv[2], nullptr, 10));
  if (!written) {
    std::fprintf(stderr, "%s\n", to_string(written.error()).c_str());
    return 1;
  }
  std::printf("%.6f\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  return 0;
}
