// SPDX-License-Identifier: Apache-2.0
#include "firmware/script/script.h"

#include "firmware/node/count_names.h"

namespace kinalign {

namespace {

constexpr std::size_t most_counts = 32;

/// Writes each number as 64 bits.
struct PutCount {
  ByteWriter& writer;
  void operator()(const char*, std::uint64_t number) const { writer.put(number); }
};

}  // namespace

void Script::play() {
  for (std::size_t size = 0; read_message(line_, message_, size);) {
    const auto fields = std::span<const std::uint8_t>(message_).subspan(1, size - 1);
    ByteReader reader(fields);
    const char kind = static_cast<char>(message_[0]);
    if (kind == 'E') return write_counts();
    if (kind == 'D') {
      board_.arrive(fields);
      continue;
    }
    if (kind == 'C') start(reader);
    if (kind == 'T') tick(board_.begin_tick(reader));
    if (kind == 'P') poll(board_.begin_poll(reader));
    write_message(line_, 'K', {});
  }
}

void Script::start(ByteReader& message) {
  NodeSettings settings;
  settings.node_id = message.take<std::uint32_t>();
  settings.boot_id = message.take<std::uint32_t>();
  const auto flags = message.take<std::uint8_t>();
  settings.has_key = (flags & 1) != 0;
  settings.narrow_counter = (flags & 4) != 0;
  for (auto& byte : settings.key) byte = message.take<std::uint8_t>();
  settings.frame_period_us = message.take<std::uint32_t>();
  settings.dither_us = message.take<std::uint32_t>();
  if ((flags & 2) != 0) {
    node_.emplace<ClocklessNode>(board_, settings);
  } else {
    node_.emplace<Node>(board_, settings);
  }
}

void Script::tick(std::uint32_t due) {
  if (auto* node = std::get_if<Node>(&node_)) node->tick(due);
  if (auto* node = std::get_if<ClocklessNode>(&node_)) node->tick(due);
}

void Script::poll(bool link_up) {
  if (auto* node = std::get_if<Node>(&node_)) {
    node->set_link(link_up);
    node->poll();
  }
  if (auto* node = std::get_if<ClocklessNode>(&node_)) {
    node->set_link(link_up);
    node->poll();
  }
}

void Script::write_counts() {
  std::array<std::uint8_t, most_counts * sizeof(std::uint64_t)> room{};
  ByteWriter writer(room);
  if (auto* node = std::get_if<Node>(&node_)) {
    const NodeTally counts = node->counts();
    each_node_count(counts, PutCount{writer});
  }
  if (auto* node = std::get_if<ClocklessNode>(&node_)) {
    each_clockless_count(node->counts(), PutCount{writer});
  }
  write_message(line_, 'N', std::span(room).first(writer.written()));
}

}  // namespace kinalign
