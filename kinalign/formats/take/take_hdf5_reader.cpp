// SPDX-License-Identifier: Apache-2.0
// Reads a take. Before memory is allocated for a data set, the data set must be completely inside
// the file.
#include "kinalign/documents/parameters_json.h"
#include "kinalign/formats/take/hdf5_checks.h"
#include "kinalign/formats/take/hdf5_file.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_layout.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace kinalign {

namespace {

using hdf5::Bytes;
using hdf5::Handle;
using hdf5::Source;

/// A column in the file. Its type and shape are those that the header requires.
struct Found {
  std::string name;
  Source source;
};

Failure bad_value(const std::string& path, const std::string& expected, const std::string& where) {
  return refuse(path, expected, "other content in " + where);
}

bool is_wanted(const std::vector<std::string>& wanted, const std::string& name) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

/// True if all values are finite, because 0 * x is NaN for NaN and for infinity. Several sums are
/// kept, so that an addition need not wait for the previous one.
bool finite(std::span<const double> values) {
  // Each of the 16 sums is independent of the others.
  constexpr std::size_t lanes = 16;
  std::array<double, lanes> sums{};
  const std::size_t even = values.size() / lanes * lanes;
  for (std::size_t i = 0; i < even; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) sums[k] += 0.0 * values[i + k];
  }
  for (const double value : values.subspan(even)) sums[0] += 0.0 * value;
  return std::accumulate(sums.begin(), sums.end(), 0.0) == 0.0;
}

/// Reads the end sites of a skeleton. Checks that their joints exist.
Result<std::vector<EndSite>> read_end_sites(const hdf5::Checked& file, hid_t group,
                                            std::uint64_t joints) {
  const Handle sites(H5Gopen2(group, "end_sites", H5P_DEFAULT), H5Gclose);
  if (!sites.good()) return hdf5::failure(file.bytes(), "a group end_sites");
  const std::uint64_t count = KA_TRY(file.rows(sites.id(), "parents"));
  const auto parents = KA_TRY(file.all<int>(sites.id(), "parents", {count}));
  const auto tips = KA_TRY(file.all<double>(sites.id(), "offsets", {count, 3}));
  if (!finite(tips)) return bad_value(file.bytes().path(), "finite numbers", "end_sites");
  std::vector<EndSite> out;
  for (std::size_t e = 0; e < count; ++e) {
    // validate() checks the parents of the skeleton itself.
    if (parents[e] < 0 || static_cast<std::uint64_t>(parents[e]) >= joints) {
      return bad_value(file.bytes().path(), "an end site's joint", "end_sites");
    }
    out.push_back({parents[e], vec3(tips, e)});
  }
  return out;
}

/// Reads a skeleton and checks it.
Result<Skeleton> read_skeleton(const hdf5::Checked& file, hid_t group) {
  Skeleton out;
  out.joint_names = KA_TRY(file.texts(group, "joint_names"));
  const std::uint64_t joints = out.joint_names.size();
  out.parents = KA_TRY(file.all<int>(group, "parents", {joints}));
  const auto offsets = KA_TRY(file.all<double>(group, "rest_offsets", {joints, 3}));
  if (!finite(offsets)) return bad_value(file.bytes().path(), "finite numbers", "rest_offsets");
  for (std::size_t j = 0; j < joints; ++j) out.rest_offsets.emplace_back(vec3(offsets, j));
  out.end_sites = KA_TRY(read_end_sites(file, group, joints));
  KA_TRY(validate(out));
  return out;
}

/// Reads names and content of a stream of inertial nodes.
Result<ImuGroup> read_imu(const hdf5::Checked& file, hid_t group) {
  ImuGroup out;
  out.node_names = KA_TRY(file.texts(group, "node_names"));
  out.root_node = KA_TRY(file.text_attribute(group, "root_node"));
  const auto gravity = KA_TRY(file.text_attributes(group, "gravity"));
  // The list contains a text for each node. One node with gravity is enough.
  out.content.gravity =
      std::find(gravity.begin(), gravity.end(), gravity_included) != gravity.end();
  out.content.orientation = hdf5::has(group, "orientation");
  out.content.acceleration = hdf5::has(group, "acceleration");
  out.content.angular_velocity = hdf5::has(group, "angular_velocity");
  return out;
}

