// SPDX-License-Identifier: Apache-2.0
// Samples and bytes of the Xsens MVN stream, for tests.
#pragma once

#include "tests/formats/joined_bytes.h"
#include "tests/protocols/xsens/xsens_datagrams.h"

#include "kinalign/protocols/xsens/stream.h"
#include "kinalign/recording/streams/xsens_pose.h"

#include <doctest/doctest.h>

#include <random>

namespace kinalign {

inline XsensSample xsens_sample(std::uint32_t counter = 1000) {
  XsensSample sample;
  sample.counter = counter;
  sample.time_code_ms = 16'667;
  sample.body_segments = 23;
  return sample;
}

/// A pose with segment k at (0.0625 k, 0, 0.9375), the left foot on the floor, and no segment
/// turned.
inline XsensSample xsens_pose(std::size_t segments = 23, std::uint32_t counter = 1000) {
  XsensSample sample = xsens_sample(counter);
  XsensPose pose;
  for (std::size_t k = 0; k < segments; ++k) {
    const float x = 0.0625F * static_cast<float>(k);
    pose.segments.push_back({static_cast<std::int32_t>(k + 1), {x, 0, 0.9375F}, {1, 0, 0, 0}});
  }
  if (segments >= 23) pose.segments[21].position[2] = 0.0F;
  sample.body = pose;
  return sample;
}

inline XsensSample xsens_trackers(bool raw, std::uint32_t counter = 1000) {
  XsensSample sample = xsens_sample(counter);
  XsensTrackers trackers;
  for (const std::int32_t id : {1, 5, 11}) {
    XsensTracker tracker;
    tracker.id = id;
    tracker.rotation = {1, 0, 0, 0};
    tracker.free_acceleration = {0.5F, 0, 0};
    if (raw) tracker.raw = {{0.5F, 0, 9.8125F}, {0.25F, 0, 0}};
    tracker.magnetic_field = {0, 1, 0};
    trackers.trackers.push_back(tracker);
  }
  sample.body = trackers;
  return sample;
}

inline XsensSample xsens_time_code(std::uint32_t counter = 1000) {
  XsensSample sample = xsens_sample(counter);
  sample.body = XsensTimeCode{std::chrono::milliseconds(((13 * 60 + 5) * 60 + 9) * 1000 + 250)};
  return sample;
}

inline std::vector<Bytes> datagrams_of(const XsensSample& sample, const XsensSending& how = {}) {
  return xsens_datagrams(sample, how);
}

inline Bytes bytes_of(const XsensSample& sample, const XsensSending& how = {}) {
  Bytes bytes;
  for (const auto& datagram : datagrams_of(sample, how)) bytes += datagram;
  return bytes;
}

struct XsensRead {
  std::vector<XsensSample> samples;
  std::vector<Order> orders;
  XsensCounts counts;
  std::map<XsensChannel, SequenceCounts> channels;
  Findings findings;
};

/// Feeds pieces of 1 to `most` bytes.
inline XsensRead read_xsens(const Bytes& bytes, std::size_t most, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  XsensDecoder decoder;
  std::vector<XsensArrival> arrivals;
  std::span<const std::uint8_t> left(bytes);
  while (!left.empty()) {
    const auto piece = left.first(std::min<std::size_t>(left.size(), 1 + random() % most));
    decoder.feed(piece, arrivals);
    left = left.subspan(piece.size());
    CHECK(decoder.waiting() <= 70'000);
  }
  XsensRead read{{}, {}, decoder.counts(), decoder.channels(), decoder.findings("mvn")};
  for (auto& arrival : arrivals) {
    read.samples.push_back(std::move(arrival.sample));
    read.orders.push_back(arrival.order);
  }
  return read;
}

inline XsensRead read_xsens(const Bytes& bytes) { return read_xsens(bytes, bytes.size()); }

}  // namespace kinalign
