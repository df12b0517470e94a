// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/c3d/c3d.h"
#include "kinalign/formats/c3d/parameters.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/wire/little_endian.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t longest_name = 120;  // so that 255 names fit into one parameter
constexpr std::size_t names_a_parameter = 255;
constexpr std::size_t most_blocks = 255;  // largest size of the parameter section
constexpr double millimetres = 1000.0;
// The sink receives large pieces.
constexpr std::size_t most_held = std::size_t{1} << 20;  // limit on bytes kept for the sink

void put_float(double value, std::string& out) {
  append_little(std::bit_cast<std::uint32_t>(static_cast<float>(value)), out);
}

/// Builds the parameter section. The entries follow each other without gaps. Each entry contains
/// the distance to the next one.
class Section {
 public:
  void group(int id, std::string_view name) {
    // In the entry of a group, its id is negative.
    begin(-id, name);
    end("");
  }

  void integers(int group, std::string_view name, const std::vector<std::uint16_t>& values) {
    std::string data;
    for (const std::uint16_t value : values) append_little(value, data);
    numbers(group, name, 2, data);
  }

  void floats(int group, std::string_view name, const std::vector<double>& values) {
    std::string data;
    for (const double value : values) put_float(value, data);
    numbers(group, name, 4, data);
  }

  void text(int group, std::string_view name, std::string_view text) {
    begin(group, name);
    end(head(-1, {text.size()}) + std::string(text));
  }

  /// Writes texts. Blanks extend each text to the length of the longest text.
  void texts(int group, std::string_view name, std::span<const std::string> texts) {
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::string data;
    for (const std::string& text : texts) data += text + std::string(longest - text.size(), ' ');
    begin(group, name);
    end(head(-1, {longest, texts.size()}) + data);
  }

  /// The whole section. Zeros complete its last block.
  std::string finished() const {
    std::string out = entries_;
    out += std::string(2, '\0');  // an entry without a name ends the section
    out.resize((out.size() + c3d_block - 1) / c3d_block * c3d_block);
    out[2] = static_cast<char>(out.size() / c3d_block);
    return out;
  }

 private:
  // A dimension has one byte, so a length is at most 255.
  static std::string head(int type, const std::vector<std::size_t>& dimensions) {
    std::string out{static_cast<char>(type), static_cast<char>(dimensions.size())};
    for (const std::size_t dimension : dimensions) out += static_cast<char>(dimension);
    return out;
  }

  /// Writes numbers of `type` bytes each. A single number has no dimension.
  void numbers(int group, std::string_view name, int type, const std::string& data) {
    const std::size_t count = data.size() / static_cast<std::size_t>(type);
    begin(group, name);
    end(head(type, count == 1 ? std::vector<std::size_t>{} : std::vector{count}) + data);
  }

  void begin(int id, std::string_view name) {
    entries_ += static_cast<char>(name.size());
    entries_ += static_cast<char>(id);
    entries_ += name;
  }

  /// Writes the rest of the entry: `body` and an empty description.
  void end(const std::string& body) {
    // The distance counts from its own field: two bytes for the field, then the body, then one byte
    // for the length of the description (0).
    append_little(static_cast<std::uint16_t>(2 + body.size() + 1), entries_);
    entries_ += body + '\0';
  }

  // The header of the section: 1, 0x50, the number of blocks (which finished() sets), processor 84.
  std::string entries_ = std::string("\x01\x50\0\x54", 4);
};

std::uint16_t low(std::uint64_t value) { return static_cast<std::uint16_t>(value & 0xffff); }
std::uint16_t high(std::uint64_t value) { return static_cast<std::uint16_t>(value >> 16 & 0xffff); }
// A larger number does not fit into the field. Readers then use TRIAL.
std::uint16_t at_most_u16(std::uint64_t value) {
  return static_cast<std::uint16_t>(std::min<std::uint64_t>(value, 0xffff));
}

/// The parameter section. The names of the points fill LABELS, LABELS2 and so on.
std::string parameters_of(const C3dPoints& points, std::uint16_t data_block) {
  constexpr int point = 1, analog = 2, trial = 3, force_platform = 4;
  Section out;
  out.group(point, "POINT");
  out.integers(point, "USED", {at_most_u16(points.names.size())});
  // A negative scale means that the values are floats.
  out.floats(point, "SCALE", {-1.0});
  out.floats(point, "RATE", {points.rate_hz});
  out.integers(point, "DATA_START", {data_block});
  out.integers(point, "FRAMES", {at_most_u16(points.frames)});
  out.text(point, "UNITS", "mm");
  // On a screen x points to the right and z points up.
  out.text(point, "X_SCREEN", "+X");
  out.text(point, "Y_SCREEN", "+Z");
  const std::span names(points.names);
  // A parameter contains at most 255 names.
  for (std::size_t at = 0, part = 1; at < names.size(); at += names_a_parameter, ++part) {
    out.texts(point, part == 1 ? "LABELS" : "LABELS" + std::to_string(part),
              names.subspan(at, std::min(names_a_parameter, names.size() - at)));
  }
  // States that there are no analog data and no force plates.
  out.group(analog, "ANALOG");
  out.integers(analog, "USED", {0});
  out.floats(analog, "GEN_SCALE", {1.0});
  out.floats(analog, "RATE", {points.rate_hz});
  out.group(trial, "TRIAL");
  // Each field contains the lower and the upper half of a 32-bit number.
  out.integers(trial, "ACTUAL_START_FIELD", {1, 0});
  out.integers(trial, "ACTUAL_END_FIELD", {low(points.frames), high(points.frames)});
  out.group(force_platform, "FORCE_PLATFORM");
  out.integers(force_platform, "USED", {0});
  return out.finished();
}

