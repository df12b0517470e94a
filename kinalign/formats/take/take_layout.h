// SPDX-License-Identifier: Apache-2.0
// Describes the content of a take, column by column, for every file format that can hold one. The
// names, shapes, units and spaces of docs/formats/take.md are stated here only.
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

/// A skeleton's end sites in the form in which files store them.
struct EndSiteArrays {
  std::vector<int> parents;   // [E] index of the joint
  std::vector<Vec3> offsets;  // [E] m
};
EndSiteArrays end_site_arrays(const Skeleton& skeleton);

/// Precision of stored numbers; all computation is in double.
enum class Precision { single, full };
inline Precision precision_of(const TakeHeader& header) {
  return header.parameters.align.store_double ? Precision::full : Precision::single;
}

/// Type of a stored value.
enum class Stored : std::uint8_t { float32, float64, int64, int32, uint8 };

/// Bytes of one value.
std::size_t size_of(Stored stored);
inline Stored stored_number(Precision precision) {
  return precision == Precision::single ? Stored::float32 : Stored::float64;
}

/// One array of a stream, with a value, vector or rotation in every row.
/// HDF5, NPZ and the exports use the same list, so a name can't differ between them.
struct TakeColumn {
  std::string name;                  // "positions"
  Stored stored = Stored::float32;   // type in the file
  std::vector<std::uint64_t> shape;  // shape of one row: {59, 3}; {}: one value a row
  std::vector<std::pair<std::string, std::string>> facts;  // units, space, order of components

  std::uint64_t row_values() const;
  std::uint64_t row_bytes() const { return row_values() * size_of(stored); }
};

/// The stream's kind: "clip", "points" or "imu".
std::string_view kind_of(const TakeGroup& group);

/// The texts that tell whether a node's acceleration includes gravity.
constexpr const char* gravity_included = "included";
constexpr const char* gravity_removed = "removed";
std::vector<std::string> gravity_texts(const ImuGroup& group);  // [S] of each node

/// The columns of a group's rows, in the order of for_each_row_array.
/// The order matters: writers and readers walk through columns and arrays side by side.
std::vector<TakeColumn> columns_of(const TakeGroup& group, Precision precision);

/// Names of the group's joints or nodes, and how a file calls their list.
const std::vector<std::string>& names_of(const TakeGroup& group);
inline const char* names_key(const TakeGroup& group) {
  return std::holds_alternative<ImuGroup>(group.kind) ? "node_names" : "joint_names";
}
/// A label for each number in a row of the column: "Hips.x"; "row" if there is one number a row.
std::vector<std::string> labels_of(const TakeColumn& column, const TakeGroup& group);
/// The group without its samples, as JSON: name, kind and names; for a skeleton also parents,
/// rest_offsets and end_sites; for nodes also root_node and gravity.
std::string stream_json(const TakeGroup& group);

/// Fails if a take with this header could not be read back. Names of groups and of joints must be
/// unique, not empty, and without '/' or NUL. A skeleton's parents must come before their children.
Result<void> validate(const TakeHeader& header);

using AnyRows = std::variant<ClipRows, PointRows, ImuRows>;

/// Empty rows of the kind that the group has.
AnyRows rows_for(const TakeGroup& group);

/// Calls use(name, array), which returns Result<void>, for each array of `rows`, in the order of
/// columns_of. `rows` is one of the types in AnyRows, const or not. Arrays that the stream leaves
/// empty are included.
/// The first failure ends the work; later arrays are skipped.
template <class Rows, class Use>
Result<void> for_each_row_array(Rows& rows, Use&& use) {
  Result<void> done;
  for_each_column<std::remove_const_t<Rows>>([&](std::string_view name, auto of) {
    if (done) done = use(name, of(rows));
  });
  return done;
}

/// The bytes of an array as they lie in memory, which is the form that files hold.
/// The program runs on little-endian machines only.
template <class Value>
std::string_view bytes_of(std::span<const Value> values) {
  static_assert(std::endian::native == std::endian::little && sizeof(Time) == 8);
  static_assert(std::is_trivially_copyable_v<Value>);
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Converts numbers for a file, piece by piece. A piece is small enough to stay in the cache
/// between conversion and copying, and large enough for an efficient write.
/// Its buffer is reused for all columns, so a slab needs no allocation.
class NumberStore {
 public:
  NumberStore() : singles_(piece) {}

  /// Calls put(bytes), which returns Result<void>, until all of `values` have been passed on in the
  /// form `stored`. Only numbers are stored in another precision than they have in memory.
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
  /// Values: 0.5 MiB of floats, the fastest size measured.
  static constexpr std::size_t piece = 128 * 1024;
  static void check_numbers(std::span<const double> values);
  void narrow(std::span<const double> values);

  std::vector<float> singles_;
};

}  // namespace kinalign
