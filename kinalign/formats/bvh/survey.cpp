// SPDX-License-Identifier: Apache-2.0
// The first pass over a BVH file: hashes the file and counts its frames without parsing the
// numbers.
#include "kinalign/core/hash.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/bvh/head.h"
#include "kinalign/formats/bvh/rows.h"
#include "kinalign/motion/stamps.h"
#include "kinalign/motion/targets.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// The number of words that begin in [at, end). A word begins after a blank, so at[-1] must be
/// readable, too.
KA_EVERY_PROCESSOR
std::uint64_t words_begun(const char* at, const char* end) {
  std::uint64_t words = 0;
  while (at < end) {
    // The counter has one byte, because the vector unit adds 16 or more bytes at a time. 255
    // characters can't overflow it.
    const char* stop = at + std::min<std::ptrdiff_t>(end - at, 255);
    unsigned char some = 0;
    for (; at < stop; ++at) {
      const auto here = static_cast<unsigned char>(*at),
                 before = static_cast<unsigned char>(at[-1]);
      some = static_cast<unsigned char>(some + ((here > ' ') & (before <= ' ')));
    }
    words += some;
  }
  return words;
}

/// Counts the words of a text that arrives in pieces. last_ connects the pieces, so that a word
/// with a cut in it counts once.
class WordCount {
 public:
  void add(std::string_view piece) {
    if (piece.empty()) return;
    const std::string first{last_, piece.front()};
    words_ += words_begun(first.data() + 1, first.data() + 2);
    words_ += words_begun(piece.data() + 1, piece.data() + piece.size());
    last_ = piece.back();
  }
  std::uint64_t words() const { return words_; }
  bool within_word() const { return !is_blank(last_); }

 private:
  char last_ = ' ';
  std::uint64_t words_ = 0;
};

/// The result of the counting pass.
struct Counted {
  BvhHierarchy hierarchy;
  Findings findings;
  InputFacts facts;
  /// The first row; empty if it is not complete within the first piece of rows or within 64 KiB.
  std::vector<double> first_row;
  /// True if the number of words fits the stated number of frames and the last word has ended. The
  /// numbers then need not be parsed.
  bool kept = false;
};

/// The first row of a text that begins with this row; empty if the row is incomplete.
std::vector<double> first_row(std::string_view text, const std::string& path, std::size_t size) {
  // Only one frame is requested, so later faults do not matter.
  BvhRows rows({path, size, 1, 1});
  Findings ignored;  // faults after the first row
  if (!rows.feed(text, ignored) || !rows.finish(ignored) || rows.frames_read() == 0) return {};
  return {rows.frames().begin(), rows.frames().begin() + static_cast<std::ptrdiff_t>(size)};
}

/// Collects the text after a head. The text arrives in pieces.
struct RowsText {
  WordCount words;
  std::string start;  // the beginning of the text

  void add(std::string_view piece) {
    constexpr std::size_t longest_start = 64 * 1024;  // enough for a row of 3,000 joints
    words.add(piece);
    if (start.size() < longest_start) start += piece;
  }

  /// True if the number of words fits the number of frames in the head.
  bool keeps(const BvhHierarchy& head) const {
    // A row with a word that is not a number passes this test. The reader finds it in the next
    // pass.
    const std::uint64_t row_size = head.row_size();
    return row_size > 0 && !words.within_word() && words.words() % row_size == 0 &&
           words.words() / row_size == head.frames;
  }
};

/// Reads the whole file once for hash, head, number of words and first row. Later passes parse the
/// numbers.
Result<Counted> count(FileSystem& files, const std::string& path, const Progress& progress) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  Counted out;
  Sha256 hash;
  BvhHead head(path);
  RowsText rows;
  bool in_rows = false;
  std::uint64_t bytes = 0;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    if (piece.empty()) break;
    hash.update(piece);
    bytes += piece.size();
    if (in_rows) {
      rows.add(piece);
    } else if (KA_TRY(head.add(piece, out.findings))) {
      // The piece that completes the head also contains the first rows.
      rows.add(head.rows());
      in_rows = true;
    }
    if (!go_on(progress, "reading", bytes, file.size())) return Failure(interruption(path));
  }
  if (!in_rows) KA_TRY(head.finish(out.findings));
  out.facts = {std::string(file_name(path)), hash.hex(), bytes};
  out.kept = in_rows && rows.keeps(head.hierarchy);
  if (out.kept) out.first_row = first_row(rows.start, path, head.hierarchy.row_size());
  out.hierarchy = std::move(head.hierarchy);
  return out;
}

/// The stamps of `frames` frames with a fixed frame time. They are computed without reading the
/// frames.
StampSurvey survey_of(const BvhOptions& options, double step_ns, std::uint64_t frames) {
  StampSurvey survey;
  survey.samples = frames;
  survey.first = survey.last = options.start;
  if (frames == 0) return survey;
  survey.last = frame_stamp(options.start, step_ns, frames - 1);
  survey.median_step_ns = frames > 1 ? std::llround(step_ns) : 0;
  return survey;
}

/// Parses all numbers of a file whose count of words does not fit its head. Faults are errors or
/// findings.
Result<ClipSurvey> read_all(FileSystem& files, const std::string& path, const BvhOptions& options,
                            const Progress& progress) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  const auto reader = make_bvh_reader(options, path);
  ClipSurvey out;
  std::uint64_t bytes = 0;
  for (bool ended = false; !ended;) {
    const std::string_view piece = KA_TRY(file.next());
    bytes += piece.size();
    if (!go_on(progress, "reading", bytes, file.size())) return Failure(interruption(path));
    ClipFrames block;
    ended = piece.empty();
    KA_TRY(ended ? reader->finish(block) : reader->feed(piece, block));
    out.survey.samples += block.size();
  }
  out.skeleton = *reader->header();
  out.findings = std::move(reader->findings);
  return out;
}

}  // namespace

Result<ClipSurvey> survey_bvh(FileSystem& files, const std::string& path, const BvhOptions& options,
                              const Progress& progress) {
  Counted counted = KA_TRY(count(files, path, progress));
  ClipSurvey out;
  // If the number of words does not fit the head, all numbers are parsed.
  if (!counted.kept) {
    out = KA_TRY(read_all(files, path, options, progress));
  } else {
    out.findings = std::move(counted.findings);
    out.skeleton = skeleton_of(counted.hierarchy, options, path, out.findings);
    append(out.findings,
           judge_size(counted.hierarchy, out.skeleton, counted.first_row, options, path));
  }
  out.facts = std::move(counted.facts);
  out.step_ns = counted.hierarchy.frame_seconds * 1e9;
  const std::uint64_t frames = counted.kept ? counted.hierarchy.frames : out.survey.samples;
  out.survey = survey_of(options, out.step_ns, frames);
  return out;
}

}  // namespace kinalign
