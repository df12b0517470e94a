// SPDX-License-Identifier: Apache-2.0
// Decodes the BVH broadcast of Noitom's Axis Neuron and Axis Studio. The bytes of one sender arrive
// over TCP or in datagrams. Layout and rules: docs/formats/noitom_stream.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/noitom/header.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/wire/time.h"

#include <array>
#include <map>
#include <string_view>

namespace kinalign {

/// The reasons why recognised data do not give a frame.
enum class NoitomRefusal : std::uint8_t {
  wrong_count,       // header and length of a frame, but an unknown number of values
  garbage,           // the tokens of a header, but not a frame
  incomplete,        // another frame begins before this one is complete
  compressed,        // Axis Studio's compressed port, or the old header's compressed mode
  calculation,       // a packet of the calculation stream
  command,           // a packet of the command channel
  too_long,          // text without its end mark
  too_many_avatars,  // the 65th avatar and later ones
  count_of_refusals  // not a refusal: the number of refusals
};

std::string_view to_string(NoitomRefusal refusal);

struct NoitomCounts {
  std::uint64_t frames = 0;
  std::uint64_t bytes_skipped =
      0;  // bytes outside of frames and refused headers, without blanks after text
  std::array<std::uint64_t, static_cast<std::size_t>(NoitomRefusal::count_of_refusals)> refused{};

  std::uint64_t operator[](NoitomRefusal r) const { return refused[static_cast<std::size_t>(r)]; }
  bool operator==(const NoitomCounts&) const = default;
};

struct NoitomArrival {
  NoitomFrame frame;
  Order order = Order::newest;           // by the source's frame index; `newest` if there is none
  std::optional<SequencePlace> place{};  // by the frame index; empty if there is none
  // The arrival of the piece that completed the frame. It is empty if that piece was fed last.
  std::optional<HostTime> arrival{};
};

/// One person of the broadcast. Frame numbers are counted for each avatar, because the avatars of a
/// sender usually share the same numbers.
struct NoitomAvatar {
  std::uint32_t index = 0;
  std::string name;  // the name in its latest frame
  std::uint64_t frames = 0;
  SequenceCount by_index;  // includes incomplete frames; empty if there is no frame index
};

/// The beginning of a binary frame. Its header has arrived, and its values have not all arrived.
struct NoitomBeginning {
  std::size_t size = 0;  // bytes of the whole frame, including its header
  std::uint32_t avatar = 0;
  std::optional<std::uint32_t> index{};  // the source's frame index
};

/// The parts of each frame that the decoder outputs.
enum class NoitomParts {
  all,
  heads  // for counting: the values of binary frames are skipped
};

/// Decodes the bytes of one sender. It recognises the form of each frame by the frame's content.
class NoitomDecoder {
 public:
  explicit NoitomDecoder(NoitomParts parts = NoitomParts::all) : parts_(parts) {}

  /// Takes bytes that may be cut anywhere. Appends the frames that they complete, including
  /// duplicates and late frames. The frames do not depend on the cuts.
  void feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out);

  /// Drops the incomplete data. The beginning of a frame counts as incomplete, and other bytes are
  /// skipped. A complete frame among them is output.
  void give_up(std::vector<NoitomArrival>& out);
  /// Counts bytes that belong to no frame, without parsing them.
  void pass_over(std::size_t bytes) { counts_.bytes_skipped += bytes; }
  /// The incomplete frame that waits for its rest; empty if there is none.
  std::optional<NoitomBeginning> beginning() const;
  bool waits_within_header() const;

  const NoitomCounts& counts() const { return counts_; }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return avatars_; }
  /// The number of bytes that wait for more bytes, at most 20 kB.
  std::size_t waiting() const { return held_.size() - at_; }

  /// The findings about this stream for the user. Messages contain `name`.
  Findings findings(const std::string& name) const;

 private:
  enum class Step { go_on, wait };

  std::span<const std::uint8_t> ahead() const { return std::span(held_).subspan(at_); }
  void take_all(std::vector<NoitomArrival>& out);
  Step step(std::vector<NoitomArrival>& out);
  Step marked(std::vector<NoitomArrival>& out);
  Step binary(std::vector<NoitomArrival>& out);
  void count_incomplete();
  Step misfit();
  Step other_header(std::uint8_t last_byte, NoitomRefusal meaning);
  Step zipped();
  Step text(std::vector<NoitomArrival>& out);
  void text_frame(std::size_t size, std::vector<NoitomArrival>& out);
  void refuse_text(std::string_view text);
  void give(NoitomFrame frame, std::vector<NoitomArrival>& out);
  void refuse(NoitomRefusal refusal) { ++counts_.refused[static_cast<std::size_t>(refusal)]; }
  void skip(std::size_t bytes);
  void take(std::size_t bytes);

  /// All bytes of `held_` before `at_` are handled. At the end of each slice, `feed` removes them.
  NoitomParts parts_;
  std::vector<std::uint8_t> held_;
  std::size_t at_ = 0;        // position in `held_`; the bytes before it are handled
  std::size_t searched_ = 0;  // bytes searched for the end of a text or for a header
  /// Blanks that follow a text frame are not counted as skipped.
  bool behind_text_ = false;
  NoitomCounts counts_;
  std::map<std::uint32_t, NoitomAvatar> avatars_;
};

}  // namespace kinalign
