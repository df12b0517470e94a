// SPDX-License-Identifier: Apache-2.0
// Reads a C3D file in pieces: header, parameters, then frames.
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

constexpr std::size_t most_zeros = 4096;  // limit on zero bytes before the header
constexpr std::uint16_t saturated = 65'535;

// The position of a block. Blocks are numbered from 1.
std::size_t begin_of_block(std::size_t number) { return (number - 1) * c3d_block; }

/// The numbers in the header block, in the number format of the processor.
struct HeaderBlock {
  std::size_t points = 0, analog_values = 0;
  std::size_t first_frame = 0, last_frame = 0;
  std::size_t data_block = 0, analog_samples = 0;
  double scale = 0.0, rate_hz = 0.0;

  HeaderBlock() = default;
  // For the positions of the fields see the table in docs/formats/c3d.md.
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

/// The number of frames in the head. The result is empty if the head only says 65,535 or more.
std::optional<std::uint64_t> stated_frames(const HeaderBlock& header,
                                           const C3dParameters& parameters) {
  // In files with more than 65,535 frames, a number is stored as two 16-bit numbers, the lower half
  // first.
  const auto field = [&](const char* name) -> std::optional<double> {
    const auto low = parameters.number("TRIAL", name, 0);
    const auto high = parameters.number("TRIAL", name, 1);
    if (!low || !high || !(*low < 65'536.0) || !(*high < 65'536.0)) return std::nullopt;
    return *low + 65'536.0 * *high;
  };
  // The parameters in TRIAL have 32 bits, so they are preferred to the fields with 16 bits.
  const auto start = field("ACTUAL_START_FIELD"), end = field("ACTUAL_END_FIELD");
  if (start && end && *end >= *start) return static_cast<std::uint64_t>(*end - *start) + 1;
  for (const char* name : {"LONG_FRAMES", "FRAMES"}) {
    const auto frames = parameters.number("POINT", name);
    if (frames && *frames >= 1.0 && *frames < 1e12 && *frames != saturated) {
      return static_cast<std::uint64_t>(*frames);
    }
  }
  // The field has its largest value, and no parameter contains the real number.
  if (header.last_frame == saturated) return std::nullopt;
  return header.frames();
}

/// The shortest decimal number that rounds to this 32-bit float. A rate such as 59.94 is stored as
/// a float, and its conversion to double would give 59.93999863.
double as_typed(double f32) {
  std::array<char, 32> room{};
  const char* end =
      std::to_chars(room.data(), room.data() + room.size(), static_cast<float>(f32)).ptr;
  double typed = f32;
  std::from_chars(room.data(), end, typed);
  return typed;
}

/// The metres per unit in POINT:UNITS; 0 if the unit is unknown.
double metres_of(std::string_view unit) {
  // Files without UNITS are read as millimetres, which is the usual unit.
  if (unit == "mm" || unit.empty()) return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  return unit == "m" ? 1.0 : 0.0;
}

/// The conversion of axes if the axis in Y_SCREEN is up; empty for any other text.
std::optional<Axes> axes_with_up(std::string_view axis) {
  if (axis.empty() || axis == "+Z" || axis == "Z") return z_up;
  if (axis == "+Y" || axis == "Y") return y_up;
  // If x is up, kinalign's y is the file's x, and kinalign's x is the file's -y.
  if (axis == "+X" || axis == "X") return Axes{-2, 1, 3};
  return std::nullopt;
}

/// Reads a C3D file. The head is parsed when all its bytes are present. Afterwards held_ only
/// contains the incomplete frame.
class C3dReader final : public PointReader {
 public:
  C3dReader(const StreamOptions& options, std::string_view file)
      : file_(file), options_(options), stamps_(false, 1.0, {}) {}

  Result<void> feed(std::string_view piece, PointFrames& out) override {
    piece = skip_zeros(piece);
    // A file of zeros is not a C3D file.
    if (zeros_ > most_zeros) return refuse("a C3D header", fmt::format("{} zero bytes", zeros_));
    held_.append(piece);
    if (!header_) KA_TRY(read_head());
    return header_ ? read_frames(out) : Result<void>{};
  }

