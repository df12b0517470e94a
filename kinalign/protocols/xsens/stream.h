// SPDX-License-Identifier: Apache-2.0
// Decodes the network stream of Xsens MVN. The bytes of one sender arrive over TCP or in datagrams.
// Layout and rules: docs/formats/xsens_mvn_stream.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/protocols/xsens/layout.h"

#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace kinalign {

/// The reasons to drop a datagram, or a sample of several datagrams.
enum class XsensRefusal : std::uint8_t {
  wrong_size,           // the payload does not fit the type and the number of items
  interrupted,          // another datagram begins before this one is complete
  incomplete,           // some datagrams of a sample did not arrive
  repeated,             // a datagram of a sample that was output, or a datagram that arrived before
  too_many_items,       // more than 256 in a sample
  too_many_characters,  // the 17th character and later ones
  count_of_refusals     // not a refusal: the number of refusals
};

std::string_view to_string(XsensRefusal refusal);

struct XsensCounts {
  std::uint64_t samples = 0;        // samples that were output
  std::uint64_t bytes_skipped = 0;  // bytes that belong to no datagram
  std::array<std::uint64_t, static_cast<std::size_t>(XsensRefusal::count_of_refusals)> refused{};
  std::array<std::uint64_t, 100> other_types{};  // skipped datagrams by type

  std::uint64_t operator[](XsensRefusal r) const { return refused[static_cast<std::size_t>(r)]; }
  bool operator==(const XsensCounts&) const = default;
};

/// A complete sample. Duplicates and late samples are included, so that the caller can decide about
/// them.
struct XsensArrival {
  XsensSample sample;
  Order order = Order::newest;  // among the samples of its character and type
  SequencePlace place{};        // position among the same samples
};

/// Identifies the samples of one type of one character.
struct XsensChannel {
  std::uint8_t character = 0;
  unsigned type = 0;

  auto operator<=>(const XsensChannel&) const = default;
};

/// Decodes the bytes of one sender. Connections and datagrams are decoded in the same way, because
/// each header determines the size of its datagram.
class XsensDecoder {
 public:
  /// Takes bytes that may be cut anywhere. Appends the samples that they complete, including
  /// duplicates and late samples. The samples do not depend on the cuts.
  void feed(std::span<const std::uint8_t> bytes, std::vector<XsensArrival>& out);

  const XsensCounts& counts() const { return counts_; }
  /// The counts of lost, late and duplicate samples, by the sample counter.
  std::map<XsensChannel, SequenceCounts> channels() const;
  /// The number of bytes that wait for more bytes, at most 70 kB. Each of up to 48 channels keeps
  /// at most four incomplete samples of 256 items in addition.
  std::size_t waiting() const { return held_.size() - at_; }

  /// The findings about this stream for the user. Messages contain `name`.
  Findings findings(const std::string& name) const;

 private:
  /// A sample of several datagrams that is not complete yet. It is complete when all datagrams from
  /// 0 to `last` have arrived.
  struct Part {
    std::size_t items = 0;
    std::map<unsigned, XsensSample> pieces;  // by the datagram's number within the sample
    std::optional<unsigned> last;            // number of the sample's last datagram
  };
  struct Channel {
    SequenceCount by_counter;
    std::deque<std::pair<std::uint32_t, Part>> parts;  // by sample counter, oldest first
    /// The number of the latest sample that was joined from several datagrams.
    std::optional<std::uint32_t> joined;
  };

  std::span<const std::uint8_t> ahead() const { return std::span(held_).subspan(at_); }
  /// Handles the front of the buffer: a datagram, or a byte that is skipped. Returns false if more
  /// bytes are needed.
  bool step(std::vector<XsensArrival>& out);
  /// Returns true if another datagram began within this one. This datagram is then skipped.
  bool skip_interrupted(std::size_t size);
  /// Handles a complete datagram. Outputs its sample, or joins it with other datagrams of the
  /// sample.
  void datagram(const XsensHeader& header, XsensItems items, std::vector<XsensArrival>& out);
  void join(Channel& channel, const XsensHeader& header, XsensSample piece,
            std::vector<XsensArrival>& out);
  Part& part_of(Channel& channel, std::uint32_t counter);
  void give(Channel& channel, XsensSample sample, std::vector<XsensArrival>& out);
  Channel* channel_of(const XsensHeader& header);
  void refuse(XsensRefusal refusal) { ++counts_.refused[static_cast<std::size_t>(refusal)]; }
  void take(std::size_t bytes);

  /// All bytes of `held_` before `at_` are handled. They are removed at the end of each slice.
  /// `channels_` keeps the incomplete samples.
  std::vector<std::uint8_t> held_;
  std::size_t at_ = 0;        // position in `held_`; the bytes before it are handled
  std::size_t searched_ = 0;  // bytes of the datagram that were searched for another datagram
  XsensCounts counts_;
  std::map<XsensChannel, Channel> channels_;
};

}  // namespace kinalign
