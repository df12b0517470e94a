// SPDX-License-Identifier: Apache-2.0
// Prints the contents of an XDF file as libxdf (Debian's libxdf-dev) reads them, for
// tests/formats/xdf/libxdf_test.cpp: a line for each stream, "stream NAME CHANNELS", and one for
// each of its samples, the corrected stamp and the values, which libxdf keeps as floats. It stores
// text elsewhere, so streams of text have no samples.
#include <xdf.h>

#include <cstdio>

int main(int count, char** words) {
  Xdf file;
  if (count != 2 || file.load_xdf(words[1]) != 0) return 1;
  for (const auto& stream : file.streams) {
    std::printf("stream %s %d\n", stream.info.name.c_str(), stream.info.channel_count);
    for (std::size_t t = 0; t < stream.time_stamps.size(); ++t) {
      std::printf("%.17g", stream.time_stamps[t]);
      for (const auto& channel : stream.time_series) std::printf(" %.9g", channel.at(t));
      std::printf("\n");
    }
  }
  return 0;
}