  Result<void> finish(PointFrames&) override {
    if (!header_) {
      // Positions in messages include the zero bytes in front of the header.
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

  /// Skips zero bytes in front of the header, which some programs write.
  std::string_view skip_zeros(std::string_view piece) {
    if (!held_.empty() || header_) return piece;
    const std::size_t first = std::min(piece.find_first_not_of('\0'), piece.size());
    zeros_ += first;
    return piece.substr(first);
  }

  const std::uint8_t* bytes() const { return octets(held_).data(); }

  /// Parses header and parameters when all bytes before the data are present.
  Result<void> read_head() {
    if (held_.size() < c3d_block) return {};
    const std::size_t parameter_block = bytes()[0];
    if (held_[1] != 0x50 || parameter_block < 2) return refuse("a C3D header", "another beginning");
    const std::size_t parameters_at = begin_of_block(parameter_block);
    // The first four bytes of the parameters contain their length and the processor.
    if (held_.size() < parameters_at + 4) return {};
    const std::uint8_t processor = bytes()[parameters_at + 3];
    if (processor < 84 || processor > 86) {
      return refuse("processor 84, 85 or 86",
                    fmt::format("{} at byte {}", processor, zeros_ + parameters_at + 3));
    }
    const HeaderBlock read(static_cast<C3dProcessor>(processor), bytes());
    const std::size_t stated_end = begin_of_block(parameter_block + bytes()[parameters_at + 2]);
    // The parameters end where the data begin. The stated number of blocks is used only if the
    // position of the data is not usable.
    const std::size_t end =
        read.data_block > parameter_block ? begin_of_block(read.data_block) : stated_end;
    if (held_.size() < end) return {};
    const auto parameters = KA_TRY(C3dParameters::parse(
        octets(held_).subspan(parameters_at, end - parameters_at), file_, zeros_ + parameters_at));
    KA_TRY(take_head(read, parameters));
    held_.erase(0, end);
    return {};
  }

  /// Reads the parts of the head one after the other. The sizes come first, because all other parts
  /// depend on them.
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

  /// Computes the size of a frame. If header and parameters disagree here, all following numbers
  /// would be at wrong positions, so this is an error.
  Result<void> take_sizes(const HeaderBlock& read, const C3dParameters& parameters) {
    points_ = read.points;
    // USED and the header must state the same number of points.
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
    // The sign of the scale distinguishes floats from integers, so both signs must be equal.
    if ((scale_ < 0.0) != (read.scale < 0.0)) {
      return refuse(fmt::format("POINT:SCALE of the sign of the header's {}", read.scale),
                    fmt::format("{}", scale_));
    }
    // A point has four numbers. The analog values follow, with the same size per number.
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

  /// Reads unit and axes. An unknown unit is an error. An unknown axis is a finding, and z is then
  /// up.
  Result<void> take_units(const C3dParameters& parameters) {
    const auto one = [&](const char* name) {
      const auto texts = parameters.texts("POINT", name);
      return texts.empty() ? std::string() : texts.front();
    };
    const std::string unit = one("UNITS");
    const double metres = metres_of(unit);
    // If the user gave a unit, the unit in the file does not matter.
    if (metres == 0.0 && options_.metres_per_unit <= 0.0) {
      return refuse("POINT:UNITS mm, cm, m or in; otherwise set metres_per_unit", shown(unit));
    }
    const std::string up = one("Y_SCREEN");
    const auto axes = axes_with_up(up);
    if (!axes && options_.up.empty()) {
      add_warning(findings, {file_, 0, "POINT:Y_SCREEN +X, +Y or +Z", shown(up)},
                  "z is used as the upward axis", "set up = \"y\" or \"z\"");
    }
    // In point_units(), the user's options `up` and metres_per_unit override both values.
    units_ = point_units({axes.value_or(z_up), metres}, options_);
    return {};
  }

  /// Reads the rate. The parameter is preferred to the header. A difference above 0.1 % is a
  /// finding.
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
    // The file contains no times, so the stamps are counted by the rate.
    counted = true;
    return {};
  }

  /// Reads the number of frames. The parameters are preferred to the header. A difference is a
  /// finding.
  void take_frames(const HeaderBlock& read, const C3dParameters& parameters) {
    stated_ = stated_frames(read, parameters);
    // If the header's field has its largest value, the difference is not a fault.
    if (!stated_ || *stated_ == read.frames() || read.last_frame == saturated) return;
    add_warning(findings,
                {file_, 0, fmt::format("{} frames as in the header", read.frames()),
                 fmt::format("{} in the parameters", *stated_)},
                "the number in the parameters is used");
  }

  /// Reads the names of the points. Absent names become numbers, and repeated names get #2, #3 and
  /// so on.
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

  /// Adds a note with the names of the analog channels, which are not read.
  void note_analog(const HeaderBlock& read, const C3dParameters& parameters) {
    if (read.analog_values == 0) return;
    // A frame has channels * samples analog values.
    const std::size_t channels = read.analog_values / std::max<std::size_t>(read.analog_samples, 1);
    std::vector<std::string> names = parameters.all_texts("ANALOG", "LABELS");
    names.resize(std::min(names.size(), channels));
    std::string listed;
    for (const std::string& name : names) {
      // The limit keeps the note short if there are hundreds of channels.
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

  /// Parses all complete frames in held_. Bytes after the last stated frame are only counted.
  Result<void> read_frames(PointFrames& out) {
    // Complete frames are read from the front. The rest waits for the next piece.
    std::size_t at = 0;
    while (held_.size() - at >= frame_bytes_ && (!stated_ || stamps_.rows() < *stated_)) {
      KA_TRY(read_frame(bytes() + at, out));
      at += frame_bytes_;
    }
    // After the last stated frame, only zeros up to the end of the block are expected.
    if (stated_ && stamps_.rows() == *stated_) {
      behind_ += held_.size() - at;
      at = held_.size();
    }
    held_.erase(0, at);
    return {};
  }

  /// Appends one frame. Zeros may complete the last block of a file. If the file does not state its
  /// number of frames, frames of zeros may be this padding. They are only counted until they are as
  /// long as a block, or until another frame follows.
  Result<void> read_frame(const std::uint8_t* at, PointFrames& out) {
    if (!stated_ && (zero_frames_ + 1) * frame_bytes_ < c3d_block &&
        std::all_of(at, at + frame_bytes_, [](std::uint8_t b) { return b == 0; })) {
      ++zero_frames_;
      return {};
    }
    // Another frame follows, so the frames of zeros were not padding.
    const std::vector<std::uint8_t> zeros(zero_frames_ > 0 ? frame_bytes_ : 0);
    for (; zero_frames_ > 0; --zero_frames_) KA_TRY(append_frame(zeros.data(), out));
    return append_frame(at, out);
  }

  /// Converts one frame. A point is invalid if its fourth number is negative.
  Result<void> append_frame(const std::uint8_t* at, PointFrames& out) {
    const Time stamp = KA_TRY(stamp_of_next());
    for (std::size_t j = 0; j < points_; ++j) {
      double* to = &numbers_[3 * j];
      double fourth = 0.0;
      // Floats are coordinates. Integers are multiplied by the scale.
      if (scale_ < 0.0) {
        for (std::size_t k = 0; k < 3; ++k) to[k] = c3d_f32(processor_, at + 16 * j + 4 * k);
        fourth = c3d_f32(processor_, at + 16 * j + 12);
      } else {
        for (std::size_t k = 0; k < 3; ++k) {
          to[k] = scale_ * c3d_i16(processor_, at + 8 * j + 2 * k);
        }
        fourth = c3d_i16(processor_, at + 8 * j + 6);
      }
      // A comparison with NaN is false, so NaN counts as missing, too.
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
    // If it is less than a block, it is the padding of the last block.
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
  std::uint64_t zeros_ = 0;  // zero bytes in front of the header
  C3dProcessor processor_ = C3dProcessor::intel;
  std::size_t points_ = 0, frame_bytes_ = 0;
  double scale_ = 0.0;  // factor of integers; negative if the values are floats
  PointUnits units_;
  std::optional<std::uint64_t> stated_;  // number of frames in the head, if it is stated
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
  // Zero bytes in front of the header are skipped, as in the reader.
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
