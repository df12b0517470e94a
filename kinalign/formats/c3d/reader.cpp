// SPDX-License-Identifier: Apache-2.0
// Reads a C3D in pieces: header, parameters, then frame after frame.
#include "kinalign/core/numbers.h"
#include "kinalign/formats/c3d/c3d.h"
#include "kinalign/formats/c3d/parameters.h"
#include "kinalign/formats/distinct_names.h"
#include "kinalign/formats/point_rows.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/wire/little_endian_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

namespace kinalign {

namespace {

constexpr std::size_t most_zeros = 4096;  // zero bytes before the header
constexpr std::uint16_t saturated = 65'535;

// The first block has number 1.
std::size_t begin_of_block(std::size_t number) { return (number - 1) * c3d_block; }

/// The numbers of the header block, in the number format of the parameters' processor.
struct HeaderBlock {
  std::size_t points = 0, analog_values = 0;
  std::size_t first_frame = 0, last_frame = 0;
  std::size_t data_block = 0, analog_samples = 0;
  double scale = 0.0, rate_hz = 0.0;

  HeaderBlock() = default;
  // The places of the fields are those of the table in docs/formats/c3d.md.
  HeaderBlock(C3dProcessor p, const std::uint8_t* at)
      : points(c3d_u16(p, at + 2)),
        analog_values(c3d_u16(p, at + 4)),
        first_frame(c3d_u16(p, at + 6)),
        last_frame(c3d_u16(p, at + 8)),
        data_block(c3d_u16(p, at + 16)),
        analog_samples(c3d_u16(p, at + 18)),
        scale(c3d_f32(p, at + 12)),
        rate_hz(c3d_f32(p, at + 20)) {}

  std::uint64_t frames() const {
    return last_frame < first_frame ? 0 : last_frame - first_frame + 1;
  }
};

/// Number of frames that the file states. Empty if it states only that there are 65,535 or more.
std::optional<std::uint64_t> stated_frames(const HeaderBlock& header,
                                           const C3dParameters& parameters) {
  // Files with more than 65,535 frames state two 16-bit numbers, the lower one first.
  const auto field = [&](const char* name) -> std::optional<double> {
    const auto low = parameters.number("TRIAL", name, 0);
    const auto high = parameters.number("TRIAL", name, 1);
    if (!low || !high || !(*low < 65'536.0) || !(*high < 65'536.0)) return std::nullopt;
    return *low + 65'536.0 * *high;
  };
  // TRIAL holds 32 bits, so it comes before the fields of 16 bits.
  const auto start = field("ACTUAL_START_FIELD"), end = field("ACTUAL_END_FIELD");
  if (start && end && *end >= *start) return static_cast<std::uint64_t>(*end - *start) + 1;
  for (const char* name : {"LONG_FRAMES", "FRAMES"}) {
    const auto frames = parameters.number("POINT", name);
    if (frames && *frames >= 1.0 && *frames < 1e12 && *frames != saturated) {
      return static_cast<std::uint64_t>(*frames);
    }
  }
  // The header's field is full and no parameter tells more.
  if (header.last_frame == saturated) return std::nullopt;
  return header.frames();
}

/// The shortest decimal that rounds to this f32, as a person typed it: 59.94, not 59.93999863.
/// A rate is stored as f32. The double next to it is not the number that was meant.
double as_typed(double f32) {
  std::array<char, 32> room{};
  const char* end =
      std::to_chars(room.data(), room.data() + room.size(), static_cast<float>(f32)).ptr;
  double typed = f32;
  std::from_chars(room.data(), end, typed);
  return typed;
}

/// Metres per unit of POINT:UNITS; 0 if the unit is unknown.
double metres_of(std::string_view unit) {
  // Files without UNITS are taken as millimetres, the usual unit.
  if (unit == "mm" || unit.empty()) return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  return unit == "m" ? 1.0 : 0.0;
}

/// Our axes if the axis that Y_SCREEN names is up; empty for another text.
std::optional<Axes> axes_with_up(std::string_view axis) {
  if (axis.empty() || axis == "+Z" || axis == "Z") return z_up;
  if (axis == "+Y" || axis == "Y") return y_up;
  // x up: our y is the file's x, and our x is the file's -y.
  if (axis == "+X" || axis == "X") return Axes{-2, 1, 3};
  return std::nullopt;
}

/// The head is parsed in one piece, as soon as all its bytes are present. Then held_ contains the
/// incomplete frame only.
class C3dReader final : public PointReader {
 public:
  C3dReader(const StreamOptions& options, std::string_view file)
      : file_(file), options_(options), stamps_(false, 1.0, {}) {}

