// SPDX-License-Identifier: Apache-2.0
// Reading does not depend on where the file is cut, arrays are as long as they state, and clocks
// fitted to any offsets give numbers. Seeds: xdf/*.xdf
#include "kinalign/formats/xdf/xdf.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace kinalign;

namespace {

struct Decoded {
  std::vector<XdfItem> items;
  std::vector<std::string> findings;
  bool fine = false;
};

Decoded decode(std::string_view text, std::size_t piece) {
  XdfReader reader("fuzz");
  Decoded all;
  Result<void> result;
  for (std::size_t at = 0; at < text.size() && result; at += piece) {
    result = reader.feed(text.substr(at, piece), all.items);
  }
  if (result) result = reader.finish(all.items);
  all.fine = result.has_value();
  for (const auto& finding : reader.findings()) all.findings.push_back(to_string(finding.what));
  return all;
}

/// Compares bit for bit, so that NaN equals itself.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), 8 * a.size()) == 0);
}

bool same(const XdfSamples& a, const XdfSamples& b) {
  const auto* real = std::get_if<std::vector<double>>(&a.values);
  if (real != nullptr) return same(*real, std::get<std::vector<double>>(b.values));
  return a.stream == b.stream && same(a.stamps, b.stamps) && a.deduced == b.deduced &&
         a.values == b.values;
}

bool same(const XdfItem& a, const XdfItem& b) {
  if (a.index() != b.index()) return false;
  const auto* samples = std::get_if<XdfSamples>(&a);
  return samples != nullptr ? same(*samples, std::get<XdfSamples>(b)) : a == b;
}

void check_samples(const XdfSamples& samples, const std::vector<XdfStream>& streams) {
  const auto stream = std::find_if(streams.begin(), streams.end(),
                                   [&](const auto& s) { return s.id == samples.stream; });
  if (stream == streams.end() || samples.deduced.size() != samples.size()) std::abort();
  const std::size_t values = std::visit([](const auto& v) { return v.size(); }, samples.values);
  if (values != samples.size() * stream->channel_count) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Decoded whole = decode(text, size + 1), cut = decode(text, 1 + size % 61);
  if (whole.fine != cut.fine || whole.findings != cut.findings) std::abort();
  if (!std::equal(whole.items.begin(), whole.items.end(), cut.items.begin(), cut.items.end(),
                  [](const auto& a, const auto& b) { return same(a, b); })) {
    std::abort();
  }
  std::vector<XdfStream> streams;
  std::vector<XdfClockOffset> offsets;
  for (const auto& item : whole.items) {
    if (const auto* stream = std::get_if<XdfStream>(&item)) streams.push_back(*stream);
    if (const auto* samples = std::get_if<XdfSamples>(&item)) check_samples(*samples, streams);
    if (const auto* offset = std::get_if<XdfClockOffset>(&item)) offsets.push_back(*offset);
  }
  const auto lines = fit_xdf_clock(offsets);
  if (lines.size() > offsets.size()) std::abort();
  for (const auto& line : lines) {
    if (!std::isfinite(line.offset) || !std::isfinite(line.slope)) std::abort();
  }
  return 0;
}
