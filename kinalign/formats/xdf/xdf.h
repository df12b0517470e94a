// SPDX-License-Identifier: Apache-2.0
// Reads XDF 1.0, the file format of recorders for the Lab Streaming Layer (LSL). Layout:
// docs/formats/xdf.md.
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

/// The format's name in a header, for example "double64".
std::string_view name_of(XdfFormat format);

struct XdfChannel {
  std::string label, unit, type;  // texts in the header; empty if absent

  bool operator==(const XdfChannel&) const = default;
};

struct XdfStream {
  std::uint32_t id = 0;  // may be any number
  std::string name, type, source_id, hostname, created_at;
  std::uint32_t channel_count = 0;
  double nominal_rate_hz = 0.0;  // 0: samples come irregularly
  XdfFormat format = XdfFormat::double64;
  /// One element for each channel. It is empty if the header does not describe the channels.
  std::vector<XdfChannel> channels;
  std::string xml;  // the header as it stands in the file

  bool operator==(const XdfStream&) const = default;
};

/// The values of samples. The stream's format decides whether they are integers, floating-point
/// numbers or texts. A double contains a float32 exactly.
using XdfValues =
    std::variant<std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>>;

/// The samples of one chunk.
struct XdfSamples {
  std::uint32_t stream = 0;
  std::vector<double> stamps;  // [T] s on the sender's clock, not corrected
  /// [T] 1: the file omits the stamp, which is the previous stamp + 1 / nominal rate.
  std::vector<std::uint8_t> deduced;
  XdfValues values;  // [T,C]

  std::size_t size() const { return stamps.size(); }
  bool operator==(const XdfSamples&) const = default;
};

/// A measurement of a stream's clock by the recorder.
struct XdfClockOffset {
  std::uint32_t stream = 0;
  double time = 0.0;    // s on the sender's clock; for LabRecorder its own time minus the offset
  double offset = 0.0;  // s, to be added to the stamps of the stream

  bool operator==(const XdfClockOffset&) const = default;
};

using XdfItem = std::variant<XdfStream, XdfSamples, XdfClockOffset>;

/// Takes a file in pieces, which may be cut anywhere, and returns the content of the chunks in
/// order. It keeps the bytes after the last complete or damaged chunk. After damage, reading
/// continues at the next boundary chunk, which recorders write every 10 seconds. Footers are
/// skipped, because they may contradict the chunks.
class XdfReader {
 public:
  explicit XdfReader(std::string name) : name_(std::move(name)) {}

  /// Fails if the file is not an XDF file. The error says so if the file is compressed with gzip.
  /// After a failure the reader must not be used again.
  Result<void> feed(std::string_view piece, std::vector<XdfItem>& out);

  /// Call this at the end of the file. An incomplete or damaged end is a finding.
  Result<void> finish(std::vector<XdfItem>& out);

  /// Faults that did not stop the reading. A repeated fault is one finding with a count and the
  /// position of its first occurrence.
  Findings findings() const;

 private:
  struct Stream {
    XdfStream header;
    double last_stamp = 0.0;
  };
  struct Chunk {
    std::size_t content = 0;  // position of the tag in `held_`, after the length
    std::uint64_t size = 0;   // bytes of tag and content, as the chunk states
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
  std::size_t at_ = 0;        // position in `held_`; the bytes before it are handled
  std::uint64_t offset_ = 0;  // position of held_[at_] in the file
  std::size_t searched_ = 0;  // number of bytes from at_ on that contain no beginning of a boundary
  bool begun_ = false, lost_ = false;
  /// The streams by id. If a stream's header can't be used, its value is empty.
  std::map<std::uint32_t, std::optional<Stream>> streams_;
  std::vector<Fault> faults_;
};

bool looks_like_xdf(std::string_view head);

/// The sender's clock between two resets. The corrected stamp is stamp + offset + slope * (stamp -
/// origin).
struct XdfClockLine {
  double first = 0.0, last = 0.0;  // s, times of the first and the last offset
  double origin = 0.0;             // s, the time for which `offset` holds
  double offset = 0.0;             // s, at the time `origin`
  double slope = 0.0;              // s/s; 0 if there is only one offset
  /// The number of offsets in the fit.
  std::size_t offsets = 0;
  double rms_residual = 0.0;      // s, over all offsets including outliers
  double largest_residual = 0.0;  // largest distance of an offset from the line, s
};

/// Fits a line to each stretch between resets of the clock. `offsets` are the offsets of one stream
/// in the order of the file, below 1e15 s. A reset is a time that steps back, or an offset that
/// changes by more than a second and stays: the next offset is nearer to the new value than to the
/// old one. An offset that changes and returns is an outlier.
std::vector<XdfClockLine> fit_xdf_clock(std::span<const XdfClockOffset> offsets);

/// The stamp on the recorder's clock. The line that is nearest in time is used. If two lines are
/// equally near, the later one is used. Without lines the stamp stays unchanged.
double corrected_xdf_stamp(std::span<const XdfClockLine> lines, double stamp);

/// Passes all items of a file to `take` in the order of the file, and returns the faults. Fails if
/// `take` fails.
Result<Findings> read_xdf(FileSystem& files, const std::string& path, const Progress& progress,
                          const std::function<Result<void>(const XdfItem&)>& take);

struct XdfStreamSurvey {
  XdfStream stream;
  std::uint64_t samples = 0, deduced = 0;  // `deduced`: samples without a stamp in the file
  std::optional<double> first, last;       // smallest and largest stamp, s on the sender's clock
  std::uint64_t backward = 0;              // stamps below the previous stamp
  double largest_step_back_s = 0.0;
  std::uint64_t timeless = 0;    // samples whose stamp is not a number below 1e15
  std::uint64_t no_numbers = 0;  // values that are NaN or infinite
  std::uint64_t clock_offsets = 0;
  std::vector<XdfClockLine> clock;  // one line for each stretch between resets

  /// The rate from the first to the last stamp, including pauses; 0 if both are equal.
  double rate_hz() const;
};

struct XdfSurvey {
  std::uint64_t bytes = 0;
  std::vector<XdfStreamSurvey> streams;  // in the order of the file
  Findings findings;                     // findings of the reader
};

Result<XdfSurvey> survey_xdf(FileSystem& files, const std::string& path, const Progress& progress);

}  // namespace kinalign
