// SPDX-License-Identifier: Apache-2.0
// XDF files for tests, written by the description in docs/formats/xdf.md.
#pragma once

#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/wire/little_endian.h"

#include <doctest/doctest.h>

#include <bit>
#include <random>

namespace kinalign {

template <std::unsigned_integral T>
std::string little_text(T value) {
  std::vector<std::uint8_t> bytes;
  append_little(value, bytes);
  return {bytes.begin(), bytes.end()};
}
inline std::string little_text(double value) {
  return little_text(std::bit_cast<std::uint64_t>(value));
}

/// An XDF length in `width` bytes.
inline std::string xdf_length(std::uint64_t length, unsigned width) {
  return static_cast<char>(width) + little_text(length).substr(0, width);
}

inline std::string xdf_chunk(std::uint16_t tag, const std::string& content, unsigned width = 4) {
  return xdf_length(content.size() + 2, width) + little_text(tag) + content;
}

inline const std::string xdf_begin =
    "XDF:" + xdf_chunk(1, "<?xml version=\"1.0\"?><info><version>1.0</version></info>", 1);

inline std::string xdf_boundary() {
  return xdf_chunk(5, "\x43\xa5\x46\xdc\xcb\xf5\x41\x0f\xb3\x0e\xd5\x46\x73\x83\xcb\xe4", 1);
}

inline std::string xdf_header(std::uint32_t id, const std::string& format, unsigned channels,
                              const std::string& rate = "0", const std::string& more = "") {
  return xdf_chunk(2, little_text(id) + "<?xml version=\"1.0\"?><info><name>N" +
                          std::to_string(id) + "</name><channel_count>" + std::to_string(channels) +
                          "</channel_count><nominal_srate>" + rate +
                          "</nominal_srate><channel_format>" + format + "</channel_format>" + more +
                          "</info>");
}

inline std::string xdf_sample(double stamp, const std::string& values) {
  return "\x08" + little_text(stamp) + values;
}
inline std::string xdf_sample(const std::string& values) { return std::string(1, '\0') + values; }

inline std::string xdf_samples(std::uint32_t id, std::uint64_t count, const std::string& samples,
                               unsigned width = 1) {
  return xdf_chunk(3, little_text(id) + xdf_length(count, width) + samples);
}

inline std::string xdf_offset(std::uint32_t id, double time, double offset) {
  return xdf_chunk(4, little_text(id) + little_text(time) + little_text(offset), 1);
}

struct XdfRead {
  std::vector<XdfStream> streams;
  std::map<std::uint32_t, XdfSamples> samples;  // all chunks of a stream together
  std::vector<XdfClockOffset> offsets;
  std::vector<std::string> findings;
  std::string error;

  bool operator==(const XdfRead&) const = default;
};

inline void join_xdf(const XdfSamples& more, XdfRead& read) {
  const auto [at, fresh] = read.samples.try_emplace(more.stream, more);
  if (fresh) return;
  XdfSamples& all = at->second;
  all.stamps.insert(all.stamps.end(), more.stamps.begin(), more.stamps.end());
  all.deduced.insert(all.deduced.end(), more.deduced.begin(), more.deduced.end());
  std::visit(
      [&](auto& values) {
        const auto& from = std::get<std::remove_reference_t<decltype(values)>>(more.values);
        values.insert(values.end(), from.begin(), from.end());
      },
      all.values);
}

/// Feeds pieces of 1 to `most` bytes.
inline XdfRead read_xdf(std::string_view text, std::size_t most, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  XdfReader reader("rec.xdf");
  std::vector<XdfItem> items;
  Result<void> result;
  while (!text.empty() && result) {
    const auto piece = text.substr(0, 1 + random() % most);
    result = reader.feed(piece, items);
    text.remove_prefix(piece.size());
  }
  if (result) result = reader.finish(items);
  XdfRead read;
  if (!result) read.error = to_string(result.error());
  for (auto& item : items) {
    if (const auto* stream = std::get_if<XdfStream>(&item)) read.streams.push_back(*stream);
    if (const auto* samples = std::get_if<XdfSamples>(&item)) join_xdf(*samples, read);
    if (const auto* offset = std::get_if<XdfClockOffset>(&item)) read.offsets.push_back(*offset);
  }
  for (const auto& finding : reader.findings()) read.findings.push_back(to_string(finding.what));
  return read;
}

inline XdfRead read_xdf(std::string_view text) { return read_xdf(text, text.size()); }

}  // namespace kinalign
