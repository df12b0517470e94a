// SPDX-License-Identifier: Apache-2.0
// The first pass over a BVH: hashes the file and counts its frames without parsing the numbers.
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

/// Number of words that begin in [at, end); at[-1] must be readable.
/// A word begins after a blank. The text before `at` decides about its first character.
KA_EVERY_PROCESSOR
std::uint64_t words_begun(const char* at, const char* end) {
  std::uint64_t words = 0;
  while (at < end) {
    // Counts in single bytes, which the vector unit adds 16 or more at a time; 255 characters can't
    // overflow them.
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

/// Counts the words of a text that comes in pieces.
/// last_ joins the pieces: a word that is cut between two pieces counts once.
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

/// Result of the counting pass.
struct Counted {
  BvhHierarchy hierarchy;
  Findings findings;
  InputFacts facts;
  /// Empty if the row is not complete within the rows' first piece or 64 KiB.
  std::vector<double> first_row;
  /// The words are those of the promised number of frames, and the last word has ended.
  /// If so, the number of frames is known without parsing the numbers.
  bool kept = false;
};

/// The first row of a text that begins with that row; empty if it is incomplete.
std::vector<double> first_row(std::string_view text, const std::string& path, std::size_t size) {
  // The row alone is wanted, so one frame is promised and later faults do not matter.
  BvhRows rows({path, size, 1, 1});
  Findings ignored;  // faults after the row
  if (!rows.feed(text, ignored) || !rows.finish(ignored) || rows.frames_read() == 0) return {};
  return {rows.frames().begin(), rows.frames().begin() + static_cast<std::ptrdiff_t>(size)};
}

/// Collects the text after a head, which comes in pieces.
struct RowsText {
  WordCount words;
  std::string start;  // beginning of the text

  void add(std::string_view piece) {
    constexpr std::size_t longest_start = 64 * 1024;  // long enough for a row of 3,000 joints
    words.add(piece);
    if (start.size() < longest_start) start += piece;
  }

  /// True if the number of words is that of the frames that the head promises.
  bool keeps(const BvhHierarchy& head) const {
    // A row with a wrong word passes this test; the reader finds it in the next pass.
    const std::uint64_t row_size = head.row_size();
    return row_size > 0 && !words.within_word() && words.words() % row_size == 0 &&
           words.words() / row_size == head.frames;
  }
};

/// Reads the whole file once: hash, head, number of words, first row.
/// The numbers are not parsed here; later passes do that.
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
      // The piece in which the head ends also holds the first rows.
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

/// Stamps of `frames` frames at an even step, computed without reading them.
/// The file has a fixed step, so nothing else is needed for them.
StampSurvey survey_of(const BvhOptions& options, double step_ns, std::uint64_t frames) {
  StampSurvey survey;
  survey.samples = frames;
  survey.first = survey.last = options.start;
  if (frames == 0) return survey;
  survey.last = frame_stamp(options.start, step_ns, frames - 1);
  survey.median_step_ns = frames > 1 ? std::llround(step_ns) : 0;
  return survey;
}

/// Parses all numbers of a file whose word count does not fit its head. Faults fail or become
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
  // If the words and the head disagree, only parsing tells what the file holds.
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
