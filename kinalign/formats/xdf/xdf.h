// SPDX-License-Identifier: Apache-2.0
// XDF 1.0, the files of the Lab Streaming Layer's recorders. Layout: docs/formats/xdf.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

enum class XdfFormat : std::uint8_t { int8, int16, int32, int64, float32, double64, string };

/// As a header writes it: "double64".
std::string_view name_of(XdfFormat format);

struct XdfChannel {
  std::string label, unit, type;  // as written; empty where not

  bool operator==(const XdfChannel&) const = default;
};

struct XdfStream {
  std::uint32_t id = 0;  // any number
  std::string name, type, source_id, hostname, created_at;
  std::uint32_t channel_count = 0;
  double nominal_rate_hz = 0.0;  // 0: irregular
  XdfFormat format = XdfFormat::double64;
  std::vector<XdfChannel> channels;  // described: as many as there are in the header, or none
  std::string xml;                   // the header as it stands

  bool operator==(const XdfStream&) const = default;
};

/// Whole numbers, numbers (float32 is exact in them) or text, as the stream's format says.
using XdfValues =
    std::variant<std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>>;

/// The samples of one chunk.
struct XdfSamples {
  std::uint32_t stream = 0;
  std::vector<double> stamps;         // [T] s of the sender's clock, not corrected
  std::vector<std::uint8_t> deduced;  // [T] 1: not written, the one before + 1 / nominal rate
  XdfValues values;                   // [T,C]

  std::size_t size() const { return stamps.size(); }
  bool operator==(const XdfSamples&) const = default;
};

/// What the recorder measured of a stream's clock.
struct XdfClockOffset {
  std::uint32_t stream = 0;
  double time = 0.0;    // s, of the sender's clock: LabRecorder writes its own minus the offset
  double offset = 0.0;  // s, to be added to stamps

  bool operator==(const XdfClockOffset&) const = default;
};

using XdfItem = std::variant<XdfStream, XdfSamples, XdfClockOffset>;

/// Fed a file in pieces cut anywhere, it yields what the chunks hold, in their order. Memory goes
/// by what was fed since the last chunk that was whole or damaged; a piece of damage ends at the
/// next boundary chunk, which a recorder writes every 10 seconds. Footers are passed over: they may
/// contradict the chunks.
class XdfReader {
 public:
  explicit XdfReader(std::string name) : name_(std::move(name)) {}

  /// Fails where the file is none of this format (a gzip is named). After a failure the reader may
  /// not be used again.
  Result<void> feed(std::string_view piece, std::vector<XdfItem>& out);

  /// The file has ended: what is cut or damaged at its end is a finding.
  Result<void> finish(std::vector<XdfItem>& out);

  /// What was wrong and could be read all the same; a fault that repeats is one finding with a
  /// count and the offset of its first.
  Findings findings() const;

 private:
  struct Stream {
    XdfStream header;
    double last_stamp = 0.0;
  };
  struct Chunk {
    std::size_t content = 0;  // offset in `held_` behind the length: the tag
    std::uint64_t size = 0;   // of tag and content, as stated
  };
  enum class Found { chunk, more, damage };
  struct Fault {
    std::uint64_t times = 0, first_offset = 0;
    std::string expected, found;
  };

  Result<bool> begun();
  bool step(std::vector<XdfItem>& out);
  Found find_chunk(Chunk& chunk) const;
  bool resynchronise();
  std::optional<std::size_t> boundary_before(std::size_t end);
  void take(std::size_t bytes);
  void chunk(std::span<const std::uint8_t> bytes, std::vector<XdfItem>& out);
  void stream_header(std::span<const std::uint8_t> content, std::vector<XdfItem>& out);
  void samples(std::span<const std::uint8_t> content, std::vector<XdfItem>& out);
  void clock_offset(std::span<const std::uint8_t> content, std::vector<XdfItem>& out);
  void fault(const std::string& expected, const std::string& found);
  std::span<const std::uint8_t> ahead() const { return std::span(held_).subspan(at_); }

  std::string name_;
  std::vector<std::uint8_t> held_;
  std::size_t at_ = 0;        // of `held_`: what is before is done
  std::uint64_t offset_ = 0;  // in the file, of `held_[at_]`
  std::size_t searched_ = 0;  // bytes ahead in which no boundary begins
  bool begun_ = false, lost_ = false;
  std::map<std::uint32_t, std::optional<Stream>> streams_;  // without: its header can't be used
  std::vector<Fault> faults_;
};

bool looks_like_xdf(std::string_view head);

/// The sender's clock between two resets. Correct a stamp by adding offset + slope * (stamp -
/// origin).
struct XdfClockLine {
  double first = 0.0, last = 0.0;  // s, times of the first and last offset
  double origin = 0.0;             // s
  double offset = 0.0;             // s, at the origin
  double slope = 0.0;              // s/s; 0 where there is one offset only
  std::size_t offsets = 0;
  double rms_residual = 0.0;      // s, of all offsets, outliers too
  double largest_residual = 0.0;  // s
};

/// `offsets` are those of one stream in file order, below 1e15 s as XdfReader gives them. A reset
/// is a time that steps back, or an offset that steps by more than a second and stays: the next
/// offset is nearer to the new one than to the old one. An offset that steps and returns is an
/// outlier.
std::vector<XdfClockLine> fit_xdf_clock(std::span<const XdfClockOffset> offsets);

/// The stamp on the recorder's clock, by the line that is nearest in time. If two lines are equally
/// near, the later one counts. Without lines the stamp is unchanged.
double corrected_xdf_stamp(std::span<const XdfClockLine> lines, double stamp);

/// All items of a file, in its order, and what was wrong with it. Fails where `take` does.
Result<Findings> read_xdf(FileSystem& files, const std::string& path, const Progress& progress,
                          const std::function<Result<void>(const XdfItem&)>& take);

struct XdfStreamSurvey {
  XdfStream stream;
  std::uint64_t samples = 0, deduced = 0;  // stamps that were not written
  std::optional<double> first, last;       // least and greatest stamp, s of the sender's clock
  std::uint64_t backward = 0;              // stamps that step back
  double largest_step_back_s = 0.0;
  std::uint64_t timeless = 0;    // samples whose stamp is no number below 1e15
  std::uint64_t no_numbers = 0;  // values that are NaN or infinite
  std::uint64_t clock_offsets = 0;
  std::vector<XdfClockLine> clock;  // one for each stretch between resets of the sender's clock

  /// By the first and the last stamp, pauses and all; 0 where there is no time between them.
  double rate_hz() const;
};

struct XdfSurvey {
  std::uint64_t bytes = 0;
  std::vector<XdfStreamSurvey> streams;  // in the order of the file
  Findings findings;                     // of the reader
};

Result<XdfSurvey> survey_xdf(FileSystem& files, const std::string& path, const Progress& progress);

}  // namespace kinalign
