// SPDX-License-Identifier: Apache-2.0
// Describes the content of a take, column by column, for all file formats. Names, shapes, units and
// spaces of docs/formats/take.md are defined only here.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/row_arrays.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kinalign {

/// The end sites of a skeleton in the form that files contain.
struct EndSiteArrays {
  std::vector<int> parents;   // [E] index of each end site's joint
  std::vector<Vec3> offsets;  // [E] m
};
EndSiteArrays end_site_arrays(const Skeleton& skeleton);

/// The precision of numbers in the file. All computation uses double.
enum class Precision { single, full };
inline Precision precision_of(const TakeHeader& header) {
  return header.parameters.align.store_double ? Precision::full : Precision::single;
}

/// The type of a stored value.
enum class Stored : std::uint8_t { float32, float64, int64, int32, uint8 };

/// The size of one value in bytes.
std::size_t size_of(Stored stored);
inline Stored stored_number(Precision precision) {
  return precision == Precision::single ? Stored::float32 : Stored::float64;
}

/// One array of a stream. Each row has a value, vectors or rotations. HDF5, NPZ and the exports use
/// the same list, so a column has the same name in all of them.
struct TakeColumn {
  std::string name;                  // for example "positions"
  Stored stored = Stored::float32;   // type in the file
  std::vector<std::uint64_t> shape;  // shape of one row: {59, 3}; {}: one value
  std::vector<std::pair<std::string, std::string>> facts;  // units, space and order of components

  std::uint64_t row_values() const;
  std::uint64_t row_bytes() const { return row_values() * size_of(stored); }
};

/// The kind of the stream: "clip", "points" or "imu".
std::string_view kind_of(const TakeGroup& group);

/// These texts tell whether a node's acceleration includes gravity.
constexpr const char* gravity_included = "included";
constexpr const char* gravity_removed = "removed";
std::vector<std::string> gravity_texts(const ImuGroup& group);  // [S] one text per node

/// The columns of a stream, in the order of for_each_row_array(). Writers and readers rely on the
/// same order of columns and arrays.
std::vector<TakeColumn> columns_of(const TakeGroup& group, Precision precision);

/// The names of the stream's joints or nodes, and the name of this list in a file.
const std::vector<std::string>& names_of(const TakeGroup& group);
inline const char* names_key(const TakeGroup& group) {
  return std::holds_alternative<ImuGroup>(group.kind) ? "node_names" : "joint_names";
}
/// A label for each number in a row of the column, for example "Hips.x". A single number per row
/// has the label "row".
std::vector<std::string> labels_of(const TakeColumn& column, const TakeGroup& group);
/// Describes a stream as JSON: name, kind and names. A skeleton also has parents, rest_offsets and
/// end_sites. Nodes also have root_node and gravity.
std::string stream_json(const TakeGroup& group);

/// Fails if a take with this header could not be read again. The names of streams and joints must
/// be unique and not empty, without '/' and NUL. A skeleton's parents must come before their
/// children.
Result<void> validate(const TakeHeader& header);

using AnyRows = std::variant<ClipRows, PointRows, ImuRows>;

/// Empty rows of the same kind as the stream.
AnyRows rows_for(const TakeGroup& group);

/// Calls use(name, array), which returns Result<void>, for each array of `rows`, in the order of
/// columns_of(). `rows` has one of the types in AnyRows, const or not. Arrays that are empty in
/// this stream are included. The first failure ends the calls.
template <class Rows, class Use>
Result<void> for_each_row_array(Rows& rows, Use&& use) {
  Result<void> done;
  for_each_column<std::remove_const_t<Rows>>([&](std::string_view name, auto of) {
    if (done) done = use(name, of(rows));
  });
  return done;
}

/// The bytes of an array in memory. Files contain the same bytes, because kinalign only runs on
/// little-endian machines.
template <class Value>
std::string_view bytes_of(std::span<const Value> values) {
  static_assert(std::endian::native == std::endian::little && sizeof(Time) == 8);
  static_assert(std::is_trivially_copyable_v<Value>);
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Converts numbers for a file, piece by piece. A piece is small enough to stay in the cache until
/// it is copied, and large enough for an efficient write. All columns use the same buffer, so no
/// memory is allocated per slab.
class NumberStore {
 public:
  NumberStore() : singles_(piece) {}

  /// Calls put(bytes), which returns Result<void>, until all of `values` are passed on in the form
  /// `stored`. Only floating-point numbers can change their precision.
  template <class Value, class Put>
  Result<void> store(std::span<const Value> values, Stored, Put&& put) {
    return put(bytes_of(values));
  }
  template <class Put>
  Result<void> store(std::span<const double> values, Stored stored, Put&& put) {
    check_numbers(values);
    if (stored == Stored::float64) return put(bytes_of(values));
    while (!values.empty()) {
      const std::size_t count = values.size() < piece ? values.size() : piece;
      narrow(values.first(count));
      KA_TRY(put(bytes_of(std::span<const float>(singles_).first(count))));
      values = values.subspan(count);
    }
    return {};
  }

 private:
  /// The number of values in a piece: 0.5 MiB of floats, the fastest of all measured sizes.
  static constexpr std::size_t piece = 128 * 1024;
  static void check_numbers(std::span<const double> values);
  void narrow(std::span<const double> values);

  std::vector<float> singles_;
};

}  // namespace kinalign
