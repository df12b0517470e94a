// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bvh/head.h"

#include "kinalign/formats/bvh/words.h"

#include <algorithm>

namespace kinalign {

namespace {

/// True where `text` reaches beyond the number of the line "Frame Time: ...".
bool is_whole(std::string_view text) {
  BvhWords words(text, "");
  std::string word;
  const auto next = [&] {  // false where nothing ends the word yet
    word = lower(words.next().substr(0, 64));
    return words.at() < text.size();
  };
  bool motion = false, frame = false;
  while (next()) {
    if (motion && frame && word.starts_with("time")) {  // as the hierarchy's parser reads it
      word.erase(0, 4);
      if (word.empty() && !next()) return false;
      if (word.starts_with(':')) word.erase(0, 1);
      return !word.empty() || next();
    }
    if (word == "root" || word == "joint" || word == "end") words.rest_of_line();  // any name
    frame = word == "frame";
    motion = motion || word == "motion";
  }
  return false;
}

}  // namespace

Result<bool> BvhHead::add(std::string_view piece, Findings& findings) {
  constexpr std::size_t longest = std::size_t{8} << 20;
  text_ += piece;
  if (is_whole(text_)) {
    KA_TRY(parse(findings));
    return true;
  }
  if (text_.size() <= longest) return false;
  KA_TRY(finish(findings));  // says what is wrong with the text, if anything is but its length
  return Failure(Error{name_, 0, "MOTION within the first 8 MiB", "none"});
}

Result<void> BvhHead::finish(Findings& findings) {
  text_ += ' ';  // ends the last word
  return parse(findings);
}

Result<void> BvhHead::parse(Findings& findings) {
  hierarchy = KA_TRY(parse_bvh_hierarchy(text_, name_, rows_, findings));
  return {};
}

std::int64_t BvhHead::first_row_line() const {
  return 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(rows_), '\n');
}

void BvhHead::forget_text() {
  text_ = {};
  rows_ = 0;
}

std::string BvhHead::alone() const {
  const std::string head = text_.substr(0, rows_);
  // Behind it are only the words Frames and Frame Time.
  const std::size_t motion = lower(head).rfind("motion");
  return head.substr(0, motion) + "MOTION\nFrames: 0\nFrame Time: " + hierarchy.frame_time + "\n";
}

Result<std::string> read_bvh_head(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  BvhHead head(path);
  Findings findings;  // what is doubtful in it is told where it is used
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
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  return lower(stripped(head.substr(0, 64))).starts_with("hierarchy");
}

}  // namespace kinalign
