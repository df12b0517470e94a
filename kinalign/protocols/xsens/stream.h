// SPDX-License-Identifier: Apache-2.0
// Decodes the network stream of Xsens MVN, from one sender's bytes over TCP or in datagrams. Layout
// and rules: docs/formats/xsens_mvn_stream.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/protocols/xsens/layout.h"

#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace kinalign {

/// Reasons for a datagram, or a sample of several datagrams, to be dropped.
enum class XsensRefusal : std::uint8_t {
  wrong_size,      // the payload does not fit the type and the number of items
  torn,            // another datagram begins before this one is complete
  incomplete,      // a sample of which some datagrams did not arrive
  repeated,        // a datagram of a sample that was output, or a datagram that is kept already
  too_many_items,  // more than 256 in a sample
  too_many_characters,  // the 17th character and later ones
  count_of_refusals     // not a refusal: the number of refusals
};

std::string_view to_string(XsensRefusal refusal);

struct XsensCounts {
  std::uint64_t samples = 0;        // samples that were output
  std::uint64_t bytes_skipped = 0;  // bytes outside of datagrams
  std::array<std::uint64_t, static_cast<std::size_t>(XsensRefusal::count_of_refusals)> refused{};
  std::array<std::uint64_t, 100> other_types{};  // datagrams of types that are not read, by type

  std::uint64_t operator[](XsensRefusal r) const { return refused[static_cast<std::size_t>(r)]; }
  bool operator==(const XsensCounts&) const = default;
};

/// A complete sample. Duplicates and late samples are included; the caller decides about them.
struct XsensArrival {
  XsensSample sample;
  Order order = Order::newest;  // among the samples of its character and type
  SequencePlace place{};        // among the same samples
};

/// A character's samples of one type.
struct XsensChannel {
  std::uint8_t character = 0;
  unsigned type = 0;

  auto operator<=>(const XsensChannel&) const = default;
};

/// Decodes the bytes of one sender.
/// Connections and datagrams are decoded in the same way, because the size of each datagram follows
/// from its header.
class XsensDecoder {
 public:
  /// Takes bytes cut anywhere and appends the samples that they complete, including duplicates and
  /// late ones. The samples don't depend on the cuts.
  void feed(std::span<const std::uint8_t> bytes, std::vector<XsensArrival>& out);

  const XsensCounts& counts() const { return counts_; }
  /// Lost, late and duplicate samples by the sample counter.
  std::map<XsensChannel, SequenceCounts> channels() const;
  /// Number of bytes that wait for more: never above 70 kB. In addition at most four incomplete
  /// samples of 256 items are kept for each of 48 channels.
  std::size_t waiting() const { return held_.size() - at_; }

  /// Findings about this stream for the user; `name` appears in the messages.
  Findings findings(const std::string& name) const;

 private:
  /// A sample of several datagrams that is not complete yet.
  /// The sample is complete when all datagrams from 0 to `last` are there.
  struct Part {
    std::size_t items = 0;
    std::map<unsigned, XsensSample> pieces;  // by the datagram's number within the sample
    std::optional<unsigned> last;            // number of the sample's last datagram
  };
  struct Channel {
    SequenceCount by_counter;
    std::deque<std::pair<std::uint32_t, Part>> parts;  // by sample counter, oldest first
    /// Number of the latest sample that was joined from several datagrams.
    std::optional<std::uint32_t> joined;
  };

  std::span<const std::uint8_t> ahead() const { return std::span(held_).subspan(at_); }
  /// Handles what is at the front: a datagram, or a byte that is skipped. False: more bytes are
  /// needed.
  bool step(std::vector<XsensArrival>& out);
  /// True if another datagram began within this one, which was then skipped.
  bool torn(std::size_t size);
  /// Handles a complete datagram: outputs its sample, or joins it with others.
  void datagram(const XsensHeader& header, XsensItems items, std::vector<XsensArrival>& out);
  void join(Channel& channel, const XsensHeader& header, XsensSample piece,
            std::vector<XsensArrival>& out);
  Part& part_of(Channel& channel, std::uint32_t counter);
  void give(Channel& channel, XsensSample sample, std::vector<XsensArrival>& out);
  Channel* channel_of(const XsensHeader& header);
  void refuse(XsensRefusal refusal) { ++counts_.refused[static_cast<std::size_t>(refusal)]; }
  void take(std::size_t bytes);

  /// Bytes before `at_` are decided and are dropped at the end of each slice. Everything about
  /// samples of several datagrams is in `channels_`.
  std::vector<std::uint8_t> held_;
  std::size_t at_ = 0;        // position in `held_`; the bytes before it are done
  std::size_t searched_ = 0;  // bytes of the datagram in which no other datagram begins
  XsensCounts counts_;
  std::map<XsensChannel, Channel> channels_;
};

}  // namespace kinalign
