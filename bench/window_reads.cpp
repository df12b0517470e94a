// SPDX-License-Identifier: Apache-2.0
// Opens takes and reads a window of each with our reader, every number checked. Run by
// window_reads.py, which reads the same windows with h5py.
// usage: window_reads ROWS [STREAM ARRAY] < lines of FIRST PATH; prints the seconds of each
#include "kinalign/formats/take/take_hdf5.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

int main(int count, char** arguments) {
  using namespace kinalign;
  using Clock = std::chrono::steady_clock;
  const std::uint64_t rows = std::strtoull(arguments[1], nullptr, 10);
  const TakeParts parts = count > 3 ? TakeParts{{arguments[2]}, {arguments[3]}} : TakeParts{};
  PosixFiles files;
  std::uint64_t first = 0;
  std::string path;
  TakeSlab slab;
  while (std::cin >> first && std::getline(std::cin >> std::ws, path)) {
    const auto start = Clock::now();
    auto reader = TakeReader::open(files, path, parts);
    if (!reader || !reader->read(first, rows, slab)) return 1;
    std::printf("%.9f\n", std::chrono::duration<double>(Clock::now() - start).count());
  }
}
