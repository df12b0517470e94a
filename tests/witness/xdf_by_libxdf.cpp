// SPDX-License-Identifier: Apache-2.0
// What libxdf (Debian's libxdf-dev) reads of an XDF file, for tests/formats/xdf/libxdf_test.cpp: a
// line for each stream, "stream NAME CHANNELS", and one for each of its samples, the corrected
// stamp and the values, which it keeps as floats. It puts text aside, so streams of text have no
// samples.
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
