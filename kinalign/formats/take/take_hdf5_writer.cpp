// SPDX-License-Identifier: Apache-2.0
// Writes a take. HDF5 assigns the positions and writes the small parts. Rows are written directly
// to these positions without HDF5.
#include "kinalign/documents/parameters_json.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/hdf5_checks.h"
#include "kinalign/formats/take/hdf5_file.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_layout.h"
#include "kinalign/take/remembered_path.h"

#include <hdf5.h>

#include <algorithm>
#include <cassert>

namespace kinalign {

namespace {

using hdf5::Bytes;
using hdf5::Handle;
using hdf5::Shape;

constexpr const char* can_hold = "a take that HDF5 can hold";

/// A column and its position in the file. `at` never changes, because arrays in one piece do not
/// move.
struct Placed {
  std::string name;
  Stored stored = Stored::uint8;
  std::uint64_t row_bytes = 0;
  std::uint64_t at = 0;
};

/// Creates groups and data sets. All objects are created before the first row, so that HDF5 assigns
/// all positions early.
class Layout {
 public:
  explicit Layout(Bytes& bytes) : bytes_(bytes) {}

  /// Creates a column for all rows. Its values are written later.
  Result<Placed> column(hid_t parent, std::uint64_t frames, const TakeColumn& column) const {
    std::vector<hsize_t> sizes{frames};
    sizes.insert(sizes.end(), column.shape.begin(), column.shape.end());
    const Handle made =
        hdf5::create_dataset(parent, column.name, {hdf5::type_of(column.stored), sizes});
    if (!made.good()) return hdf5::failure(bytes_, can_hold);
    // The attributes describe units and spaces to other programs.
    for (const auto& [name, text] : column.facts) {
      if (!hdf5::put_text(made.id(), name.c_str(), text)) return hdf5::failure(bytes_, can_hold);
    }
    return Placed{column.name, column.stored, column.row_bytes(), H5Dget_offset(made.id())};
  }

  /// Creates a data set and writes its values.
  Result<void> whole(hid_t parent, const char* name, const Shape& shape, const void* data,
                     const char* units = nullptr) const {
    const Handle made = hdf5::create_dataset(parent, name, shape);
    // An array without values needs no write.
    const bool empty = std::find(shape.sizes.begin(), shape.sizes.end(), 0U) != shape.sizes.end();
    if (!made.good() ||
        (!empty && H5Dwrite(made.id(), shape.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) ||
        (units != nullptr && !hdf5::put_text(made.id(), "units", units))) {
      return hdf5::failure(bytes_, can_hold);
    }
    return check();
  }

  Result<void> text(hid_t parent, const char* name, const std::string& text) const {
    const Handle type = hdf5::text_type(text.size());
    return whole(parent, name, {type.id(), {}}, text.c_str());
  }

  Result<void> texts(hid_t parent, const char* name, const std::vector<std::string>& texts) const {
    const hdf5::PackedTexts packed = hdf5::pack(texts);
    const Handle type = hdf5::text_type(packed.width);
    return whole(parent, name, {type.id(), {texts.size()}}, packed.bytes.data());
  }

  /// Writes the arrays of a skeleton into a group.
  Result<void> skeleton(hid_t group, const Skeleton& skeleton) const {
    // The vectors are written in the same form as in memory.
    static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(int) == 4);
    const std::size_t joints = skeleton.joints();
    KA_TRY(whole(group, "parents", {H5T_STD_I32LE, {joints}}, skeleton.parents.data()));
    KA_TRY(whole(group, "rest_offsets", {H5T_IEEE_F64LE, {joints, 3}}, skeleton.rest_offsets.data(),
                 "m"));
    const EndSiteArrays sites = end_site_arrays(skeleton);
    const std::size_t count = sites.parents.size();
    const Handle made = hdf5::create_group(group, "end_sites");
    if (!made.good()) return hdf5::failure(bytes_, can_hold);
    KA_TRY(whole(made.id(), "parents", {H5T_STD_I32LE, {count}}, sites.parents.data()));
    return whole(made.id(), "offsets", {H5T_IEEE_F64LE, {count, 3}}, sites.offsets.data(), "m");
  }

  /// Returns the failure of an earlier write, which HDF5 did not get.
  Result<void> check() const {
    if (bytes_.failure) return Failure(*bytes_.failure);
    return {};
  }

