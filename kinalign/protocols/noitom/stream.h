// SPDX-License-Identifier: Apache-2.0
// The BVH broadcast of Noitom's Axis Neuron and Axis Studio, as one sender's bytes arrive over TCP
// or in datagrams. Layout and rules: docs/formats/noitom_stream.md.
#pragma once

#include "kinalign/protocols/noitom/header.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/wire/time.h"

#include <array>
#include <map>
#include <string_view>

namespace kinalign {

/// Why a thing that was recognised gave no frame.
enum class NoitomRefusal : std::uint8_t {
  wrong_count,       // a frame by its beginning and its length, of another number of values
  garbage,           // a frame's marks about what is none
  torn,              // another frame begins before this one is complete
  compressed,        // Axis Studio's compressed port, or the old header's compressed mode
  calculation,       // the calculation stream
  command,           // a pack of the command channel
  too_long,          // text that does not end
  too_many_avatars,  // the 65th and later
  count_of_refusals  // none: how many there are
};

std::string_view to_string(NoitomRefusal refusal);

struct NoitomCounts {
  std::uint64_t frames = 0;
  std::uint64_t bytes_skipped =
      0;  // in no frame and no refused header; blanks behind text are free
  std::array<std::uint64_t, static_cast<std::size_t>(NoitomRefusal::count_of_refusals)> refused{};

  std::uint64_t operator[](NoitomRefusal r) const { return refused[static_cast<std::size_t>(r)]; }
  bool operator==(const NoitomCounts&) const = default;
};

struct NoitomArrival {
  NoitomFrame frame;
  Order order = Order::newest;  // by the source's frame index; without one always newest
  // Of the piece that completed it; absent: it came with the bytes that were fed last.
  std::optional<HostTime> arrival{};
};

struct NoitomAvatar {
  std::uint32_t index = 0;
  std::string name;  // of its last frame
  std::uint64_t frames = 0;
  SequenceCount by_index;  // also of the torn; empty where the source gives no frame index
};

/// The beginning of a binary frame, its header at least.
struct NoitomBeginning {
  std::size_t held = 0, size = 0;  // bytes
  std::uint32_t avatar = 0;
  std::optional<std::uint32_t> index{};  // of the source
};

/// What of a frame is handed on.
enum class NoitomParts {
  all,
  heads  // what counts need: values of binary frames are passed over
};

/// One sender. Which form it uses is seen by content, at every frame anew.
class NoitomDecoder {
 public:
  explicit NoitomDecoder(NoitomParts parts = NoitomParts::all) : parts_(parts) {}

  /// Takes bytes cut anywhere and appends the frames that they complete, duplicates and late ones
  /// too. The frames don't depend on where the bytes were cut.
  void feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out);

  /// What waits gets no rest: a frame's beginning is torn, the rest skipped, but for frames that
  /// begin in it.
  void give_up(std::vector<NoitomArrival>& out);
  /// A frame that was given is doubtful: it is torn.
  void take_back(const NoitomFrame& frame);
  /// Counts bytes that are in no frame without looking at them.
  void pass_over(std::size_t bytes) { counts_.bytes_skipped += bytes; }
  /// The frame that waits for its rest.
  std::optional<NoitomBeginning> beginning() const;
  bool waits_within_header() const;

  const NoitomCounts& counts() const { return counts_; }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return avatars_; }
  /// Bytes that wait for their rest: never more than 20 kB.
  std::size_t waiting() const { return held_.size() - at_; }

  /// What the user should know of this stream; `name` stands in the messages.
  Findings findings(const std::string& name) const;

 private:
  enum class Step { go_on, wait };

  std::span<const std::uint8_t> ahead() const { return std::span(held_).subspan(at_); }
  void take_all(std::vector<NoitomArrival>& out);
  Step step(std::vector<NoitomArrival>& out);
  Step marked(std::vector<NoitomArrival>& out);
  Step binary(std::vector<NoitomArrival>& out);
  void tear();
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

  NoitomParts parts_;
  std::vector<std::uint8_t> held_;
  std::size_t at_ = 0;        // of `held_`: what is before is done
  std::size_t searched_ = 0;  // bytes of a text that hold no end, of a misfit that begin no header
  bool behind_text_ = false;
  NoitomCounts counts_;
  std::map<std::uint32_t, NoitomAvatar> avatars_;
};

}  // namespace kinalign