  Result<void> feed(std::string_view piece, PointFrames& out) override {
    piece = skip_zeros(piece);
    // A file of zeros alone is no C3D.
    if (zeros_ > most_zeros) return refuse("a C3D header", fmt::format("{} zero bytes", zeros_));
    held_.append(piece);
    if (!header_) KA_TRY(read_head());
    return header_ ? read_frames(out) : Result<void>{};
  }

  Result<void> finish(PointFrames&) override {
    if (!header_) {
      // Zero bytes count in positions, so that a message has the place in the file.
      return refuse("a C3D header and its parameters",
                    fmt::format("the end of the file at byte {}", zeros_ + held_.size()));
    }
    report();
    return {};
  }

  const PointHeader* header() const override { return header_ ? &*header_ : nullptr; }

 private:
  Failure refuse(std::string expected, std::string found) const {
    return kinalign::refuse(file_, std::move(expected), std::move(found));
  }

  /// Some programs write zero bytes before the header.
  std::string_view skip_zeros(std::string_view piece) {
    if (!held_.empty() || header_) return piece;
    const std::size_t first = std::min(piece.find_first_not_of('\0'), piece.size());
    zeros_ += first;
    return piece.substr(first);
  }

  const std::uint8_t* bytes() const { return octets(held_).data(); }

  /// Parses header and parameters once all bytes up to the data are present.
  Result<void> read_head() {
    if (held_.size() < c3d_block) return {};
    const std::size_t parameter_block = bytes()[0];
    if (held_[1] != 0x50 || parameter_block < 2) return refuse("a C3D header", "another beginning");
    const std::size_t parameters_at = begin_of_block(parameter_block);
    // The parameters' first four bytes state their length and the processor.
    if (held_.size() < parameters_at + 4) return {};
    const std::uint8_t processor = bytes()[parameters_at + 3];
    if (processor < 84 || processor > 86) {
      return refuse("processor 84, 85 or 86",
                    fmt::format("{} at byte {}", processor, zeros_ + parameters_at + 3));
    }
    const HeaderBlock read(static_cast<C3dProcessor>(processor), bytes());
    const std::size_t stated_end = begin_of_block(parameter_block + bytes()[parameters_at + 2]);
    // The parameters end where the data begin. Only a file without a usable data block falls back
    // on the stated number of blocks.
    const std::size_t end =
        read.data_block > parameter_block ? begin_of_block(read.data_block) : stated_end;
    if (held_.size() < end) return {};
    const auto parameters = KA_TRY(C3dParameters::parse(
        octets(held_).subspan(parameters_at, end - parameters_at), file_, zeros_ + parameters_at));
    KA_TRY(take_head(read, parameters));
    held_.erase(0, end);
    return {};
  }

  /// Takes the parts of the head one after the other.
  /// The sizes come first: all later parts depend on them.
  Result<void> take_head(const HeaderBlock& read, const C3dParameters& parameters) {
    processor_ = parameters.processor();
    KA_TRY(take_sizes(read, parameters));
    KA_TRY(take_units(parameters));
    KA_TRY(take_rate(read, parameters));
    take_frames(read, parameters);
    take_names(parameters);
    note_analog(read, parameters);
    states_.resize(points_);
    numbers_.resize(3 * points_);
    return {};
  }

