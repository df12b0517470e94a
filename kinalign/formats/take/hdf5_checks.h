// SPDX-License-Identifier: Apache-2.0
// Reads an HDF5 file that may be hostile. A data set must have the expected type and shape, and
// must be stored in one piece, uncompressed, inside the file. Memory is allocated only after these
// checks. The checks also exclude filters, plug-ins and links to other files.
#pragma once

#include "kinalign/formats/take/hdf5_file.h"
#include "kinalign/formats/take/take_layout.h"
#include "kinalign/take/recording.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign::hdf5 {

/// Values at a known position in the file, row after row. `at` is a byte position. The rows are
/// read from there without HDF5, so HDF5's code never handles them.
struct Source {
  Stored stored = Stored::uint8;
  std::uint64_t at = 0;
  /// The number of values in one row.
  std::uint64_t row_values = 1;
};

/// True if the group contains an object with this name. A link to another file does not count.
bool has(Id group, const char* name);

/// The type in HDF5 that corresponds to `stored`.
Id type_of(Stored stored);

/// Reads rows without conversion, or converts floats to doubles.
Result<void> read_rows(const Bytes& bytes, const Source& source, std::uint64_t first,
                       std::uint64_t count, void* to);
Result<void> read_rows(const Bytes& bytes, const Source& source, std::uint64_t first,
                       std::uint64_t count, double* to);

template <class Value>
constexpr Stored stored_as() {
  if constexpr (std::is_same_v<Value, double>) return Stored::float64;
  if constexpr (std::is_same_v<Value, std::int64_t>) return Stored::int64;
  if constexpr (std::is_same_v<Value, int>) return Stored::int32;
  return Stored::uint8;
}

/// Every function checks an array before it reads the array. An error names the array and the file.
class Checked {
 public:
  explicit Checked(const Bytes& bytes) : bytes_(bytes) {}
  const Bytes& bytes() const { return bytes_; }

  /// The length of a data set's first dimension.
  Result<std::uint64_t> rows(Id group, const char* name) const;
  /// The position of a data set. Its type and its `sizes` are checked first.
  Result<Source> find(Id group, const char* name, Stored stored,
                      const std::vector<std::uint64_t>& sizes) const;

  /// All values of an array. `sizes` are the expected lengths, so the amount of memory is known in
  /// advance.
  template <class Value>
  Result<std::vector<Value>> all(Id group, const char* name,
                                 const std::vector<std::uint64_t>& sizes) const {
    const Source source = KA_TRY(find(group, name, stored_as<Value>(), sizes));
    std::vector<Value> values(sizes.front() * source.row_values);
    KA_TRY(read_rows(bytes_, source, 0, sizes.front(), values.data()));
    return values;
  }

  /// A single text, or a list of texts.
  Result<std::string> text(Id group, const char* name) const;
  Result<std::vector<std::string>> texts(Id group, const char* name) const;
  Result<std::string> text_attribute(Id object, const char* name) const;
  Result<std::vector<std::string>> text_attributes(Id object, const char* name) const;
  /// Facts about the files from which a stream was made.
  Result<std::vector<InputFacts>> inputs(Id group) const;

 private:
  struct Place;
  Result<Place> place(Id group, const char* name) const;
  Result<std::string> packed_texts(Id group, const char* name, std::uint64_t rank,
                                   std::size_t& width) const;
  Failure other(const char* name, const std::string& expected, const std::string& found) const;

  const Bytes& bytes_;
};

}  // namespace kinalign::hdf5
