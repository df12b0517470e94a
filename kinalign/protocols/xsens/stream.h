// SPDX-License-Identifier: Apache-2.0
// The network stream of Xsens MVN, as one sender's bytes arrive over TCP or in datagrams. Layout
// and rules: docs/formats/xsens_mvn_stream.md.
#pragma once

#include "kinalign/protocols/sequence_count.h"
#include "kinalign/protocols/xsens/layout.h"

#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace kinalign {

/// Why a datagram, or a sample of several, gave nothing.
enum class XsensRefusal : std::uint8_t {
  wrong_size,           // the payload is not what type and number of items ask for
  torn,                 // another datagram begins before this one is complete
  incomplete,           // a sample whose further datagrams did not come
  repeated,             // a datagram of a sample that is there, or that is held already
  too_many_items,       // more than 256 in a sample
  too_many_characters,  // the 17th and later
  count_of_refusals     // none: how many there are
};

std::string_view to_string(XsensRefusal refusal);

struct XsensCounts {
  std::uint64_t samples = 0;        // that were given on
  std::uint64_t bytes_skipped = 0;  // in no datagram
  std::array<std::uint64_t, static_cast<std::size_t>(XsensRefusal::count_of_refusals)> refused{};
  std::array<std::uint64_t, 100> other_types{};  // datagrams that were passed over, by type

  std::uint64_t operator[](XsensRefusal r) const { return refused[static_cast<std::size_t>(r)]; }
  bool operator==(const XsensCounts&) const = default;
};

struct XsensArrival {
  XsensSample sample;
  Order order = Order::newest;  // among those of its character and type
};

/// A character's samples of one type.
struct XsensChannel {
  std::uint8_t character = 0;
  unsigned type = 0;

  auto operator<=>(const XsensChannel&) const = default;
};

/// One sender.
class XsensDecoder {
 public:
  /// Takes bytes cut anywhere and appends the samples that they complete, duplicates and late ones
  /// too. The samples don't depend on where the bytes were cut.
  void feed(std::span<const std::uint8_t> bytes, std::vector<XsensArrival>& out);

  const XsensCounts& counts() const { return counts_; }
  /// Lost, late and doubled by the sample counter.
  std::map<XsensChannel, SequenceCounts> channels() const;
  /// Bytes that wait for their rest: never more than 70 kB. Beside them at most four incomplete
  /// samples of 256 items are held for each of 48 channels.
  std::size_t waiting() const { return held_.size() - at_; }

  /// What the user should know of this stream; `name` stands in the messages.
  Findings findings(const std::string& name) const;

 private:
  struct Part {
    std::size_t items = 0;
    std::map<unsigned, XsensSample> pieces;  // by the datagram's index
    std::optional<unsigned> last;            // the index that ends the sample
  };
  struct Channel {
    SequenceCount by_counter;
    std::deque<std::pair<std::uint32_t, Part>> parts;  // by sample counter, oldest first
    std::optional<std::uint32_t> joined;               // the sample of several that came last
  };

  std::span<const std::uint8_t> ahead() const { return std::span(held_).subspan(at_); }
  bool step(std::vector<XsensArrival>& out);
  bool torn(std::size_t size);
  void datagram(const XsensHeader& header, XsensItems items, std::vector<XsensArrival>& out);
  void join(Channel& channel, const XsensHeader& header, XsensSample piece,
            std::vector<XsensArrival>& out);
  Part& part_of(Channel& channel, std::uint32_t counter);
  void give(Channel& channel, XsensSample sample, std::vector<XsensArrival>& out);
  Channel* channel_of(const XsensHeader& header);
  void refuse(XsensRefusal refusal) { ++counts_.refused[static_cast<std::size_t>(refusal)]; }
  void take(std::size_t bytes);

  std::vector<std::uint8_t> held_;
  std::size_t at_ = 0;        // of `held_`: what is before is done
  std::size_t searched_ = 0;  // bytes of a datagram in which no other begins
  XsensCounts counts_;
  std::map<XsensChannel, Channel> channels_;
};

}  // namespace kinalign