 private:
  Bytes& bytes_;
};

/// Stores names, hashes and sizes of the files from which a stream was made. Three attributes of
/// equal length form the list.
bool put_inputs(hid_t group, const std::vector<InputFacts>& files) {
  std::vector<std::string> names;
  std::vector<std::string> hashes;
  std::vector<std::uint64_t> sizes;
  for (const InputFacts& file : files) {
    // Only a part of the path is stored, so that a take does not reveal the author's folders.
    names.push_back(remembered_path(file.name));
    hashes.push_back(file.sha256);
    sizes.push_back(file.bytes);
  }
  return hdf5::put_texts(group, "input_names", names) &&
         hdf5::put_texts(group, "input_sha256", hashes) &&
         (sizes.empty() ||
          hdf5::put_attribute(group, "input_bytes", {H5T_STD_U64LE, {sizes.size()}}, sizes.data()));
}

/// Stores the attributes of the whole take.
bool put_root_attributes(hid_t root, const TakeHeader& header) {
  std::vector<std::string> names;
  for (const TakeGroup& group : header.groups) names.push_back(group.name);
  // This attribute tells MATLAB that it shows the dimensions in reverse order.
  const int reversed = 1;
  return hdf5::put_text(root, "format", "kinalign.take/1") &&
         hdf5::put_text(root, "software", take_software()) &&
         hdf5::put_text(root, "subject", header.subject) &&
         hdf5::put_text(root, "action", header.action) &&
         hdf5::put_text(root, "axes", "right-handed, y up") &&
         hdf5::put_texts(root, "streams", names) &&
         hdf5::put_attribute(root, "matlab_dims_reversed", {H5T_STD_I32LE, {}}, &reversed);
}

}  // namespace

/// The file that is being written, and the position of each column. HDF5 has pointers into this
/// object, so it must not move. `output` contains the bytes.
struct TakeWriter::State {
  explicit State(OutputFile opened) : output(std::move(opened)) { bytes.output = &output; }

  OutputFile output;
  Bytes bytes;
  Handle file;
  Placed time, seconds, start;
  std::vector<std::vector<Placed>> groups;
  std::uint64_t frames = 0, rows = 0;
  Time first{};
  NumberStore numbers;
  std::vector<double> since_start;

  Result<void> lay_out(const TakeHeader& header);
  Result<void> lay_out(const TakeGroup& group, Precision precision);
  Result<void> reserve();
  Result<void> write_stamps(std::span<const Time> stamps);