  /// Finds the length of a frame. Every disagreement between header and parameters here would shift
  /// all following numbers, so it fails.
  Result<void> take_sizes(const HeaderBlock& read, const C3dParameters& parameters) {
    points_ = read.points;
    // USED and the header must agree on the number of points.
    const double used = parameters.number("POINT", "USED").value_or(static_cast<double>(points_));
    if (used != static_cast<double>(points_)) {
      return refuse(fmt::format("POINT:USED {} as in the header", points_),
                    fmt::format("{}", used));
    }
    if (points_ == 0) return refuse("points", "a C3D file without any");
    const auto channels = parameters.number("ANALOG", "USED");
    // A file without analog data may state 0 samples.
    const std::size_t samples = std::max<std::size_t>(read.analog_samples, 1);
    if (channels &&
        *channels * static_cast<double>(samples) != static_cast<double>(read.analog_values)) {
      return refuse(fmt::format("{} analog values in a frame as in the header", read.analog_values),
                    fmt::format("{} channels of {} samples", *channels, samples));
    }
    scale_ = parameters.number("POINT", "SCALE").value_or(read.scale);
    if (!(std::abs(scale_) > 0.0) || !(std::abs(scale_) < largest_number)) {
      return refuse("a scale of points other than 0", fmt::format("{}", scale_));
    }
    // The sign tells floats from integers, so the two must agree on it.
    if ((scale_ < 0.0) != (read.scale < 0.0)) {
      return refuse(fmt::format("POINT:SCALE of the sign of the header's {}", read.scale),
                    fmt::format("{}", scale_));
    }
    // Four numbers a point, then the analog values, all of one size.
    const std::size_t value = scale_ < 0.0 ? 4 : 2;
    frame_bytes_ = value * (4 * points_ + read.analog_values);
    const auto data_block = parameters.number("POINT", "DATA_START");
    if (data_block && *data_block != static_cast<double>(read.data_block)) {
      add_warning(findings,
                  {file_, 0, fmt::format("POINT:DATA_START {}", read.data_block),
                   fmt::format("{}", *data_block)},
                  "the data were read from the header's block");
    }
    return {};
  }

  /// Finds unit and axes. An unknown unit fails; an unknown axis is a finding, and z is then up.
  Result<void> take_units(const C3dParameters& parameters) {
    const auto one = [&](const char* name) {
      const auto texts = parameters.texts("POINT", name);
      return texts.empty() ? std::string() : texts.front();
    };
    const std::string unit = one("UNITS");
    const double metres = metres_of(unit);
    // A unit set by the user makes the file's own unit unimportant.
    if (metres == 0.0 && options_.metres_per_unit <= 0.0) {
      return refuse("POINT:UNITS mm, cm, m or in; otherwise set metres_per_unit", shown(unit));
    }
    const std::string up = one("Y_SCREEN");
    const auto axes = axes_with_up(up);
    if (!axes && options_.up.empty()) {
      add_warning(findings, {file_, 0, "POINT:Y_SCREEN +X, +Y or +Z", shown(up)},
                  "z is used as the upward axis", "set up = \"y\" or \"z\"");
    }
    // The user's `up` and metres_per_unit override both, in point_units().
    units_ = point_units({axes.value_or(z_up), metres}, options_);
    return {};
  }

  /// Finds the rate. The parameter wins over the header; a difference above 0.1 % is a finding.
  Result<void> take_rate(const HeaderBlock& read, const C3dParameters& parameters) {
    const double rate = as_typed(parameters.number("POINT", "RATE").value_or(read.rate_hz));
    const double used = options_.rate_hz > 0.0 ? options_.rate_hz : rate;
    if (!(used >= 1e-3) || !(used <= 1e6)) {
      return refuse("a rate of 0.001 to 1,000,000 Hz in POINT:RATE, or rate_hz",
                    fmt::format("{}", used));
    }
    if (std::abs(rate - read.rate_hz) > 1e-3 * rate) {
      add_warning(findings,
                  {file_, 0, fmt::format("POINT:RATE {:g} as in the header", read.rate_hz),
                   fmt::format("{:g}", rate)},
                  "POINT:RATE is used", "find out which rate is correct");
    }
    stamps_ = RowStamps(false, used, options_.start_ns);
    // The stamps are counted, not measured.
    counted = true;
    return {};
  }