/// The space of the joints' positions; "take" if the file does not state a space.
std::string space_of(const hdf5::Checked& file, hid_t group) {
  const Handle positions(H5Dopen2(group, "positions", H5P_DEFAULT), H5Dclose);
  return file.text_attribute(positions.id(), "space").value_or("take");
}

/// Reads the header of one stream without its rows.
Result<TakeGroup> read_group(const hdf5::Checked& file, hid_t group, std::string name) {
  TakeGroup out;
  out.name = std::move(name);
  // The reference stream does not have this column, because it keeps its own stamps.
  out.resampled = hdf5::has(group, "nearest_raw_ns");
  out.interval_known = hdf5::has(group, "time_interval_ns");
  out.files = KA_TRY(file.inputs(group));
  const std::string kind = KA_TRY(file.text_attribute(group, "kind"));
  if (kind == "clip") {
    out.kind = ClipGroup{KA_TRY(read_skeleton(file, group))};
  } else if (kind == "points") {
    out.kind = PointGroup{KA_TRY(file.texts(group, "joint_names"))};
  } else if (kind == "imu") {
    out.kind = KA_TRY(read_imu(file, group));
  } else {
    return refuse(file.bytes().path(), "a kind of stream: clip, points or imu",
                  "\"" + shown(kind) + "\"");
  }
  return out;
}

}  // namespace

/// The open file, the header, and the position of each column. `bytes` points to `input`, and
/// `file` to `bytes`. A State must therefore not move, so a std::unique_ptr owns it.
struct TakeReader::State {
  explicit State(InputFile opened) : input(std::move(opened)) {
    bytes.input = &input;
    bytes.size = input.size();
  }

  InputFile input;
  Bytes bytes;
  hdf5::Checked checked{bytes};
  Handle file;
  TakeHeader header;
  std::string software;
  Source time;
  // [streams][columns] in the order of columns_of(), without columns that were not selected.
  std::vector<std::vector<Found>> columns;
  // rows: the position of next(). last: the last stamp before that position.
  std::uint64_t rows = 0, slab_rows = 4096;
  Time last = Time::min();

  Result<void> read_words();
  Result<void> check_format() const;
  Result<void> read_header(const TakeParts& parts);
  Result<void> find_stream(const std::string& name, const TakeParts& parts,
                           std::uint64_t& row_bytes);
  Result<void> find_columns(hid_t group, const TakeGroup& what, const TakeParts& parts,
                            std::uint64_t& row_bytes);
  Result<void> read_stamps(std::uint64_t first, std::uint64_t count, std::vector<Time>& stamps);
  Result<void> read_slab(std::uint64_t first, std::uint64_t count, TakeSlab& slab);

  Result<void> check(const Found& column, std::span<const double> values) const {
    return finite(values) ? Result<void>() : bad_value(input.path(), "finite numbers", column.name);
  }
  Result<void> check(const Found& column, std::span<const std::int64_t> values) const {
    // An unknown interval is stored as no_interval, which is negative.
    const std::int64_t least = column.name == "time_interval_ns" ? no_interval : 0;
    const bool good =
        std::none_of(values.begin(), values.end(), [least](auto v) { return v < least; });
    return good ? Result<void>() : bad_value(input.path(), "times of 0 or more", column.name);
  }
  template <class Flag>
  Result<void> check(const Found& column, std::span<const Flag> values) const {
    // Tracking has three values; other flags have two.
    constexpr int most = std::is_same_v<Flag, Tracking> ? 2 : 1;
    const bool good = std::all_of(values.begin(), values.end(),
                                  [](Flag v) { return static_cast<int>(v) <= most; });
    return good ? Result<void>()
                : bad_value(input.path(), "values up to " + std::to_string(most), column.name);
  }
};