  /// Writes values of a column for the next rows.
  template <class Value>
  Result<void> write(const Placed& column, std::span<const Value> values) {
    // The position follows from the number of rows so far.
    std::uint64_t at = column.at + rows * column.row_bytes;
    const auto put = [&](std::string_view piece) -> Result<void> {
      KA_TRY(bytes.write(at, piece));
      at += piece.size();
      return {};
    };
    return numbers.store(values, column.stored, put);
  }
};

/// Creates all groups and data sets of the file.
Result<void> TakeWriter::State::lay_out(const TakeHeader& header) {
  frames = header.frames;
  const Layout layout(bytes);
  const hid_t root = file.id();
  if (!put_root_attributes(root, header)) return hdf5::failure(bytes, can_hold);
  time = KA_TRY(layout.column(
      root, frames,
      {"time_ns", Stored::int64, {}, {{"units", "ns since 1970-01-01T00:00:00 UTC"}}}));
  seconds = KA_TRY(
      layout.column(root, frames, {"seconds", Stored::float64, {}, {{"units", "s since t0_ns"}}}));
  // t0 is stored with the first row. Until then its value is 0.
  const std::int64_t zero = 0;
  KA_TRY(
      layout.whole(root, "t0_ns", {H5T_STD_I64LE, {}}, &zero, "ns since 1970-01-01T00:00:00 UTC"));
  const Handle t0(H5Dopen2(root, "t0_ns", H5P_DEFAULT), H5Dclose);
  start = {"t0_ns", Stored::int64, 8, H5Dget_offset(t0.id())};
  const Precision precision = precision_of(header);
  for (const TakeGroup& group : header.groups) KA_TRY(lay_out(group, precision));
  KA_TRY(layout.text(root, "parameters_json", parameters_json(without_folders(header.parameters))));
  KA_TRY(layout.check());
  return reserve();
}

/// Reserves disk space for the whole file, so that a full disk is reported before the rows.
Result<void> TakeWriter::State::reserve() {
  hsize_t size = 0;
  // HDF5 has assigned all positions. Only the report will still increase the size.
  if (H5Fget_filesize(file.id(), &size) < 0) return hdf5::failure(bytes, can_hold);
  KA_TRY(output.reserve(size));
  bytes.size = std::max<std::uint64_t>(bytes.size, size);
  return {};
}

/// Creates the group of a stream with its columns.
Result<void> TakeWriter::State::lay_out(const TakeGroup& group, Precision precision) {
  const Layout layout(bytes);
  const Handle made = hdf5::create_group(file.id(), group.name);
  if (!made.good() || !hdf5::put_text(made.id(), "kind", kind_of(group)) ||
      !put_inputs(made.id(), group.files)) {
    return hdf5::failure(bytes, can_hold);
  }
  KA_TRY(layout.texts(made.id(), names_key(group), names_of(group)));
  const auto* clip = std::get_if<ClipGroup>(&group.kind);
  if (clip != nullptr) KA_TRY(layout.skeleton(made.id(), clip->skeleton));
  const auto* imu = std::get_if<ImuGroup>(&group.kind);
  if (imu != nullptr && (!hdf5::put_text(made.id(), "root_node", imu->root_node) ||
                         !hdf5::put_texts(made.id(), "gravity", gravity_texts(*imu)))) {
    return hdf5::failure(bytes, can_hold);
  }
  std::vector<Placed>& placed = groups.emplace_back();
  for (const TakeColumn& column : columns_of(group, precision)) {
    placed.push_back(KA_TRY(layout.column(made.id(), frames, column)));
  }
  return layout.check();
}

// Writes the stamps. `seconds`: the times since the first row as doubles.
Result<void> TakeWriter::State::write_stamps(std::span<const Time> stamps) {
  if (stamps.empty()) return {};
  if (rows == 0) {
    first = stamps.front();
    KA_TRY(write(start, stamps.first(1)));
  }
  since_start.clear();
  for (const Time stamp : stamps) since_start.push_back(kinalign::seconds(stamp - first));
  KA_TRY(write(time, stamps));
  return write(seconds, std::span<const double>(since_start));
}

TakeWriter::TakeWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
TakeWriter::TakeWriter(TakeWriter&& other) noexcept = default;
TakeWriter& TakeWriter::operator=(TakeWriter&& other) noexcept = default;
TakeWriter::~TakeWriter() = default;

std::string take_software() { return "kinalign " KINALIGN_VERSION; }

Result<TakeWriter> TakeWriter::create(FileSystem& files, std::string path, Overwrite overwrite,
                                      const TakeHeader& header) {
  // The header is checked first, so that no file is created if a name can't be stored.
  KA_TRY(validate(header));
  auto state =
      std::make_unique<State>(KA_TRY(OutputFile::create(files, std::move(path), overwrite)));
  state->file = KA_TRY(hdf5::create(state->bytes));
  KA_TRY(state->lay_out(header));
  return TakeWriter(std::move(state));
}

Result<void> TakeWriter::append(const TakeSlab& slab) {
  State& s = *state_;
  // These conditions are promises of the caller, so a fault here is a bug of the program.
  assert(slab.first == s.rows && slab.rows.size() == s.groups.size());
  assert(s.rows + slab.stamps.size() <= s.frames);
  const std::uint64_t count = slab.stamps.size();
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    auto column = s.groups[g].cbegin();
    const auto use = [&](std::string_view name, const auto& values) -> Result<void> {
      // If the layout does not contain an array, the array is empty in the rows.
      if (column == s.groups[g].cend() || column->name != name) return {};
      const std::span given(values);
      assert(given.size() * size_of(column->stored) == count * column->row_bytes);
      return s.write(*column++, given);
    };
    KA_TRY(
        std::visit([&](const auto& rows) { return for_each_row_array(rows, use); }, slab.rows[g]));
    // All columns have got their rows.
    assert(column == s.groups[g].cend());
  }
  // `rows` increases only after all arrays of the slab are written.
  KA_TRY(s.write_stamps(slab.stamps));
  s.rows += count;
  return {};
}

Result<void> TakeWriter::finish(const AlignmentReport& report) {
  State& s = *state_;
  assert(s.rows == s.frames);
  const Layout layout(s.bytes);
  // The report exists only after all rows are written.
  KA_TRY(layout.text(s.file.id(), "report_json", report_json(report)));
  // When the file is closed, HDF5 writes its remaining parts.
  if (!s.file.reset()) return hdf5::failure(s.bytes, can_hold);
  KA_TRY(layout.check());
  // The file gets its name only if everything is written.
  return s.output.commit();
}

}  // namespace kinalign
