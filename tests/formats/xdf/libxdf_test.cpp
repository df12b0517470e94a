// SPDX-License-Identifier: Apache-2.0
// XDF files compared with libxdf, an independent reader, which keeps floats.
#include "tests/folder.h"
#include "tests/formats/xdf/xdf_cases.h"
#include "tests/seeds.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <sstream>

using namespace kinalign;

namespace {

#ifdef KINALIGN_XDF_BY_LIBXDF
constexpr const char* libxdf = KINALIGN_XDF_BY_LIBXDF;
#else
constexpr const char* libxdf = "";
#endif

bool has_libxdf() { return *libxdf != '\0'; }

/// The rows that libxdf reads, [stream][row]: a stamp, then the values.
std::vector<std::vector<std::vector<double>>> by_libxdf(const std::string& bytes) {
  const FreshFolder folder;
  const std::string path = folder.write("file.xdf", bytes);
  const std::string command =
      std::string("'") + libxdf + "' '" + path + "' > '" + folder / "out" + "' 2> /dev/null";
  REQUIRE(std::system(command.c_str()) == 0);
  std::vector<std::vector<std::vector<double>>> streams;
  std::istringstream lines(folder.read("out"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("stream ")) {
      streams.emplace_back();
      continue;
    }
    char* end = nullptr;
    std::vector<double> row;
    for (const char* at = line.c_str(); *at != '\0'; at = end) {
      row.push_back(std::strtod(at, &end));
      if (end == at) break;  // a line of words
    }
    if (!streams.empty() && row.size() > 1) streams.back().push_back(row);
  }
  return streams;
}

void check_alike(const std::string& bytes) {
  const auto theirs = by_libxdf(bytes);
  const auto ours = read_xdf(bytes);
  REQUIRE(theirs.size() == ours.streams.size());
  for (std::size_t s = 0; s < theirs.size(); ++s) {
    const XdfStream& stream = ours.streams[s];
    if (stream.format == XdfFormat::string) continue;
    const XdfSamples& samples = ours.samples.at(stream.id);
    REQUIRE(theirs[s].size() == samples.size());
    std::vector<XdfClockOffset> offsets;
    for (const auto& o : ours.offsets) {
      if (o.stream == stream.id) offsets.push_back(o);
    }
    const auto lines = fit_xdf_clock(offsets);
    for (std::size_t t = 0; t < samples.size(); ++t) {
      CHECK(theirs[s][t][0] ==
            doctest::Approx(corrected_xdf_stamp(lines, samples.stamps[t])).epsilon(1e-12));
      for (std::size_t c = 0; c < stream.channel_count; ++c) {
        const double value = std::visit(
            [&](const auto& values) {
              if constexpr (std::is_same_v<decltype(values), const std::vector<std::string>&>) {
                return 0.0;
              } else {
                return static_cast<double>(values[t * stream.channel_count + c]);
              }
            },
            samples.values);
        CHECK(static_cast<float>(theirs[s][t][1 + c]) == static_cast<float>(value));
      }
    }
  }
}

}  // namespace

TEST_CASE("xdf: libxdf reads the same of minimal.xdf, corrected stamps too" *
          doctest::skip(!has_libxdf() || !shared_data())) {
  check_alike(shared_text("xdf/minimal.xdf"));
}

TEST_CASE("xdf: libxdf reads the same of files of numbers" * doctest::skip(!has_libxdf())) {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string file = xdf_begin + xdf_header(1, "float32", 2, "100") +
                       xdf_header(2, "double64", 1, "50") + xdf_header(3, "int32", 1, "10");
    for (int k = 0; k < 20; ++k) {
      const double stamp = 100.0 + 0.2 * k;
      std::string samples;
      for (int i = 0; i < 20; ++i) {
        const std::string values = little_text(static_cast<std::uint32_t>(random() & 0x3fffffff)) +
                                   little_text(static_cast<std::uint32_t>(random() & 0x3fffffff));
        samples += i == 0 ? xdf_sample(stamp, values) : xdf_sample(values);
      }
      file += xdf_samples(1, 20, samples, 4);
      file += xdf_samples(2, 1, xdf_sample(stamp, little_text(0.1 * k)), 4);
      file += xdf_samples(3, 1,
                          xdf_sample(stamp, little_text(static_cast<std::uint32_t>(random()))), 4);
      if (k % 10 == 9) file += xdf_boundary();
    }
    check_alike(file);
  }
}
