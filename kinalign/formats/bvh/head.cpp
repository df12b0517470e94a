// SPDX-License-Identifier: Apache-2.0
// Splits a BVH file into words, parses its hierarchy, and collects the head from pieces.
#include "kinalign/formats/bvh/head.h"

#include "kinalign/core/numbers.h"
#include "kinalign/core/utf8.h"
#include "kinalign/formats/distinct_names.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  }
  return out;
}

/// `text` without blanks and control characters at both ends. trimmed() in cells.h only removes
/// blanks, tabs and line ends.
std::string_view stripped(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Splits the text into words and counts lines, so that a message names the line of a word.
class BvhWords {
 public:
  BvhWords(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  /// The next word; empty at the end. A brace is a separate word.
  std::string_view next() {
    skip_blanks();
    const std::size_t begin = at_;
    if (at_ < text_.size() && is_brace(text_[at_])) return text_.substr(at_++, 1);
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_brace(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  std::string_view peek() {
    // A BvhWords consists of two views and two numbers, so a copy takes little time.
    const BvhWords before = *this;
    const std::string_view word = next();
    *this = before;
    return word;
  }

  /// The rest of the line up to a brace. A joint's name may contain blanks.
  std::string_view rest_of_line() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '{') ++at_;
    return stripped(text_.substr(begin, at_ - begin));
  }

  Error wrong(std::string expected, std::string_view found) const {
    return Error{std::string(name_), line_, std::move(expected),
                 found.empty() ? "the end of the file" : "'" + shown(found) + "'"};
  }

  std::int64_t line() const { return line_; }
  std::size_t at() const { return at_; }

 private:
  static bool is_brace(char c) { return c == '{' || c == '}'; }
  void skip_blanks() {
    for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
  }

  std::string_view text_, name_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

// The names in the order of Channel.
constexpr std::array<std::string_view, 6> channel_names{"xposition", "yposition", "zposition",
                                                        "xrotation", "yrotation", "zrotation"};

/// Parses the hierarchy without recursion, so that a deep hierarchy can't overflow the program's
/// stack. open_ is the list of joints whose brace is open.
class HierarchyParser {
 public:
  HierarchyParser(std::string_view text, std::string_view name, Findings& findings)
      : words_(text, name), name_(name), findings_(&findings) {}

  /// Parses the hierarchy and the two lines after MOTION.
  Result<BvhHierarchy> parse(std::size_t& rows) {
    std::string_view word = without_byte_order_mark(words_.next());
    if (lower(word) != "hierarchy") return Failure(words_.wrong("HIERARCHY", word));
    // All roots belong to one hierarchy, and each root has the parent -1.
    while (lower(words_.peek()) == "root") KA_TRY(root());
    word = words_.next();
    if (lower(word) != "motion") return Failure(words_.wrong("ROOT or MOTION", word));
    if (out_.names.empty()) return Failure(words_.wrong("a ROOT before MOTION", word));
    KA_TRY(timing());
    rows = words_.at();
    out_.offset_decimals = offset_decimals_;
    return std::move(out_);
  }

 private:
  Result<void> root() {
    words_.next();
    KA_TRY(open_joint(-1));
    while (!open_.empty()) KA_TRY(statement());
    return {};
  }

  Result<void> open_joint(int parent) {
    // No person or group of people has so many joints. The limits are needed, because the time of
    // later steps may grow with the square of these numbers.
    constexpr std::size_t most_joints = 10'000, deepest = 500;
    if (out_.names.size() == most_joints || open_.size() == deepest) {
      return Failure(words_.wrong("at most 10000 joints, 500 deep", "one more"));
    }
    out_.names.emplace_back(words_.rest_of_line());
    if (out_.names.back().empty()) return Failure(words_.wrong("a name", "nothing"));
    out_.parents.push_back(parent);
    out_.offsets.emplace_back(Vec3::Zero());
    out_.channels.emplace_back();
    // All statements up to the closing brace belong to this joint.
    open_.push_back(static_cast<int>(out_.names.size()) - 1);
    return brace("{");
  }

  /// Parses one statement of the innermost open joint.
  Result<void> statement() {
    const std::string_view word = words_.next();
    const std::string key = lower(word);
    const auto joint = static_cast<std::size_t>(open_.back());
    if (key == "offset") {
      out_.offsets[joint] = KA_TRY(offset());
    } else if (key == "channels") {
      KA_TRY(channels(out_.channels[joint]));
    } else if (key == "joint") {
      KA_TRY(open_joint(open_.back()));
    } else if (key == "end") {
      KA_TRY(end_site());
    } else if (key == "}") {
      open_.pop_back();
    } else {
      return Failure(words_.wrong("OFFSET, CHANNELS, JOINT, End Site or }", word));
    }
    return {};
  }

  Result<void> brace(std::string_view which) {
    const std::string_view word = words_.next();
    if (word != which) return Failure(words_.wrong(std::string(which), word));
    return {};
  }

  /// Parses an End Site, which has an offset and no channels.
  Result<void> end_site() {
    // Skips "Site", or whatever stands in its place.
    words_.rest_of_line();
    EndSite site;
    site.parent = open_.back();
    KA_TRY(brace("{"));
    if (lower(words_.peek()) == "offset") {
      words_.next();
      site.offset = KA_TRY(offset());
    }
    if (lower(words_.peek()) == "channels") {  // some files have "CHANNELS 0" here
      std::vector<Channel> none;
      words_.next();
      KA_TRY(channels(none));
      if (!none.empty()) return Failure(words_.wrong("an End Site without channels", "CHANNELS"));
    }
    out_.end_sites.push_back(site);
    return brace("}");
  }

  Result<Vec3> offset() {
    Vec3 out;
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_.next();
      if (!parse_number(word, out[i]) || !(std::abs(out[i]) < largest_number)) {
        return Failure(words_.wrong("three numbers after OFFSET", word));
      }
      offset_decimals_ = std::max(offset_decimals_, decimals_of(word));
    }
    return out;
  }

  /// Parses the channels of a joint: their number, then their names in the order of the values in a
  /// row.
  Result<void> channels(std::vector<Channel>& out) {
    std::string_view word = words_.next();
    double count = 0;
    // Both "3" and "3.0" are accepted. Each of the six channels may occur once.
    if (!parse_number(word, count) || count < 0 || count > 6 || count != std::floor(count)) {
      return Failure(words_.wrong("0 to 6 channels", word));
    }
    for (int i = 0; i < static_cast<int>(count); ++i) {
      word = words_.next();
      const auto* known = std::find(channel_names.begin(), channel_names.end(), lower(word));
      if (known == channel_names.end()) {
        return Failure(words_.wrong("a channel such as Xposition or Zrotation", word));
      }
      const auto channel = static_cast<Channel>(known - channel_names.begin());
      if (std::find(out.begin(), out.end(), channel) != out.end()) {
        return Failure(words_.wrong("channels that differ", word));
      }
      out.push_back(channel);
    }
    return {};
  }

  /// Parses "Frames: 12" and "Frame Time: 0.0083333". Blanks may stand in front of the colon.
  Result<void> timing() {
    const std::string_view frames = KA_TRY(value_of("frames", "Frames:"));
    out_.frames_line = words_.line();
    // The number of frames must have no sign and no fraction.
    if (!parse_integer(frames, out_.frames)) {
      return Failure(words_.wrong("the number of frames", frames));
    }
    if (lower(words_.peek()) != "frame") {
      return Failure(words_.wrong("Frame Time:", words_.next()));
    }
    words_.next();
    out_.frame_time = KA_TRY(value_of("time", "Frame Time:"));
    // Seconds. No recording has a longer frame time, and the limit keeps the last stamp in range.
    constexpr double longest = 1e4;
    if (!parse_number(out_.frame_time, out_.frame_seconds) || out_.frame_seconds <= 0.0 ||
        out_.frame_seconds > longest) {
      return Failure(words_.wrong("a frame time above 0 s", out_.frame_time));
    }
    // Some programs write the rate instead of the frame time.
    if (out_.frame_seconds >= 1.0) {
      add_warning(*findings_,
                  {std::string(name_), words_.line(), "a frame time below 1 s", out_.frame_time},
                  "the clip is read at less than one frame a second",
                  "if the number is a rate, write its inverse");
    }
    return {};
  }

  /// The word after `key` and a colon, with or without blanks around the colon.
  Result<std::string_view> value_of(std::string_view key, std::string_view wanted) {
    std::string_view word = words_.next();
    if (!lower(word).starts_with(key)) return Failure(words_.wrong(std::string(wanted), word));
    word.remove_prefix(key.size());
    // The forms "Frames:12", "Frames: 12" and "Frames : 12" all occur.
    if (word.empty()) word = words_.next();
    if (word.starts_with(':')) word.remove_prefix(1);
    return word.empty() ? words_.next() : word;
  }

  BvhWords words_;
  std::string_view name_;
  Findings* findings_;
  BvhHierarchy out_;
  std::vector<int> open_;    // joints whose brace is open, innermost last
  int offset_decimals_ = 0;  // largest number of decimals in any OFFSET
};

/// True if `text` extends beyond the number in the line "Frame Time: ...". The head is parsed only
/// when it is complete, so that each fault is reported once and with its line. This check only
/// compares words. It reads the whole text again for each piece, but a head rarely has several
/// pieces.
bool is_whole(std::string_view text) {
  BvhWords words(text, "");
  std::string word;
  const auto next = [&] {  // false if the word may continue in the next piece
    // Only the beginning of a long word needs to be compared.
    word = lower(words.next().substr(0, 64));
    return words.at() < text.size();
  };
  bool motion = false, frame = false;
  while (next()) {
    if (motion && frame && word.starts_with("time")) {  // as HierarchyParser::value_of does
      word.erase(0, 4);
      if (word.empty() && !next()) return false;
      if (word.starts_with(':')) word.erase(0, 1);
      return !word.empty() || next();
    }
    // The name of a joint is skipped, because it may be any word, such as "motion".
    if (word == "root" || word == "joint" || word == "end") words.rest_of_line();
    frame = word == "frame";
    motion = motion || word == "motion";
  }
  return false;
}

}  // namespace

std::size_t BvhHierarchy::row_size() const {
  std::size_t size = 0;
  for (const auto& joint : channels) size += joint.size();
  return size;
}

Result<BvhHierarchy> parse_bvh_hierarchy(std::string_view text, std::string_view name,
                                         std::size_t& rows, Findings& findings) {
  return HierarchyParser(text, name, findings).parse(rows);
}

Skeleton skeleton_of(const BvhHierarchy& hierarchy, const BvhOptions& options,
                     std::string_view name, Findings& findings) {
  Skeleton out;
  out.parents = hierarchy.parents;
  std::vector<std::string> names;
  // A take stores names as UTF-8.
  for (const std::string& written : hierarchy.names) names.push_back(as_utf8(written));
  out.joint_names = distinct_names(names);
  for (std::size_t j = 0; j < out.joint_names.size(); ++j) {
    const std::string& written = names[j];
    if (out.joint_names[j] == written) continue;
    add_warning(findings,
                {std::string(name), 0, "different joint names", "'" + shown(written) + "' twice"},
                "read as '" + shown(out.joint_names[j]) + "'");
  }
  for (std::size_t j = 0; j < hierarchy.offsets.size(); ++j) {
    const Vec3 offset = hierarchy.offsets[j] * options.metres_per_unit;
    // Only the offset of a root is in the world. All other offsets are in the parent's space, whose
    // axes stay as they are.
    const bool in_world = options.z_up && hierarchy.parents[j] < 0;
    out.rest_offsets.push_back(in_world ? Vec3(offset.x(), offset.z(), -offset.y()) : offset);
  }
  for (EndSite site : hierarchy.end_sites) {
    site.offset *= options.metres_per_unit;
    out.end_sites.push_back(site);
  }
  return out;
}

Result<bool> BvhHead::add(std::string_view piece, Findings& findings) {
  constexpr std::size_t longest = std::size_t{8} << 20;
  text_ += piece;
  if (is_whole(text_)) {
    KA_TRY(parse(findings));
    return true;
  }
  if (text_.size() <= longest) return false;
  KA_TRY(finish(findings));  // reports an earlier fault in the text, if there is one
  return refuse(name_, "MOTION within the first 8 MiB", "none");
}

Result<void> BvhHead::finish(Findings& findings) {
  text_ += ' ';  // marks the end of the last word
  return parse(findings);
}

Result<void> BvhHead::parse(Findings& findings) {
  hierarchy = KA_TRY(parse_bvh_hierarchy(text_, name_, rows_, findings));
  return {};
}

// The number of the line on which the rows begin.
std::int64_t BvhHead::first_row_line() const {
  return 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(rows_), '\n');
}

void BvhHead::forget_text() {
  text_ = {};
  rows_ = 0;
}

std::string BvhHead::alone() const {
  const std::string head = text_.substr(0, rows_);
  // The last word "motion" in the head is the keyword, because only Frames and Frame Time follow
  // it.
  const std::size_t motion = lower(head).rfind("motion");
  return head.substr(0, motion) + "MOTION\nFrames: 0\nFrame Time: " + hierarchy.frame_time + "\n";
}

Result<std::string> read_bvh_head(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  BvhHead head(path);
  Findings findings;  // the reader of the whole file reports these findings
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    if (piece.empty()) {
      KA_TRY(head.finish(findings));
      return head.alone();
    }
    if (KA_TRY(head.add(piece, findings))) return head.alone();
  }
}

bool looks_like_bvh(std::string_view head) {
  head = without_byte_order_mark(head).substr(0, 64);
  return lower(stripped(head)).starts_with("hierarchy");
}

}  // namespace kinalign
