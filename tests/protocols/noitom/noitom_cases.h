// SPDX-License-Identifier: Apache-2.0
// Frames and bytes of the Noitom stream, for tests.
#pragma once

#include "tests/formats/joined_bytes.h"
#include "tests/protocols/noitom/noitom_writer.h"

#include "kinalign/protocols/noitom/stream.h"

#include <doctest/doctest.h>

#include <random>
#include <string_view>

namespace kinalign {

inline NoitomFrame noitom_frame(NoitomForm form, bool displacement, bool reference,
                                std::uint32_t index = 1000) {
  NoitomFrame frame;
  frame.form = form;
  frame.avatar = 1;
  frame.name = "Char01";
  if (form == NoitomForm::new_header) frame.frame_index = index;
  frame.displacement = displacement;
  frame.reference = reference;
  for (std::size_t k = 0; k < noitom_values(displacement, reference); ++k) {
    frame.values.push_back(0.25F * static_cast<float>(k) - 20.0F + static_cast<float>(index % 7));
  }
  return frame;
}

inline Bytes bytes_of(const NoitomFrame& frame) {
  Bytes bytes;
  append_form_of_noitom(frame, bytes);
  return bytes;
}

inline Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

struct NoitomRead {
  std::vector<NoitomFrame> frames;
  std::vector<Order> orders;
  NoitomCounts counts;
  std::map<std::uint32_t, NoitomAvatar> avatars;
  Findings findings;
};

/// Feeds pieces of 1 to `most` bytes.
inline NoitomRead read_noitom(const Bytes& bytes, std::size_t most, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  NoitomDecoder decoder;
  std::vector<NoitomArrival> arrivals;
  std::span<const std::uint8_t> left(bytes);
  while (!left.empty()) {
    const auto piece = left.first(std::min<std::size_t>(left.size(), 1 + random() % most));
    decoder.feed(piece, arrivals);
    left = left.subspan(piece.size());
    CHECK(decoder.waiting() <= 20'480);
  }
  NoitomRead read{{}, {}, decoder.counts(), decoder.avatars(), decoder.findings("axis")};
  for (auto& arrival : arrivals) {
    read.frames.push_back(std::move(arrival.frame));
    read.orders.push_back(arrival.order);
  }
  return read;
}

inline NoitomRead read_noitom(const Bytes& bytes) { return read_noitom(bytes, bytes.size()); }

}  // namespace kinalign
