// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/c3d/parameters.h"

#include "kinalign/wire/little_endian.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>

namespace kinalign {

namespace {

/// Reads a number in VAX F format: sign, 8 bits of exponent and 23 bits of fraction, in two
/// little-endian halves, the upper half first. The value is 0.1fraction (binary) * 2^(exponent -
/// 128).
double vax_f32(const std::uint8_t* at) {
  // The halves are swapped: bytes 1 and 0 are the upper half.
  const std::uint32_t bits =
      static_cast<std::uint32_t>(at[1]) << 24 | at[0] << 16 | at[3] << 8 | at[2];
  const int exponent = static_cast<int>(bits >> 23 & 0xff);
  // If the exponent is 0, the number is 0.
  if (exponent == 0) return 0.0;
  const double fraction = std::ldexp(static_cast<double>(bits & 0x7f'ffff), -24) + 0.5;
  const double value = std::ldexp(fraction, exponent - 128);
  return (bits >> 31) != 0 ? -value : value;
}

/// Reads bytes and numbers from the front of the section. The caller must call has() before it
/// reads.
class Entries {
 public:
  Entries(std::span<const std::uint8_t> section, C3dProcessor processor)
      : section_(section), processor_(processor) {}

  std::size_t at() const { return at_; }
  bool has(std::size_t bytes) const { return bytes <= section_.size() - at_; }
  int i8() {
    const int byte = section_[at_++];
    return byte < 128 ? byte : byte - 256;
  }
  std::uint8_t u8() { return section_[at_++]; }
  std::uint16_t u16() {
    at_ += 2;
    return c3d_u16(processor_, &section_[at_ - 2]);
  }
  std::span<const std::uint8_t> bytes(std::size_t count) {
    at_ += count;
    return section_.subspan(at_ - count, count);
  }
  void go_to(std::size_t at) { at_ = at; }
  std::size_t size() const { return section_.size(); }

 private:
  std::span<const std::uint8_t> section_;
  C3dProcessor processor_;
  // The section begins with a header of four bytes.
  std::size_t at_ = 4;
};

/// C3D does not distinguish upper and lower case in names, and programs write both.
std::string in_capitals(std::span<const std::uint8_t> bytes) {
  std::string out;
  for (const std::uint8_t byte : bytes) {
    const char c = static_cast<char>(byte);
    out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return out;
}

/// The absolute value of the type's number is its size in bytes; a text has -1.
std::size_t size_of(C3dType type) {
  return static_cast<std::size_t>(std::abs(static_cast<int>(type)));
}

/// Reads type, dimensions and values. Returns false if the type is unknown or the values extend
/// beyond the section.
bool take_values(Entries& entries, C3dParameter& out) {
  if (!entries.has(2)) return false;
  const int type = entries.i8();
  if (type != -1 && type != 1 && type != 2 && type != 4) return false;
  out.type = static_cast<C3dType>(type);
  const std::size_t dimensions = entries.u8();
  if (!entries.has(dimensions)) return false;
  std::size_t count = 1;
  for (const std::uint8_t dimension : entries.bytes(dimensions)) {
    out.dimensions.push_back(dimension);
    count *= dimension;
    // A product larger than the section is wrong. Further products could overflow.
    if (count > entries.size()) return false;
  }
  const std::size_t bytes = count * size_of(out.type);
  if (!entries.has(bytes)) return false;
  const auto values = entries.bytes(bytes);
  out.bytes.assign(values.begin(), values.end());
  return true;
}

constexpr std::size_t most_parameters = 10'000;  // usual files have some hundreds

/// The names of groups by id. They are collected first, because a group may come after its
/// parameters.
struct Groups {
  std::map<int, std::string> names;
  /// The group id of each parameter.
  std::vector<int> of_parameter;
};

enum class Taken { entry, last, outside, bad_values };

/// Reads one group or one parameter, and moves to the next entry.
Taken take_entry(Entries& entries, Groups& groups, std::vector<C3dParameter>& parameters) {
  if (!entries.has(2)) return Taken::last;
  // A negative length means that the name is locked.
  const auto length = static_cast<std::size_t>(std::abs(entries.i8()));
  const int id = entries.i8();
  if (length == 0) return Taken::last;
  if (!entries.has(length + 2)) return Taken::outside;
  std::string name = in_capitals(entries.bytes(length));
  // The offset counts from this field, and not from the beginning of the entry.
  const std::size_t offset_at = entries.at();
  const std::size_t offset = entries.u16();
  // A negative id belongs to a group. A positive id belongs to a parameter and names its group.
  if (id < 0) {
    groups.names[-id] = std::move(name);
  } else {
    parameters.emplace_back().name = std::move(name);
    groups.of_parameter.push_back(id);
    if (!take_values(entries, parameters.back())) return Taken::bad_values;
  }
  // The offset 0 marks the last entry.
  if (offset == 0) {
    entries.go_to(entries.size());
    return Taken::entry;
  }
  const std::size_t next = offset_at + offset;
  // With a smaller offset, reading would move backwards and never end.
  if (offset < 2 || next > entries.size()) return Taken::outside;
  entries.go_to(next);
  return Taken::entry;
}

/// The text without blanks and zeros at its end, with which programs fill it.
std::string_view trimmed_end(std::string_view text) {
  const auto last = text.find_last_not_of(std::string_view(" \0\t", 3));
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

}  // namespace

double c3d_f32(C3dProcessor processor, const std::uint8_t* at) {
  if (processor == C3dProcessor::dec) return vax_f32(at);
  const std::span<const std::uint8_t> bytes(at, 4);
  std::uint32_t bits = little_at<std::uint32_t>(bytes, 0);
  if (processor == C3dProcessor::mips) bits = __builtin_bswap32(bits);
  return static_cast<double>(std::bit_cast<float>(bits));
}

Result<C3dParameters> C3dParameters::parse(std::span<const std::uint8_t> section,
                                           std::string_view file, std::uint64_t section_at) {
  const auto refuse = [&](const std::string& expected, std::size_t at) {
    return kinalign::refuse(file, expected, fmt::format("another at byte {}", section_at + at));
  };
  // Byte 3 names the processor: 83 + its number.
  if (section.size() < 4 || section[3] < 84 || section[3] > 86) {
    return refuse("a C3D parameter section of processor 84, 85 or 86", 3);
  }
  C3dParameters out;
  out.processor_ = static_cast<C3dProcessor>(section[3]);
  Groups groups;
  Entries entries(section, out.processor_);
  for (;;) {
    const std::size_t entry = entries.at();
    const Taken taken = take_entry(entries, groups, out.parameters_);
    if (taken == Taken::last) break;
    if (taken == Taken::outside) return refuse("C3D parameters inside their section", entry);
    if (taken == Taken::bad_values) {
      return refuse(
          "the values of parameter " + shown(out.parameters_.back().name) + " inside the section",
          entry);
    }
    if (out.parameters_.size() > most_parameters) {
      return refuse(fmt::format("at most {} C3D parameters", most_parameters), entry);
    }
  }
  // The names of all groups are known now, even if a group came after its parameters.
  for (std::size_t i = 0; i < out.parameters_.size(); ++i) {
    out.parameters_[i].group = groups.names[groups.of_parameter[i]];
  }
  return out;
}

const C3dParameter* C3dParameters::find(std::string_view group, std::string_view name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(), [&](const auto& one) {
    return one.group == group && one.name == name;
  });
  return found == parameters_.end() ? nullptr : &*found;
}

std::optional<double> C3dParameters::number(std::string_view group, std::string_view name,
                                            std::size_t index) const {
  const C3dParameter* found = find(group, name);
  if (found == nullptr || found->type == C3dType::text) return std::nullopt;
  const std::size_t size = size_of(found->type);
  if (found->bytes.size() < (index + 1) * size) return std::nullopt;
  const std::uint8_t* at = &found->bytes[index * size];
  if (found->type == C3dType::byte) return *at;
  // Counts above 32,767 are stored in the same field, so the field is read as unsigned.
  if (found->type == C3dType::i16) return c3d_u16(processor_, at);
  return c3d_f32(processor_, at);
}

std::vector<std::string> C3dParameters::texts(std::string_view group, std::string_view name) const {
  const C3dParameter* found = find(group, name);
  std::vector<std::string> out;
  if (found == nullptr || found->type != C3dType::text || found->bytes.empty()) return out;
  // A text without dimensions is a single character.
  const std::size_t length = found->dimensions.empty() ? 1 : found->dimensions.front();
  const std::string_view all(reinterpret_cast<const char*>(found->bytes.data()),
                             found->bytes.size());
  for (std::size_t at = 0; at < all.size(); at += length) {
    out.emplace_back(trimmed_end(all.substr(at, length)));
  }
  return out;
}

// A parameter contains at most 255 texts, so programs use further parameters NAME2, NAME3 and so
// on.
std::vector<std::string> C3dParameters::all_texts(std::string_view group,
                                                  std::string_view name) const {
  std::vector<std::string> out = texts(group, name);
  for (int k = 2;; ++k) {
    const std::vector<std::string> more = texts(group, std::string(name) + std::to_string(k));
    if (more.empty()) return out;
    out.insert(out.end(), more.begin(), more.end());
  }
}

}  // namespace kinalign
