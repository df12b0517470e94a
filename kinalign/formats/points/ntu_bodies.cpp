// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ntu_bodies.h"

#include "kinalign/core/lines.h"
#include "kinalign/formats/cells.h"

#include <algorithm>
#include <charconv>

namespace kinalign {

namespace {

// The list is for a message or a menu; a file with more bodies is damaged.
constexpr std::size_t most_kept = 1000;
constexpr std::uint64_t most_counted = 1000;  // bodies of a frame, joints of a body

/// Follows the counts in the file and skips the joints.
/// A line has no mark of its kind: only the counts before it tell what it holds.
class BodyCount {
 public:
  /// Reads one line. The counts before it tell what the line holds.
  Result<void> read(std::string_view line) {
    line = trimmed(line);
    if (line.empty()) return {};
    // The joints' numbers are not needed here.
    if (joints_left_ > 0) {
      --joints_left_;
      return {};
    }
    // The file's first line.
    if (!began_) {
      began_ = true;
      KA_TRY(count(line, "the number of frames", UINT64_MAX));
    } else if (in_body_) {
      // A body's line is followed by the number of its joints.
      joints_left_ = KA_TRY(count(line, "the number of joints", most_counted));
      in_body_ = false;
    } else if (bodies_left_ > 0) {
      --bodies_left_;
      // The id is the first cell of a body's line.
      see(line.substr(0, line.find_first_of(" \t")));
      in_body_ = true;
    } else {
      // The frame is complete; the next one begins with its number of bodies.
      bodies_left_ = KA_TRY(count(line, "the number of bodies", most_counted));
    }
    return {};
  }

  std::vector<NtuBody> bodies() && {
    // Stable, so that bodies with equally many frames keep the order of the file.
    std::stable_sort(bodies_.begin(), bodies_.end(),
                     [](const NtuBody& a, const NtuBody& b) { return a.frames > b.frames; });
    return std::move(bodies_);
  }

 private:
  static Result<std::uint64_t> count(std::string_view text, std::string expected,
                                     std::uint64_t most) {
    std::uint64_t value = 0;
    const auto [behind, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    // "25x" is no count.
    const bool whole = fault == std::errc{} && behind == text.data() + text.size();
    if (whole && value <= most) return value;
    return Failure(Error{"", 0, std::move(expected), shown(text)});
  }

  void see(std::string_view id) {
    const auto at = std::find_if(bodies_.begin(), bodies_.end(),
                                 [&](const NtuBody& one) { return one.id == id; });
    // Later bodies are not listed; those in the list are still counted.
    if (at != bodies_.end()) {
      ++at->frames;
    } else if (bodies_.size() < most_kept) {
      bodies_.push_back({std::string(id), 1});
    }
  }

  bool began_ = false, in_body_ = false;
  std::uint64_t bodies_left_ = 0, joints_left_ = 0;
  std::vector<NtuBody> bodies_;
};

}  // namespace

Result<std::vector<NtuBody>> ntu_bodies(const TextPieces& text, const std::string& name) {
  // The same errors as in a reader, with the file's name and line.
  LineSplitter lines;
  BodyCount count;
  const auto use = [&](std::string_view line) { return count.read(line); };
  const auto placed = [&](Result<void> done) -> Result<void> {
    if (done) return {};
    Error error = done.error();
    error.file = name;
    if (error.line == 0) error.line = lines.number();
    return Failure(std::move(error));
  };
  for (;;) {
    const std::string_view piece = KA_TRY(text());
    if (piece.empty()) break;
    KA_TRY(placed(lines.feed(piece, use)));
  }
  KA_TRY(placed(lines.finish(use)));
  return std::move(count).bodies();
}

}  // namespace kinalign
