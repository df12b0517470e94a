// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/safetensors.h"

#include "kinalign/infer/strict_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "values are copied as they stand");

constexpr const char* metadata_key = "__metadata__";

/// A tensor as the header describes it. Offsets count from the end of the header.
/// Nothing in it is trusted before `check_places`.
struct Entry {
  std::string name;
  std::string type;
  std::vector<std::size_t> shape;
  std::size_t begin = 0, end = 0;
};

Failure wrong(const std::string& file, const std::string& expected, const std::string& found) {
  return Failure(Error{file, 0, expected, found});
}

std::string quoted(const std::string& name) { return "\"" + shown(name) + "\""; }

/// Bytes per value; 0 for a type that is not supported.
std::size_t value_bytes(const std::string& type) {
  if (type == "F32") return 4;
  if (type == "F16" || type == "BF16") return 2;
  return 0;
}

// An array of whole numbers; empty for anything else.
std::optional<std::vector<std::size_t>> counts(const Json& json) {
  if (!json.is_array()) return std::nullopt;
  std::vector<std::size_t> out;
  for (const Json& number : json) {
    if (!number.is_number_unsigned()) return std::nullopt;
    out.push_back(number.get<std::size_t>());
  }
  return out;
}

/// The size of a tensor in bytes; empty if it exceeds 2^64.
std::optional<std::size_t> bytes_of(const std::vector<std::size_t>& shape, std::size_t each) {
  std::size_t bytes = each;
  for (const std::size_t n : shape) {
    if (__builtin_mul_overflow(bytes, n, &bytes)) return std::nullopt;
  }
  return bytes;
}

/// Reads the entry of a tensor in the header: type, shape and place of its bytes.
Result<Entry> read_entry(const std::string& name, const Json& json, const std::string& file) {
  const auto has = [&json](const char* key) { return json.contains(key); };
  if (!json.is_object() || json.size() != 3 || !has("dtype") || !has("shape") ||
      !has("data_offsets")) {
    return wrong(file, "dtype, shape and data_offsets of tensor " + quoted(name),
                 shown(json.dump(-1, ' ', false, Json::error_handler_t::replace)));
  }
  Entry entry;
  entry.name = name;
  if (json["dtype"].is_string()) entry.type = json["dtype"].get<std::string>();
  if (value_bytes(entry.type) == 0) {
    return wrong(file, "values of type F32, F16 or BF16 in tensor " + quoted(name),
                 shown(json["dtype"].dump(-1, ' ', false, Json::error_handler_t::replace)));
  }
  const auto shape = counts(json["shape"]);
  if (!shape) {
    return wrong(file, "whole numbers as shape of tensor " + quoted(name),
                 shown(json["shape"].dump(-1, ' ', false, Json::error_handler_t::replace)));
  }
  const auto offsets = counts(json["data_offsets"]);
  if (!offsets || offsets->size() != 2) {
    return wrong(file, "two whole numbers as data_offsets of tensor " + quoted(name),
                 shown(json["data_offsets"].dump(-1, ' ', false, Json::error_handler_t::replace)));
  }
  entry.shape = *shape;
  entry.begin = offsets->front();
  entry.end = offsets->back();
  return entry;
}

/// Sorts the entries. Fails if they do not cover `bytes` bytes exactly, without gaps and overlaps.
Result<void> check_places(std::vector<Entry>& entries, std::size_t bytes, const std::string& file) {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  std::size_t at = 0;
  for (const Entry& entry : entries) {
    if (entry.begin != at) {
      return wrong(file, "tensor " + quoted(entry.name) + " to begin at byte " + std::to_string(at),
                   "byte " + std::to_string(entry.begin));
    }
    const auto size = bytes_of(entry.shape, value_bytes(entry.type));
    if (entry.end < entry.begin || !size || *size != entry.end - entry.begin) {
      return wrong(file,
                   (size ? std::to_string(*size) : "more than 2^64") + " bytes of tensor " +
                       quoted(entry.name),
                   "bytes " + std::to_string(entry.begin) + " to " + std::to_string(entry.end));
    }
    at = entry.end;
  }
  if (at == bytes) return {};
  return wrong(file, std::to_string(at) + " bytes of tensors after the header",
               std::to_string(bytes));
}

