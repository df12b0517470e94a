// SPDX-License-Identifier: Apache-2.0
// What stands in a take, column by column, for every file format that carries one: the names,
// shapes, units and spaces of docs/formats/take.md, said once.
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

/// A skeleton's end sites as they are stored.
struct EndSiteArrays {
  std::vector<int> parents;   // [E]
  std::vector<Vec3> offsets;  // [E] m
};
EndSiteArrays end_site_arrays(const Skeleton& skeleton);

/// How numbers are stored; computed are they in double.
enum class Precision { single, full };
inline Precision precision_of(const TakeHeader& header) {
  return header.parameters.align.store_double ? Precision::full : Precision::single;
}

enum class Stored : std::uint8_t { float32, float64, int64, int32, uint8 };

/// Bytes of one value.
std::size_t size_of(Stored stored);
inline Stored stored_number(Precision precision) {
  return precision == Precision::single ? Stored::float32 : Stored::float64;
}

/// One array of a stream with a value, vector or rotation in every row.
struct TakeColumn {
  std::string name;                  // "positions"
  Stored stored = Stored::float32;   // as it stands in the file
  std::vector<std::uint64_t> shape;  // of one row: {59, 3}; {}: one value a row
  std::vector<std::pair<std::string, std::string>> facts;  // units, space, order

  std::uint64_t row_values() const;
  std::uint64_t row_bytes() const { return row_values() * size_of(stored); }
};

/// "clip", "points", "imu".
std::string_view kind_of(const TakeGroup& group);

/// What a take says of a node: gravity stands in its acceleration, or not.
constexpr const char* gravity_included = "included";
constexpr const char* gravity_removed = "removed";
std::vector<std::string> gravity_texts(const ImuGroup& group);  // [S]

/// The columns that a group's rows fill, in the order of for_each_row_array.
std::vector<TakeColumn> columns_of(const TakeGroup& group, Precision precision);

/// Joints or nodes.
const std::vector<std::string>& names_of(const TakeGroup& group);
/// What each number of a column's row is: "Hips.x"; "row" where there is one a row.
std::vector<std::string> labels_of(const TakeColumn& column, const TakeGroup& group);
/// The group without its samples, as JSON: name, kind, names; of a skeleton parents, rest_offsets
/// and end_sites; of nodes root_node and gravity.
std::string stream_json(const TakeGroup& group);

/// Fails where a take of this header could not be told from another or not be read again: group
/// and joint names that repeat, are empty, or hold '/' or NUL; a skeleton out of order.
Result<void> validate(const TakeHeader& header);

using AnyRows = std::variant<ClipRows, PointRows, ImuRows>;

/// Empty rows of the group's kind.
AnyRows rows_for(const TakeGroup& group);

/// Calls use(name, array) -> Result<void> for each array of rows (a variant's member, const or
/// not), in the order of columns_of; also for the arrays that this stream leaves empty.
template <class Rows, class Use>
Result<void> for_each_row_array(Rows& rows, Use&& use) {
  Result<void> done;
  for_each_column<std::remove_const_t<Rows>>([&](std::string_view name, auto of) {
    if (done) done = use(name, of(rows));
  });
  return done;
}

/// The bytes of an array as they lie in memory, which is how files hold them.
template <class Value>
std::string_view bytes_of(std::span<const Value> values) {
  static_assert(std::endian::native == std::endian::little && sizeof(Time) == 8);
  static_assert(std::is_trivially_copyable_v<Value>);
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Numbers on their way into a file: a piece at a time, small enough to stay in the cache
/// between being made and being copied by the system, large enough for the system to like.
class NumberStore {
 public:
  NumberStore() : singles_(piece) {}

  /// Calls put(bytes) -> Result<void> with all of `values` as `stored` holds them.
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
  static constexpr std::size_t piece = 128 * 1024;  // values: 0.5 MiB of floats, measured best
  static void check_numbers(std::span<const double> values);
  void narrow(std::span<const double> values);

  std::vector<float> singles_;
};

}  // namespace kinalign
