// SPDX-License-Identifier: Apache-2.0
// A bundle is its packets: each of them alone in a datagram is read as in the bundle, and nothing
// else is. Rotations that are let through are unit, accelerations finite.
#include "kinalign/protocols/slimevr/packet.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace kinalign;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// The kinds of packets, in their order.
using Kinds = std::vector<std::size_t>;

void add(const SlimeDatagram& datagram, Kinds& kinds) {
  for (const auto& packet : datagram.packets) kinds.push_back(packet.index());
}

/// Each packet of a bundle as a datagram of its own, with the head that it has not in the bundle;
/// nested bundles are left out.
Kinds one_by_one(std::span<const std::uint8_t> body, std::size_t width) {
  const std::size_t type_size = width == 1 ? 1 : 4;
  Kinds kinds;
  while (body.size() >= width) {
    const std::size_t stated = width == 1 ? body[0] : body[0] * 256U + body[1];
    const std::size_t length = std::min(stated, body.size() - width);
    const auto inner = body.subspan(width, length);
    body = body.subspan(width + length);
    if (length < type_size) continue;
    Bytes alone(4 - type_size);
    alone.insert(alone.end(), inner.begin(),
                 inner.begin() + static_cast<std::ptrdiff_t>(type_size));
    const bool nested =
        alone[0] == 0 && alone[1] == 0 && alone[2] == 0 && (alone[3] == 100 || alone[3] == 101);
    alone.resize(12);
    alone.insert(alone.end(), inner.begin() + static_cast<std::ptrdiff_t>(type_size), inner.end());
    SlimeDatagram datagram;
    if (!decode_slime(alone, datagram)) std::abort();
    if (!nested) add(datagram, kinds);
  }
  return kinds;
}

void check_motion(const SlimeMotion& motion) {
  const auto q = motion.rotation ? slime_orientation(*motion.rotation) : std::nullopt;
  if (q) {
    const auto& r = *q;
    const double norm = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3];
    if (!(std::abs(norm - 1.0) < 1e-9)) std::abort();
  }
  if (!motion.acceleration) return;
  const auto a = slime_acceleration(*motion.acceleration, 22);
  if (a && !std::all_of(a->begin(), a->end(), [](double x) { return std::isfinite(x); })) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SlimeDatagram datagram;
  if (!decode_slime({data, size}, datagram)) return size < 12 ? 0 : (std::abort(), 0);
  Kinds whole;
  add(datagram, whole);
  if (whole.size() > size) std::abort();
  for (const auto& packet : datagram.packets) {
    if (const auto* motion = std::get_if<SlimeMotion>(&packet)) check_motion(*motion);
  }
  if (datagram.type != 100 && datagram.type != 101) return 0;
  if (one_by_one({data + 12, size - 12}, datagram.type == 100 ? 2 : 1) != whole) std::abort();
  return 0;
}