// Converts a binary16 number (IEEE 754) to binary32, exactly.
float from_half(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000U) << 16U;
  const std::uint32_t exponent = (half >> 10U) & 0x1fU, fraction = half & 0x3ffU;
  if (exponent == 0) {  // zero and subnormal numbers: the fraction is a multiple of 2^-24
    const float value = static_cast<float>(fraction) * 0x1p-24F;
    return sign != 0 ? -value : value;
  }
  // Binary16 has an exponent of 5 bits, with 15 for 2^0; binary32 has 127. Infinity and NaN keep
  // all bits set.
  const std::uint32_t wide = exponent == 0x1fU ? 0xffU : exponent + 112U;
  return std::bit_cast<float>(sign | wide << 23U | fraction << 13U);
}

/// The numbers of a tensor as float, converted from its type.
std::vector<float> read_values(std::string_view bytes, const std::string& type) {
  if (type == "F32") {
    std::vector<float> out(bytes.size() / 4);
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  std::vector<float> out(bytes.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::uint16_t value = 0;
    std::memcpy(&value, &bytes[2 * i], 2);
    // BF16 is the upper half of a binary32.
    out[i] = type == "F16" ? from_half(value) : std::bit_cast<float>(std::uint32_t{value} << 16U);
  }
  return out;
}

// The format allows only texts as metadata. Ours holds one text, which is JSON.
Result<std::map<std::string, std::string>> read_metadata(const Json& json,
                                                         const std::string& file) {
  const std::string expected = std::string("texts in ") + metadata_key;
  if (!json.is_object()) return wrong(file, expected, std::string("a JSON ") + json.type_name());
  std::map<std::string, std::string> out;
  for (const auto& [key, value] : json.items()) {
    if (!value.is_string()) {
      return wrong(file, expected,
                   std::string("a JSON ") + value.type_name() + " as " + quoted(key));
    }
    out[key] = value.get<std::string>();
  }
  return out;
}

/// The JSON header. The eight bytes before it state its length. That length is compared with the
/// size of the file before the header is read.
Result<std::string_view> header_of(std::string_view bytes, const std::string& file) {
  std::uint64_t length = 0;
  if (bytes.size() < sizeof length) {
    return wrong(file, "8 bytes that give the length of a SafeTensors header",
                 std::to_string(bytes.size()) + " bytes");
  }
  std::memcpy(&length, bytes.data(), sizeof length);
  if (length > most_header_bytes) {
    return wrong(file, "a SafeTensors header of at most 16 MB", std::to_string(length) + " bytes");
  }
  if (length > bytes.size() - sizeof length) {
    return wrong(file, "a header of " + std::to_string(length) + " bytes",
                 std::to_string(bytes.size() - sizeof length));
  }
  const std::string_view header = bytes.substr(sizeof length, length);
  if (!header.starts_with('{')) return wrong(file, "'{' at byte 8", quoted(std::string(header)));
  return header;
}

}  // namespace

Result<TensorFile> read_safetensors(std::string_view bytes, const std::string& name) {
  const std::string_view header = KA_TRY(header_of(bytes, name));
  const std::string_view data = bytes.substr(8 + header.size());
  const Json json = KA_TRY(parse_strict_json(header, name));
  TensorFile out;
  std::vector<Entry> entries;
  for (const auto& [key, value] : json.items()) {
    if (key == metadata_key) {
      out.metadata = KA_TRY(read_metadata(value, name));
    } else {
      entries.push_back(KA_TRY(read_entry(key, value, name)));
    }
  }
  // All places are checked before values are read, so no tensor reads beyond the file.
  KA_TRY(check_places(entries, data.size(), name));
  for (const Entry& entry : entries) {
    const auto values = data.substr(entry.begin, entry.end - entry.begin);
    out.tensors[entry.name] = {entry.shape, read_values(values, entry.type)};
  }
  return out;
}

std::string write_safetensors(const TensorFile& file) {
  nlohmann::ordered_json header = nlohmann::ordered_json::object();
  if (!file.metadata.empty()) header[metadata_key] = file.metadata;
  std::size_t at = 0;
  for (const auto& [name, tensor] : file.tensors) {
    const std::size_t bytes = tensor.values.size() * sizeof(float);
    assert(bytes_of(tensor.shape, sizeof(float)) == bytes);
    header[name] = {{"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {at, at + bytes}}};
    at += bytes;
  }
  std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  // Blanks after the object let the values begin at a multiple of 8 bytes.
  text.resize((text.size() + 7) / 8 * 8, ' ');
  const std::uint64_t length = text.size();
  std::string out(sizeof length, '\0');
  std::memcpy(out.data(), &length, sizeof length);
  out.reserve(sizeof length + text.size() + at);
  out += text;
  for (const auto& [name, tensor] : file.tensors) {
    out.append(reinterpret_cast<const char*>(tensor.values.data()),
               tensor.values.size() * sizeof(float));
  }
  return out;
}

}  // namespace kinalign