  /// Finds the number of frames. The parameters win over the header; a difference is a finding.
  void take_frames(const HeaderBlock& read, const C3dParameters& parameters) {
    stated_ = stated_frames(read, parameters);
    // A full header field is no disagreement.
    if (!stated_ || *stated_ == read.frames() || read.last_frame == saturated) return;
    add_warning(findings,
                {file_, 0, fmt::format("{} frames as in the header", read.frames()),
                 fmt::format("{} in the parameters", *stated_)},
                "the number in the parameters is used");
  }

  /// Takes the points' names. Absent names become numbers, repeated names get #2, #3, ...
  void take_names(const C3dParameters& parameters) {
    std::vector<std::string> names = parameters.all_texts("POINT", "LABELS");
    if (names.size() < points_) {
      add_warning(findings,
                  {file_, 0, fmt::format("{} names in POINT:LABELS", points_),
                   std::to_string(names.size())},
                  "the other points are named by their numbers");
    }
    names.resize(points_);
    for (std::size_t j = 0; j < points_; ++j) {
      if (names[j].empty()) names[j] = "point" + std::to_string(j + 1);
    }
    header_ = PointHeader{distinct_names(names)};
    const std::size_t repeated =
        points_ - std::set<std::string_view>(names.begin(), names.end()).size();
    if (repeated > 0) {
      add_warning(
          findings,
          {file_, 0, "different names in POINT:LABELS", fmt::format("{} repeated", repeated)},
          "repeated names are name#2, name#3, ...");
    }
  }

  /// Adds a note that names the analog channels, which are not read.
  void note_analog(const HeaderBlock& read, const C3dParameters& parameters) {
    if (read.analog_values == 0) return;
    // Analog values of a frame: channels times samples.
    const std::size_t channels = read.analog_values / std::max<std::size_t>(read.analog_samples, 1);
    std::vector<std::string> names = parameters.all_texts("ANALOG", "LABELS");
    names.resize(std::min(names.size(), channels));
    std::string listed;
    for (const std::string& name : names) {
      // A note that lists hundreds of channels would fill the screen.
      if (listed.size() > 100) {
        listed += ", ...";
        break;
      }
      listed += (listed.empty() ? ": " : ", ") + shown(name);
    }
    add_note(findings,
             {file_, 0, "only points", fmt::format("{} analog channels{}", channels, listed)},
             "the analog channels were not read");
  }

  /// Parses all complete frames of the bytes kept. Bytes after the last stated frame are only
  /// counted.
  Result<void> read_frames(PointFrames& out) {
    // Complete frames are taken from the front. The rest waits for the next piece.
    std::size_t at = 0;
    while (held_.size() - at >= frame_bytes_ && (!stated_ || stamps_.rows() < *stated_)) {
      KA_TRY(read_frame(bytes() + at, out));
      at += frame_bytes_;
    }
    // After the last stated frame only zeros are expected, up to the end of the block.
    if (stated_ && stamps_.rows() == *stated_) {
      behind_ += held_.size() - at;
      at = held_.size();
    }
    held_.erase(0, at);
    return {};
  }

  /// Appends one frame. Zeros fill up the last block of a file. If the file does not state its
  /// number of frames, frames of zeros are kept until they are as long as a block or another frame
  /// follows.
  Result<void> read_frame(const std::uint8_t* at, PointFrames& out) {
    if (!stated_ && (zero_frames_ + 1) * frame_bytes_ < c3d_block &&
        std::all_of(at, at + frame_bytes_, [](std::uint8_t b) { return b == 0; })) {
      ++zero_frames_;
      return {};
    }
    // The frames of zeros were not padding, since another frame follows.
    const std::vector<std::uint8_t> zeros(zero_frames_ > 0 ? frame_bytes_ : 0);
    for (; zero_frames_ > 0; --zero_frames_) KA_TRY(append_frame(zeros.data(), out));
    return append_frame(at, out);
  }

