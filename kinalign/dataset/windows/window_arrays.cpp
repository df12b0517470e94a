// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/windows/window_arrays.h"

#include "kinalign/formats/take/take_hdf5.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// The first arrays of the file are in this order.
enum Fixed : std::size_t {
  take_array,
  part_array,
  first_array,
  time_array,
  rows_array,
  manifest_array
};

/// The difference between a take's stream and the stream of that name in the windows; empty if they
/// agree.
std::string difference(const TakeGroup& group, const TakeGroup& other) {
  if (group.kind.index() != other.kind.index())
    return fmt::format("another kind of {}", group.name);
  if (group.space != other.space) return fmt::format("another space of {}", group.name);
  if (names_of(group) != names_of(other)) return fmt::format("other names in {}", group.name);
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    const auto& parents = std::get<ClipGroup>(other.kind).skeleton.parents;
    return clip->skeleton.parents == parents ? ""
                                             : fmt::format("another skeleton in {}", group.name);
  }
  if (const auto* imu = std::get_if<ImuGroup>(&group.kind)) {
    const auto& one = std::get<ImuGroup>(other.kind);
    const bool alike = imu->content == one.content && imu->root_node == one.root_node;
    return alike ? "" : fmt::format("other quantities in {}", group.name);
  }
  return "";
}

/// The columns that a stream has in windows: all that can't be computed from other columns.
std::vector<TakeColumn> window_columns(const TakeGroup& group) {
  std::vector<TakeColumn> columns = columns_of(group, Precision::single);
  const std::vector<std::string> wanted = window_array_names();
  std::erase_if(columns, [&](const TakeColumn& one) {
    return std::find(wanted.begin(), wanted.end(), one.name) == wanted.end();
  });
  // The reference has no array "valid", because all of its rows are valid.
  const auto is_valid = [](const TakeColumn& one) { return one.name == "valid"; };
  if (std::none_of(columns.begin(), columns.end(), is_valid)) {
    columns.push_back({"valid", Stored::uint8, {}, {{"values", "0 no, 1 yes"}}});
  }
  return columns;
}

/// The meaning of one array: its axes, its unit, and the names of its columns.
Json array_json(const TakeGroup& group, const TakeColumn& column) {
  Json out{{"stream", group.name}, {"axes", {"window", "row", "column"}}};
  for (const auto& [key, text] : column.facts) out[key] = text;
  out["columns"] = labels_of(column, group);
  return out;
}

/// The facts about a take from which windows were cut. The hash identifies the take's bytes.
Json take_json(const WindowTake& take, const std::vector<std::string>& parts) {
  return {{"name", to_string(take.name)},  {"subject", take.name.subject},
          {"action", take.name.action},    {"class", take.class_id},
          {"part", parts[take.part]},      {"rate_hz", take.summary.rate_hz},
          {"frames", take.summary.frames}, {"verdict", take.summary.verdict()},
          {"sha256", take.summary.sha256}};
}

/// The stream's facts without bone lengths. Each take has its own bone lengths, which are in an
/// array.
Json windows_stream_json(const TakeGroup& group) {
  Json out = Json::parse(stream_json(group));
  out.erase("rest_offsets");
  out.erase("end_sites");
  return out;
}

/// The manifest of a file of windows: takes, streams and the meaning of each array.
std::string manifest_json(const WindowSource& source, const WindowOptions& options,
                          const WindowStreams& streams, const std::vector<WindowedTake>& takes) {
  // Without the option --rate all takes have the same rate, so the first take's rate is used.
  const double rate =
      options.rate_hz > 0.0 ? options.rate_hz : source.takes[takes.front().index].summary.rate_hz;
  Json out{{"schema", "kinalign.windows/1"}, {"software", take_software()},
           {"dataset", source.name},         {"licence", source.licence},
           {"citation", source.citation},    {"rate_hz", rate},
           {"length", options.length},       {"step", options.step},
           {"least_valid", options.valid},   {"parts", source.parts}};
  for (const WindowedTake& take : takes) {
    out["takes"].push_back(take_json(source.takes[take.index], source.parts));
  }
  for (const TakeGroup& group : streams.groups) {
    out["streams"].push_back(windows_stream_json(group));
    for (const TakeColumn& column : window_columns(group)) {
      out["arrays"][group.name + "_" + column.name] = array_json(group, column);
    }
  }
  return out.dump(1, ' ', false, Json::error_handler_t::replace);
}

/// Adds for each skeleton an array of parents, and an array of the bones of each take.
void add_skeletons(const WindowStreams& streams, const std::vector<WindowedTake>& takes,
                   WindowLayout& layout) {
  std::size_t skeleton = 0;
  for (const TakeGroup& group : streams.groups) {
    const auto* clip = std::get_if<ClipGroup>(&group.kind);
    if (clip == nullptr) continue;
    // Parents are the same in all takes (difference()). Bones differ from take to take.
    const auto& parents = clip->skeleton.parents;
    layout.contents.emplace_back(layout.arrays.size(), bytes_of(std::span<const int>(parents)));
    layout.arrays.push_back(npz_numbers(group.name + "_parents", Stored::int32, {parents.size()}));
    std::string offsets;
    for (const WindowedTake& take : takes) {
      for (const Vec3& offset : take.rest_offsets[skeleton]) {
        offsets += bytes_of(std::span<const double>(offset.data(), 3));
      }
    }
    layout.contents.emplace_back(layout.arrays.size(), std::move(offsets));
    layout.arrays.push_back(npz_numbers(group.name + "_rest_offsets", Stored::float64,
                                        {takes.size(), parents.size(), 3}));
    ++skeleton;
  }
}

