// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/xdf/samples.h"

#include "kinalign/wire/little_endian.h"

#include <fmt/format.h>

#include <bit>

namespace kinalign {

namespace {

std::size_t bytes_of(XdfFormat format) {
  switch (format) {
    case XdfFormat::int8:
      return 1;
    case XdfFormat::int16:
      return 2;
    case XdfFormat::int32:
    case XdfFormat::float32:
      return 4;
    default:
      return 8;
  }
}

XdfValues room_for(XdfFormat format) {
  if (format == XdfFormat::string) return std::vector<std::string>{};
  const bool real = format == XdfFormat::float32 || format == XdfFormat::double64;
  return real ? XdfValues(std::vector<double>{}) : XdfValues(std::vector<std::int64_t>{});
}

/// Takes from the front of the content; what is not all there is not taken.
class Content {
 public:
  explicit Content(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t at() const { return at_; }
  void go_back(std::size_t at) { at_ = at; }

  template <std::unsigned_integral T>
  std::optional<T> take() {
    if (left() < sizeof(T)) return std::nullopt;
    at_ += sizeof(T);
    return little_at<T>(bytes_, at_ - sizeof(T));
  }

  /// A length in 1, 4 or 8 bytes, as the byte in front says.
  std::optional<std::uint64_t> take_length() {
    const auto width = take<std::uint8_t>();
    if (width == 1) return take<std::uint8_t>();
    if (width == 4) return take<std::uint32_t>();
    if (width == 8) return take<std::uint64_t>();
    return std::nullopt;
  }

  std::optional<std::string> take_text() {
    const auto length = take_length();
    if (!length || *length > left()) return std::nullopt;
    const auto* from = reinterpret_cast<const char*>(bytes_.data() + at_);
    at_ += static_cast<std::size_t>(*length);
    return std::string(from, static_cast<std::size_t>(*length));
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

template <std::signed_integral T>
std::int64_t whole(std::uint64_t bits) {
  return static_cast<T>(bits);
}

bool append_whole(XdfFormat format, Content& content, std::vector<std::int64_t>& out) {
  const auto put = [&out](auto value, auto convert) {
    if (value) out.push_back(convert(*value));
    return value.has_value();
  };
  switch (format) {
    case XdfFormat::int8:
      return put(content.take<std::uint8_t>(), whole<std::int8_t>);
    case XdfFormat::int16:
      return put(content.take<std::uint16_t>(), whole<std::int16_t>);
    case XdfFormat::int32:
      return put(content.take<std::uint32_t>(), whole<std::int32_t>);
    default:
      return put(content.take<std::uint64_t>(), whole<std::int64_t>);
  }
}

bool append_real(XdfFormat format, Content& content, std::vector<double>& out) {
  if (format == XdfFormat::float32) {
    const auto bits = content.take<std::uint32_t>();
    if (bits) out.push_back(static_cast<double>(std::bit_cast<float>(*bits)));
    return bits.has_value();
  }
  const auto bits = content.take<std::uint64_t>();
  if (bits) out.push_back(std::bit_cast<double>(*bits));
  return bits.has_value();
}

bool append_value(XdfFormat format, Content& content, XdfValues& values) {
  if (auto* text = std::get_if<std::vector<std::string>>(&values)) {
    auto value = content.take_text();
    if (!value) return false;
    text->push_back(*std::move(value));
    return true;
  }
  if (auto* real = std::get_if<std::vector<double>>(&values)) {
    return append_real(format, content, *real);
  }
  return append_whole(format, content, std::get<std::vector<std::int64_t>>(values));
}

/// One sample, all of it or none.
bool append_sample(const XdfStream& stream, Content& content, double& last_stamp, XdfSamples& out) {
  const std::size_t before = std::visit([](const auto& v) { return v.size(); }, out.values);
  const auto width = content.take<std::uint8_t>();
  double stamp = last_stamp;
  if (width == 8) {
    const auto bits = content.take<std::uint64_t>();
    if (!bits) return false;
    stamp = std::bit_cast<double>(*bits);
  } else if (width == 0) {
    stamp += stream.nominal_rate_hz > 0.0 ? 1.0 / stream.nominal_rate_hz : 0.0;
  } else {
    return false;
  }
  // A number of channels is not believed before the bytes are there.
  const bool text = stream.format == XdfFormat::string;
  if (stream.channel_count > content.left() / (text ? 2 : bytes_of(stream.format))) return false;
  for (std::uint32_t c = 0; c < stream.channel_count; ++c) {
    if (append_value(stream.format, content, out.values)) continue;
    std::visit([before](auto& v) { v.resize(before); }, out.values);
    return false;
  }
  last_stamp = stamp;
  out.stamps.push_back(stamp);
  out.deduced.push_back(width == 0 ? 1 : 0);
  return true;
}

}  // namespace

XdfSamples parse_xdf_samples(const XdfStream& stream, std::span<const std::uint8_t> bytes,
                             double& last_stamp, std::optional<Error>& what_is_wrong) {
  XdfSamples samples;
  samples.stream = stream.id;
  samples.values = room_for(stream.format);
  Content content(bytes);
  const auto stated = content.take_length();
  if (!stated) {
    what_is_wrong = Error{"", 0, "a number of samples", "none"};
    return samples;
  }
  while (samples.size() < *stated && append_sample(stream, content, last_stamp, samples)) {
  }
  if (samples.size() < *stated) {
    what_is_wrong = Error{"", 0, "as many whole samples in a chunk as it states",
                          fmt::format("{} of {}", samples.size(), *stated)};
  } else if (content.left() > 0) {
    what_is_wrong = Error{"", 0, "the end of a chunk behind its samples",
                          std::to_string(content.left()) + " bytes"};
  }
  return samples;
}

}  // namespace kinalign