  /// Converts one frame. The fourth number of a point is negative if the point is invalid.
  Result<void> append_frame(const std::uint8_t* at, PointFrames& out) {
    const Time stamp = KA_TRY(stamp_of_next());
    for (std::size_t j = 0; j < points_; ++j) {
      double* to = &numbers_[3 * j];
      double fourth = 0.0;
      // Floats are coordinates already; integers are multiplied by the scale.
      if (scale_ < 0.0) {
        for (std::size_t k = 0; k < 3; ++k) to[k] = c3d_f32(processor_, at + 16 * j + 4 * k);
        fourth = c3d_f32(processor_, at + 16 * j + 12);
      } else {
        for (std::size_t k = 0; k < 3; ++k) {
          to[k] = scale_ * c3d_i16(processor_, at + 8 * j + 2 * k);
        }
        fourth = c3d_i16(processor_, at + 8 * j + 6);
      }
      // NaN compares as false, so it is no number either.
      const bool number = std::abs(to[0]) < largest_number && std::abs(to[1]) < largest_number &&
                          std::abs(to[2]) < largest_number;
      const bool valid = fourth >= 0.0;
      no_numbers_ += valid && !number ? 1 : 0;
      states_[j] = valid && number ? Tracking::tracked : Tracking::missing;
    }
    out.stamps.push_back(stamp);
    append_points(units_, numbers_.data(), states_, out);
    return {};
  }

  Result<Time> stamp_of_next() {
    auto stamp = stamps_.next(0);
    if (!stamp) stamp.error().file = file_;
    return stamp;
  }

  void report() {
    if (stated_ && stamps_.rows() < *stated_) {
      add_warning(findings,
                  {file_, 0, fmt::format("{} frames", *stated_), std::to_string(stamps_.rows())},
                  "the existing frames were read");
    }
    // Less than a block is the padding of the last one.
    if (behind_ > c3d_block) {
      add_warning(findings,
                  {file_, 0, fmt::format("the end of the file after {} frames", *stated_),
                   fmt::format("{} more bytes", behind_)},
                  "these bytes were not read", "the file may have more frames than it states");
    }
    if (no_numbers_ > 0) {
      add_warning(findings,
                  {file_, 0, "coordinates below 1e15",
                   fmt::format("{} points with other values", no_numbers_)},
                  "these points are missing");
    }
  }

  std::string file_;
  StreamOptions options_;
  RowStamps stamps_;
  std::string held_;         // bytes of the head, later of the incomplete frame
  std::uint64_t zeros_ = 0;  // zero bytes before the header
  C3dProcessor processor_ = C3dProcessor::intel;
  std::size_t points_ = 0, frame_bytes_ = 0;
  double scale_ = 0.0;  // factor of integers; negative: the values are floats
  PointUnits units_;
  std::optional<std::uint64_t> stated_;  // number of frames, if the file states it
  std::uint64_t zero_frames_ = 0, behind_ = 0, no_numbers_ = 0;
  std::vector<Tracking> states_;  // [J] of the current frame
  std::vector<double> numbers_;   // [J,3] of the current frame
  std::optional<PointHeader> header_;
};

}  // namespace

std::unique_ptr<PointReader> make_c3d_reader(const StreamOptions& options, std::string_view file) {
  return std::make_unique<C3dReader>(options, file);
}

bool looks_like_c3d(std::string_view head) {
  // Skipped as the reader does it.
  head.remove_prefix(std::min(head.find_first_not_of('\0'), head.size()));
  if (head.size() < c3d_block || head[1] != 0x50) return false;
  const auto parameter_block = static_cast<std::uint8_t>(head[0]);
  if (parameter_block < 2) return false;
  const std::size_t processor_at = begin_of_block(parameter_block) + 3;
  if (head.size() <= processor_at) return false;
  const auto processor = static_cast<std::uint8_t>(head[processor_at]);
  return processor >= 84 && processor <= 86;
}

}  // namespace kinalign