/// Adds the arrays with one number per window, and the manifest as an array that is one text.
WindowLayout fixed_arrays(std::uint64_t windows, const std::string& manifest) {
  WindowLayout out;
  out.arrays = {npz_numbers("take", Stored::int32, {windows}),
                npz_numbers("part", Stored::uint8, {windows}),
                npz_numbers("first", Stored::int64, {windows}),
                npz_numbers("time_ns", Stored::int64, {windows}),
                npz_numbers("rows", Stored::int32, {windows})};
  NpzTexts text = npz_texts("manifest", {manifest});
  // If a text array has no dimensions, NumPy reads it as one string.
  text.array.shape.clear();  // a scalar
  out.contents.emplace_back(out.arrays.size(), std::move(text.bytes));
  out.arrays.push_back(std::move(text.array));
  return out;
}

/// The value that replaces an array which a take lacks.
int value_of_absent(std::string_view array) {
  if (array == "valid") return 1;
  return array == "time_interval_ns" ? -1 : 0;
}

template <class Value>
std::string one(Value value) {
  return std::string(bytes_of(std::span<const Value>(&value, 1)));
}

}  // namespace

std::vector<std::string> window_array_names() {
  return {"positions", "local_rotations", "orientation",    "acceleration",    "angular_velocity",
          "state",     "valid",           "nearest_raw_ns", "time_interval_ns"};
}

void WindowStreams::add(const TakeHeader& header, const std::vector<std::size_t>& found) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    // If one take has the array, all windows have it.
    groups[g].resampled |= header.groups[found[g]].resampled;
    groups[g].interval_known |= header.groups[found[g]].interval_known;
  }
}

Result<std::vector<std::size_t>> WindowStreams::find_in(const TakeHeader& header) const {
  std::vector<std::size_t> out;
  for (const TakeGroup& wanted : groups) {
    const auto found = std::find_if(header.groups.begin(), header.groups.end(),
                                    [&](const TakeGroup& g) { return g.name == wanted.name; });
    if (found == header.groups.end()) {
      return Failure(Error{"", 0, "a stream '" + shown(wanted.name) + "'", "no such stream"});
    }
    const std::string differs = difference(*found, wanted);
    if (!differs.empty())
      return Failure(Error{"", 0, "the same streams as in the first take", shown(differs)});
    out.push_back(static_cast<std::size_t>(found - header.groups.begin()));
  }
  return out;
}

/// Lays out all arrays of the file.
WindowLayout window_layout(const WindowSource& source, const WindowOptions& options,
                           const WindowStreams& streams, const std::vector<WindowedTake>& takes) {
  std::uint64_t windows = 0;
  for (const WindowedTake& take : takes) windows += take.places.size();
  const auto length = static_cast<std::uint64_t>(options.length);
  WindowLayout layout = fixed_arrays(windows, manifest_json(source, options, streams, takes));
  add_skeletons(streams, takes, layout);
  for (const TakeGroup& group : streams.groups) {
    auto& found = layout.streams.emplace_back();
    for (const TakeColumn& column : window_columns(group)) {
      found.push_back({column.name, column.stored, column.row_values(), layout.arrays.size()});
      layout.arrays.push_back(npz_numbers(group.name + "_" + column.name, column.stored,
                                          {windows, length, column.row_values()}));
    }
  }
  return layout;
}

Result<WindowFile> WindowFile::create(FileSystem& files, const NewFile& target,
                                      WindowLayout layout) {
  WindowFile out(KA_TRY(NpzWriter::create(files, target.path, target.overwrite, layout.arrays)),
                 std::move(layout.streams));
  for (const auto& [array, bytes] : layout.contents) KA_TRY(out.writer_.append(array, bytes));
  return out;
}

Result<void> WindowFile::append(const WindowOrigin& origin, const std::vector<std::size_t>& groups,
                                const TakeSlab& rows) {
  // The arrays are in the order of `Fixed`.
  KA_TRY(writer_.append(take_array, one(static_cast<int>(origin.take))));
  KA_TRY(writer_.append(part_array, one(origin.part)));
  KA_TRY(writer_.append(first_array, one(static_cast<std::int64_t>(origin.place.first))));
  KA_TRY(writer_.append(time_array, one(origin.place.begin)));
  KA_TRY(writer_.append(rows_array, one(static_cast<int>(origin.place.rows))));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    KA_TRY(append_stream(streams_[g], rows.stamps.size(), rows.rows[groups[g]]));
  }
  return {};
}

/// Writes the arrays of one stream. Arrays that the take lacks get a fixed value.
Result<void> WindowFile::append_stream(const std::vector<WindowLayout::Column>& columns,
                                       std::size_t length, const AnyRows& rows) {
  const auto use = [&](std::string_view name, const auto& values) -> Result<void> {
    const auto column = std::find_if(columns.begin(), columns.end(),
                                     [&](const WindowLayout::Column& c) { return c.name == name; });
    // Windows lack arrays that can be computed from others, such as a skeleton's local positions.
    if (column == columns.end()) return {};
    const auto put = [&](std::string_view bytes) { return writer_.append(column->array, bytes); };
    const std::span given(values);
    using Value = typename decltype(given)::value_type;
    if constexpr (std::is_same_v<Value, double>) {
      return numbers_.store(given, column->stored, put);
    } else {
      if (!given.empty()) return put(bytes_of(given));
      // The take lacks the array, so all cells get the same value.
      const auto value = static_cast<Value>(value_of_absent(name));
      const std::vector<Value> all(length * column->row_values, value);
      return put(bytes_of(std::span<const Value>(all)));
    }
  };
  return std::visit([&](const auto& stream) { return for_each_row_array(stream, use); }, rows);
}

}  // namespace kinalign
