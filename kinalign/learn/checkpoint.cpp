// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/checkpoint.h"

#include "kinalign/infer/safetensors.h"
#include "kinalign/learn/tensors.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>

namespace kinalign {

namespace {

using Json = nlohmann::json;
using NamedTensors = std::map<std::string, torch::Tensor>;

constexpr const char* checkpoint_key = "kinalign_checkpoint";

/// The maps of a state and the prefixes of their names in the file, for writing and for reading.
template <class Use>
void for_each_map(TrainingState& state, const Use& use) {
  use("weights.", state.weights);
  use("first.", state.first);
  use("second.", state.second);
  use("average.", state.average);
  use("best.", state.best);
}

Json point_json(const TrainingPoint& point) {
  Json out{point.step, point.loss, point.rate, point.gradient};
  out.push_back(point.judgement ? Json(*point.judgement) : Json());
  return out;
}

TrainingPoint point_of(const Json& json) {
  TrainingPoint out{json.at(0).get<std::int64_t>(), json.at(1).get<double>(),
                    json.at(2).get<double>(), json.at(3).get<double>(), std::nullopt};
  if (!json.at(4).is_null()) out.judgement = json.at(4).get<double>();
  return out;
}

void read_numbers(const Json& json, TrainingState& out) {
  out.step = json.at("step").get<std::int64_t>();
  out.without_better = json.at("without_better").get<std::int64_t>();
  if (!json.at("best").is_null()) out.best_judgement = json.at("best").get<double>();
  for (const Json& point : json.at("points")) out.points.push_back(point_of(point));
}

// --- TensorBoard: protobuf records, each with a masked CRC-32C of its length and of its data.
// Protobuf is written by hand here, because few kinds of field are needed. The layout is that of
// event.proto and tfrecord in the source of TensorFlow.

/// CRC-32C (Castagnoli), bit by bit: 0x82f63b78 is its polynomial in reversed order.
std::uint32_t crc32c(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0x82f63b78U : 0U);
  }
  return ~crc;
}

void put_little(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xffU);
}

/// Appends a record of TensorBoard: its length, its data, and a masked CRC-32C of each.
void put_record(std::string& out, const std::string& data) {
  const auto masked = [](std::string_view bytes) {
    const std::uint32_t crc = crc32c(bytes);
    return ((crc >> 15U) | (crc << 17U)) + 0xa282ead8U;
  };
  std::string length;
  put_little(length, data.size(), 8);
  out += length;
  put_little(out, masked(length), 4);
  out += data;
  put_little(out, masked(data), 4);
}

/// A protobuf varint: seven bits a byte, the lowest first; the top bit says that more follow.
void put_varint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7U) out += static_cast<char>((value & 0x7fU) | 0x80U);
  out += static_cast<char>(value);
}

/// A field with a length. Wire type 2 stands in the low three bits of its key.
void put_bytes(std::string& out, int field, const std::string& bytes) {
  put_varint(out, static_cast<std::uint64_t>(field) << 3U | 2U);
  put_varint(out, bytes.size());
  out += bytes;
}

/// The message Event { wall_time = 0, step, summary { value { tag, simple_value } } }.
std::string event_of(std::int64_t step, const std::string& tag, double value) {
  std::string one;
  put_bytes(one, 1, tag);
  // Key of field 2 (simple_value), wire type 5: a float of four bytes.
  one += '\x15';
  std::uint32_t bits = 0;
  const auto number = static_cast<float>(value);
  std::memcpy(&bits, &number, sizeof bits);
  put_little(one, bits, 4);
  // Keys of wall_time (field 1, a double) and of step (field 2, a varint).
  std::string summary, event = "\x09";
  put_bytes(summary, 1, one);
  put_little(event, 0, 8);
  event += '\x10';
  put_varint(event, static_cast<std::uint64_t>(step));
  put_bytes(event, 5, summary);
  return event;
}

}  // namespace

std::string write_checkpoint(const TrainingState& state, const std::string& job) {
  TrainingState copy = state;
  TensorFile file;
  for_each_map(copy, [&](const char* prefix, const NamedTensors& tensors) {
    for (const auto& [name, tensor] : tensors) file.tensors[prefix + name] = from_torch(tensor);
  });
  Json numbers{{"job", job},
               {"step", state.step},
               {"without_better", state.without_better},
               {"best", state.best_judgement ? Json(*state.best_judgement) : Json()},
               {"points", Json::array()}};
  for (const TrainingPoint& point : state.points) numbers["points"].push_back(point_json(point));
  file.metadata[checkpoint_key] = numbers.dump();
  return write_safetensors(file);
}

Result<TrainingState> read_checkpoint(std::string_view bytes, const std::string& job,
                                      const std::string& name) {
  const TensorFile file = KA_TRY(read_safetensors(bytes, name));
  const auto text = file.metadata.find(checkpoint_key);
  const Json json =
      text == file.metadata.end() ? Json() : Json::parse(text->second, nullptr, false);
  if (!json.is_object()) {
    return Failure(Error{name, 0, "a training run to continue", "a file of another kind"});
  }
  TrainingState out;
  try {
    // Adam's moments and the average belong to one loss on one set of data. With another loss or
    // other data the result would not be that of the stopped run.
    if (json.at("job").get<std::string>() != job) {
      return Failure(Error{name, 0, "the run of this method, data and settings", "another run"});
    }
    read_numbers(json, out);
  } catch (const Json::exception& fault) {
    return Failure(Error{name, 0, "a complete training run", shown(fault.what())});
  }
  for_each_map(out, [&](const char* prefix, NamedTensors& tensors) {
    const std::string begin(prefix);
    for (const auto& [full, tensor] : file.tensors) {
      if (full.starts_with(begin)) tensors[full.substr(begin.size())] = to_torch(tensor);
    }
  });
  return out;
}

// Six digits are enough for people; a checkpoint has all digits of the numbers.
std::string csv_of(const std::vector<TrainingPoint>& points) {
  std::string out = "step,loss,rate,gradient,judgement\n";
  for (const TrainingPoint& point : points) {
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), "%lld,%.6g,%.6g,%.6g,",
                  static_cast<long long>(point.step), point.loss, point.rate, point.gradient);
    out += line.data();
    if (point.judgement) {
      std::snprintf(line.data(), line.size(), "%.6g", *point.judgement);
      out += line.data();
    }
    out += '\n';
  }
  return out;
}

std::string events_of(const std::vector<TrainingPoint>& points) {
  // TensorBoard expects the version of the format as the first record.
  std::string version = "\x09", out;
  put_little(version, 0, 8);
  put_bytes(version, 3, "brain.Event:2");
  put_record(out, version);
  for (const TrainingPoint& point : points) {
    put_record(out, event_of(point.step, "loss", point.loss));
    put_record(out, event_of(point.step, "rate", point.rate));
    put_record(out, event_of(point.step, "gradient", point.gradient));
    if (point.judgement) put_record(out, event_of(point.step, "judgement", *point.judgement));
  }
  return out;
}

}  // namespace kinalign