/// Reads the text attributes of the whole take, and its parameters.
Result<void> TakeReader::State::read_words() {
  const hid_t root = file.id();
  software = KA_TRY(checked.text_attribute(root, "software"));
  header.subject = KA_TRY(checked.text_attribute(root, "subject"));
  header.action = KA_TRY(checked.text_attribute(root, "action"));
  auto parameters = parse_parameters_json(KA_TRY(checked.text(root, "parameters_json")));
  if (!parameters) {
    parameters.error().file = input.path();
    return Failure(std::move(parameters).error());
  }
  header.parameters = *std::move(parameters);
  return {};
}

Result<void> TakeReader::State::check_format() const {
  const auto format = checked.text_attributes(file.id(), "format");
  // The format is checked first, so that another HDF5 file gets one clear message.
  if (!format || format->size() != 1 || !format->front().starts_with("kinalign.take/")) {
    return refuse(input.path(), "a take that kinalign wrote", "HDF5 of another kind");
  }
  if (format->front() != "kinalign.take/1") {
    return refuse(input.path(), "format kinalign.take/1", "\"" + shown(format->front()) + "\"");
  }
  return {};
}

/// Reads everything except the rows, and chooses the size of a slab.
Result<void> TakeReader::State::read_header(const TakeParts& parts) {
  const hid_t root = file.id();
  KA_TRY(check_format());
  KA_TRY(read_words());
  header.frames = KA_TRY(checked.rows(root, "time_ns"));
  time = KA_TRY(checked.find(root, "time_ns", Stored::int64, {header.frames}));
  // A stamp in time_ns has eight bytes.
  std::uint64_t row_bytes = 8;
  for (const std::string& name : KA_TRY(checked.text_attributes(root, "streams"))) {
    if (is_wanted(parts.streams, name)) KA_TRY(find_stream(name, parts, row_bytes));
  }
  constexpr std::uint64_t slab_bytes = std::uint64_t{16} << 20;
  // A slab has at most 4096 rows or about 16 MiB.
  slab_rows = std::clamp<std::uint64_t>(slab_bytes / row_bytes, 1, 4096);
  return validate(header);
}

Result<void> TakeReader::State::find_stream(const std::string& name, const TakeParts& parts,
                                            std::uint64_t& row_bytes) {
  // The name comes from the file. HDF5 only searches it in the same file.
  const Handle group(H5Gopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.good()) return hdf5::failure(bytes, "a group for each stream");
  header.groups.push_back(KA_TRY(read_group(checked, group.id(), name)));
  TakeGroup& what = header.groups.back();
  KA_TRY(find_columns(group.id(), what, parts, row_bytes));
  if (!std::holds_alternative<ImuGroup>(what.kind)) what.space = space_of(checked, group.id());
  return {};
}

/// Finds the selected columns of a stream, in the order of columns_of().
Result<void> TakeReader::State::find_columns(hid_t group, const TakeGroup& what,
                                             const TakeParts& parts, std::uint64_t& row_bytes) {
  const Precision precision = precision_of(header);
  auto& found = columns.emplace_back();
  for (const TakeColumn& column : columns_of(what, precision)) {
    if (!is_wanted(parts.arrays, column.name)) continue;
    std::vector<std::uint64_t> sizes{header.frames};
    sizes.insert(sizes.end(), column.shape.begin(), column.shape.end());
    found.push_back(
        {column.name, KA_TRY(checked.find(group, column.name.c_str(), column.stored, sizes))});
    // In memory a number has at most eight bytes.
    row_bytes += column.row_values() * 8;
  }
  return {};
}

Result<void> TakeReader::State::read_stamps(std::uint64_t first, std::uint64_t count,
                                            std::vector<Time>& stamps) {
  stamps.resize(count);
  KA_TRY(hdf5::read_rows(bytes, time, first, count, stamps.data()));
  // Equal stamps are refused, too.
  const auto falls = [](Time one, Time next) { return next <= one; };
  if (std::adjacent_find(stamps.begin(), stamps.end(), falls) == stamps.end()) return {};
  return bad_value(input.path(), "rising stamps", "time_ns");
}

