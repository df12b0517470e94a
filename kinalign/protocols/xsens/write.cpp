// SPDX-License-Identifier: Apache-2.0
// Writes samples in the form of Xsens MVN.
#include "kinalign/protocols/xsens/layout.h"
#include "kinalign/wire/bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace kinalign {

namespace {

using Bytes = std::vector<std::uint8_t>;

/// The items of a sample, one by one.
/// Items are encoded one by one, so that a sample can be divided at any item.
struct Items {
  unsigned type = 0;
  std::vector<Bytes> items;
};

// Appends fields one after another, in big-endian order.
class Item {
 public:
  template <std::unsigned_integral T>
  Item& put(T value) {
    std::array<std::uint8_t, sizeof(T)> room{};
    ByteWriter(room).put(value);
    bytes_.insert(bytes_.end(), room.begin(), room.end());
    return *this;
  }
  template <std::size_t n>
  Item& put(const std::array<float, n>& values) {
    for (const float value : values) put(std::bit_cast<std::uint32_t>(value));
    return *this;
  }
  Item& put(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

Failure refused(const std::string& expected, const std::string& found) {
  return Failure(Error{"", 0, expected, found});
}

Result<Items> items_of(const XsensPose& pose) {
  Items all{2, {}};
  for (const auto& s : pose.segments) {
    all.items.push_back(
        Item().put(static_cast<std::uint32_t>(s.id)).put(s.position).put(s.rotation).bytes());
  }
  return all;
}

/// All trackers must be of one form, because the items of a datagram have one size.
Result<Items> items_of(const XsensTrackers& trackers) {
  Items all{23, {}};
  for (const auto& t : trackers.trackers) {
    if (t.raw.has_value() != trackers.trackers[0].raw.has_value()) {
      return refused("trackers of one kind", "some with raw values and some without");
    }
    Item item;
    item.put(static_cast<std::uint32_t>(t.id)).put(t.rotation).put(t.free_acceleration);
    if (t.raw) item.put(t.raw->acceleration).put(t.raw->angular_velocity);
    all.items.push_back(item.put(t.magnetic_field).bytes());
  }
  return all;
}

/// Writes "HH:MM:SS.mmm".
Result<Items> items_of(const XsensTimeCode& code) {
  using namespace std::chrono;
  const auto ms = duration_cast<milliseconds>(code.time_of_day).count();
  if (ms < 0 || ms >= 24LL * 3'600'000 || milliseconds(ms) != code.time_of_day) {
    return refused("whole milliseconds of a day", fmt::format("{} ns", code.time_of_day.count()));
  }
  return Items{25,
               {Item()
                    .put(fmt::format("{:02}:{:02}:{:02}.{:03}", ms / 3'600'000, ms / 60'000 % 60,
                                     ms / 1000 % 60, ms % 1000))
                    .bytes()}};
}

// The reserved field and the payload's size follow as zeros; `put_payload_size` sets the size
// later.
Bytes header_of(const XsensSample& s, unsigned type, std::size_t items, unsigned datagram) {
  return Item()
      .put(fmt::format("MXTP{:02}", type))
      .put(s.counter)
      .put(static_cast<std::uint8_t>(datagram))
      .put(static_cast<std::uint8_t>(items))
      .put(s.time_code_ms)
      .put(s.character)
      .put(s.body_segments)
      .put(s.props)
      .put(s.finger_segments)
      .put(std::uint32_t{0})
      .bytes();
}

void put_payload_size(Bytes& datagram) {
  const std::size_t size = datagram.size() - xsens_header_size;
  datagram[22] = static_cast<std::uint8_t>(size >> 8);
  datagram[23] = static_cast<std::uint8_t>(size);
}

}  // namespace

Result<std::vector<Bytes>> xsens_datagrams(const XsensSample& sample, const XsensSending& sending) {
  Items all = KA_TRY(std::visit([](const auto& body) { return items_of(body); }, sample.body));
  const std::size_t count = all.items.size();
  // The number of items is a byte. The index of a datagram has 7 bits.
  const std::size_t each = std::clamp<std::size_t>(sending.items_per_datagram, 1, 255);
  if (count == 0 || count > most_xsens_items || (count - 1) / each > 127) {
    return refused("1 to 256 items in at most 128 datagrams", std::to_string(count));
  }
  // Without its size a payload is read as items of the short form, so raw values would be misread.
  if (all.type == 23 && all.items[0].size() != xsens_item_size(23) && !sending.payload_size) {
    return refused("a payload size beside raw values", "none");
  }
  if (all.type == 25 && sending.long_time_code) {
    if (!sending.payload_size) return refused("a payload size beside a long time code", "none");
    const Bytes text = std::move(all.items[0]);
    all.items[0] = Item().put(static_cast<std::uint32_t>(text.size())).bytes();
    all.items[0].insert(all.items[0].end(), text.begin(), text.end());
  }
  std::vector<Bytes> datagrams;
  for (std::size_t first = 0; first < count; first += each) {
    const std::size_t some = std::min(each, count - first);
    const auto index = static_cast<unsigned>(datagrams.size());
    Bytes datagram =
        header_of(sample, all.type, some, first + some == count ? 0x80 | index : index);
    for (std::size_t k = first; k < first + some; ++k) {
      datagram.insert(datagram.end(), all.items[k].begin(), all.items[k].end());
    }
    if (sending.payload_size) put_payload_size(datagram);
    datagrams.push_back(std::move(datagram));
  }
  return datagrams;
}

}  // namespace kinalign