/// The header block. Its fields are those of HeaderBlock in reader.cpp. The parameters begin in
/// block 2.
std::string header_of(const C3dPoints& points, std::uint16_t data_block) {
  std::string out = "\x02\x50";
  append_little(at_most_u16(points.names.size()), out);
  append_little(std::uint16_t{0}, out);  // number of analog values
  append_little(std::uint16_t{1}, out);  // number of the first frame
  append_little(at_most_u16(points.frames), out);
  append_little(std::uint16_t{0}, out);  // largest gap that was filled
  put_float(-1.0, out);
  append_little(data_block, out);
  append_little(std::uint16_t{0}, out);  // analog samples per frame
  put_float(points.rate_hz, out);
  out.resize(c3d_block);
  return out;
}

/// Writes a point as four numbers: x, y, z with z up, and the residual, which is -1 for a missing
/// point.
void put_point(const double* ours, Tracking state, std::string& out) {
  const bool missing = state == Tracking::missing;
  // Converts y up to z up: x = x, y = -z, z = y.
  for (const double coordinate : {ours[0], -ours[2], ours[1]}) {
    put_float(missing ? 0.0 : millimetres * coordinate, out);
  }
  put_float(missing ? -1.0 : 0.0, out);
}

}  // namespace

C3dWriter::C3dWriter(const C3dPoints& points, FileSink sink)
    : sink_(std::move(sink)),
      points_(points.names.size()),
      rate_hz_(points.rate_hz),
      frames_(points.frames) {}

Result<C3dWriter> C3dWriter::begin(const C3dPoints& points, FileSink sink) {
  if (points.names.empty() || points.names.size() > 0xffff) {
    return refuse("1 to 65,535 points for a C3D", std::to_string(points.names.size()));
  }
  for (const std::string& name : points.names) {
    if (name.size() > longest_name) {
      return refuse(fmt::format("names of at most {} bytes for a C3D", longest_name), shown(name));
    }
  }
  if (points.frames > INT32_MAX) {
    return refuse("at most 2^31 - 1 frames for a C3D", std::to_string(points.frames));
  }
  if (!(points.rate_hz >= 1e-3) || !(points.rate_hz <= 1e6)) {
    return refuse("a rate of 0.001 to 1,000,000 Hz for a C3D", fmt::format("{}", points.rate_hz));
  }
  // The length of the section does not depend on the position of the data, so any number serves
  // here.
  const std::size_t blocks = parameters_of(points, 0).size() / c3d_block;
  if (blocks > most_blocks) {
    return refuse("names that fit into 130 KB of C3D parameters",
                  fmt::format("{} names that do not fit", points.names.size()));
  }
  const auto data_block = static_cast<std::uint16_t>(2 + blocks);
  C3dWriter out(points, std::move(sink));
  out.bytes_ = header_of(points, data_block) + parameters_of(points, data_block);
  return out;
}

Result<void> C3dWriter::append(const PointFrames& frames) {
  for (std::size_t t = 0; t < frames.size(); ++t) {
    if (written_ == frames_) return refuse(fmt::format("{} frames", frames_), "more");
    // A C3D file contains a rate and no stamps, so frames must be evenly spaced.
    if (written_ == 0) first_ = frames.stamps[t];
    const auto due = Duration{stamp_at_rate(written_, rate_hz_)};
    const double off = 1e-9 * static_cast<double>((frames.stamps[t] - first_ - due).count());
    if (!(std::abs(off) < 0.5 / rate_hz_)) {
      return refuse(fmt::format("evenly spaced stamps at {:g} Hz, as required by C3D", rate_hz_),
                    fmt::format("frame {} off by {:.3g} s", written_ + 1, off));
    }
    for (std::size_t i = t * points_; i < (t + 1) * points_; ++i) {
      put_point(&frames.positions[3 * i], frames.state[i], bytes_);
    }
    ++written_;
    if (bytes_.size() < most_held) continue;
    KA_TRY(sink_(bytes_));
    bytes_.clear();
  }
  return {};
}

Result<void> C3dWriter::finish() {
  if (written_ != frames_) {
    return refuse(fmt::format("{} frames", frames_), std::to_string(written_));
  }
  // Only the data need zeros at the end, because the head consists of whole blocks.
  const std::uint64_t data = written_ * points_ * 16;
  bytes_.resize(bytes_.size() + (c3d_block - data % c3d_block) % c3d_block);
  return sink_(bytes_);
}

}  // namespace kinalign