/// Reads rows of all streams. Columns that were not selected become empty.
Result<void> TakeReader::State::read_slab(std::uint64_t first, std::uint64_t count,
                                          TakeSlab& slab) {
  // The caller uses the same slab many times, so its arrays keep their memory.
  slab.first = first;
  slab.rows.resize(columns.size());
  KA_TRY(read_stamps(first, count, slab.stamps));
  for (std::size_t g = 0; g < columns.size(); ++g) {
    AnyRows& group = slab.rows[g];
    AnyRows kind = rows_for(header.groups[g]);
    // The slab was used for another kind of stream before.
    if (group.index() != kind.index()) group = std::move(kind);
    auto column = columns[g].cbegin();
    const auto use = [&](std::string_view name, auto& values) -> Result<void> {
      // The arrays are in the order of columns_of(). If the name differs, the column was not
      // selected.
      if (column == columns[g].cend() || column->name != name) {
        values.clear();
        return {};
      }
      values.resize(count * column->source.row_values);
      KA_TRY(hdf5::read_rows(bytes, column->source, first, count, values.data()));
      return check(*column++, std::span(std::as_const(values)));
    };
    KA_TRY(std::visit([&](auto& one) { return for_each_row_array(one, use); }, group));
  }
  return {};
}

TakeReader::TakeReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
TakeReader::TakeReader(TakeReader&& other) noexcept = default;
TakeReader& TakeReader::operator=(TakeReader&& other) noexcept = default;
TakeReader::~TakeReader() = default;

Result<TakeReader> TakeReader::open(FileSystem& files, std::string path, const TakeParts& parts) {
  // The State is created first, because HDF5 keeps a pointer to its `bytes`.
  auto state = std::make_unique<State>(KA_TRY(InputFile::open(files, std::move(path))));
  state->file = KA_TRY(hdf5::open(state->bytes));
  auto read = state->read_header(parts);
  // Errors of validate() name no file.
  if (!read && read.error().file.empty()) {
    Error error = read.error();
    error.file = state->input.path();
    return Failure(error);
  }
  KA_TRY(std::move(read));
  return TakeReader(std::move(state));
}

const TakeHeader& TakeReader::header() const { return state_->header; }
const std::string& TakeReader::software() const { return state_->software; }

Result<bool> TakeReader::next(TakeSlab& slab) {
  State& s = *state_;
  const std::uint64_t count = std::min(s.slab_rows, s.header.frames - s.rows);
  if (count == 0) return false;
  KA_TRY(s.read_slab(s.rows, count, slab));
  // read_stamps() has compared the stamps within a slab. This compares two neighbouring slabs.
  if (slab.stamps.front() <= s.last) {
    return bad_value(s.input.path(), "rising stamps", "time_ns");
  }
  s.last = slab.stamps.back();
  s.rows += count;
  return true;
}

Result<void> TakeReader::read(std::uint64_t first, std::uint64_t count, TakeSlab& slab) {
  const std::uint64_t frames = state_->header.frames;
  // The comparison avoids a sum that could overflow.
  if (first > frames || count > frames - first) {
    return refuse(state_->input.path(),
                  "rows " + std::to_string(first) + " to " + std::to_string(first + count),
                  std::to_string(frames) + " rows");
  }
  return state_->read_slab(first, count, slab);
}

Result<std::vector<Time>> TakeReader::stamps() {
  std::vector<Time> all;
  KA_TRY(state_->read_stamps(0, state_->header.frames, all));
  return all;
}

Result<std::string> TakeReader::report_json() const {
  return state_->checked.text(state_->file.id(), "report_json");
}

Result<Take> read_take(FileSystem& files, const std::string& path) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  Take take;
  take.header = reader.header();
  for (const TakeGroup& group : take.header.groups) take.all.rows.push_back(rows_for(group));
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) append_rows(take.all, slab);
  return take;
}

}  // namespace kinalign
