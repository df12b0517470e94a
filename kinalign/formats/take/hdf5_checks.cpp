// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/hdf5_checks.h"

#include <hdf5.h>

#include <algorithm>

namespace kinalign::hdf5 {

namespace {

/// The sizes as a text, for example "[100,59,3]".
std::string written(const std::vector<std::uint64_t>& sizes) {
  std::string out = "[";
  for (const std::uint64_t size : sizes) out += (out.size() > 1 ? "," : "") + std::to_string(size);
  return out + "]";
}

/// The lengths of a data space with at most four dimensions. The result is empty for any other data
/// space.
std::optional<std::vector<std::uint64_t>> sizes_of(const Handle& space) {
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0 || rank > 4) return std::nullopt;
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  if (rank > 0 && H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr) < 0) {
    return std::nullopt;
  }
  return std::vector<std::uint64_t>(sizes.begin(), sizes.end());
}

/// The number of bytes of an array; empty if the number overflows.
std::optional<std::uint64_t> product(std::uint64_t value_bytes,
                                     const std::vector<std::uint64_t>& sizes) {
  std::uint64_t bytes = value_bytes;
  for (const std::uint64_t size : sizes) {
    // After an overflow, the product of a hostile file's lengths could look small.
    if (__builtin_mul_overflow(bytes, size, &bytes)) return std::nullopt;
  }
  return bytes;
}

/// True for text of fixed length. Text of variable length is stored elsewhere in the file and is
/// not read.
bool fixed_text(const Handle& type) {
  return H5Tget_class(type.id()) == H5T_STRING && H5Tis_variable_str(type.id()) == 0 &&
         H5Tget_size(type.id()) > 0;
}

}  // namespace

/// A data set that has passed the checks of place(): the whole array is inside the file.
struct Checked::Place {
  Handle type;
  std::vector<std::uint64_t> sizes;
  std::uint64_t at = 0;
};

bool has(hid_t group, const char* name) {
  // Only hard links count, so a link to another file counts as absent.
  H5L_info_t info{};
  return H5Lexists(group, name, H5P_DEFAULT) > 0 &&
         H5Lget_info(group, name, &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD;
}

hid_t type_of(Stored stored) {
  switch (stored) {
    case Stored::float32:
      return H5T_IEEE_F32LE;
    case Stored::float64:
      return H5T_IEEE_F64LE;
    case Stored::int64:
      return H5T_STD_I64LE;
    case Stored::int32:
      return H5T_STD_I32LE;
    case Stored::uint8:
      break;
  }
  return H5T_STD_U8LE;
}

Failure Checked::other(const char* name, const std::string& expected,
                       const std::string& found) const {
  return refuse(bytes_.path(), std::string(name) + " as " + expected, found);
}

/// The type, the size and the position of a data set. Fails unless the data set is stored in one
/// piece inside the file.
Result<Checked::Place> Checked::place(hid_t group, const char* name) const {
  if (!has(group, name)) return other(name, "a data set", "none");
  // The handles close themselves, whichever way the function returns.
  const Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (!set.good()) return failure(bytes_, std::string(name) + " as a data set");
  const Handle creation(H5Dget_create_plist(set.id()), H5Pclose);
  const Handle space(H5Dget_space(set.id()), H5Sclose);
  Place out{{H5Dget_type(set.id()), H5Tclose}, {}, 0};
  if (!creation.good() || !space.good() || !out.type.good()) {
    return failure(bytes_, std::string(name) + " as a data set");
  }
  // Chunks, filters and external files can be read only by HDF5 itself.
  if (H5Pget_layout(creation.id()) != H5D_CONTIGUOUS || H5Pget_external_count(creation.id()) != 0) {
    return other(name, "an array in one piece, uncompressed (h5repack -l CONTI -f NONE makes it)",
                 "another layout");
  }
  const auto sizes = sizes_of(space);
  if (!sizes) return other(name, "an array of at most four dimensions", "another rank or no array");
  out.sizes = *sizes;
  const auto length = product(H5Tget_size(out.type.id()), out.sizes);
  if (!length) return other(name, "an array that a file can hold", "sizes " + written(out.sizes));
  // An array without values has no position.
  if (*length == 0) return out;
  out.at = H5Dget_offset(set.id());
  // The comparison avoids sums that could overflow.
  if (out.at >= bytes_.size || *length > bytes_.size - out.at) {
    return other(name, "an array inside the file", "a position beyond its end");
  }
  return out;
}

Result<std::uint64_t> Checked::rows(hid_t group, const char* name) const {
  const Place found = KA_TRY(place(group, name));
  if (found.sizes.empty()) return other(name, "an array", "one value");
  return found.sizes.front();
}

Result<Source> Checked::find(hid_t group, const char* name, Stored stored,
                             const std::vector<std::uint64_t>& sizes) const {
  const Place found = KA_TRY(place(group, name));
  // H5Tequal() also compares byte order and size.
  if (H5Tequal(found.type.id(), type_of(stored)) <= 0) {
    return other(name, "numbers of " + std::to_string(size_of(stored)) + " bytes", "another type");
  }
  // The header determines all lengths, so the lengths in the file must be equal.
  if (found.sizes != sizes) return other(name, written(sizes), written(found.sizes));
  Source source{stored, found.at, 1};
  for (std::size_t i = 1; i < sizes.size(); ++i) source.row_values *= sizes[i];
  return source;
}

Result<std::string> Checked::packed_texts(hid_t group, const char* name, std::uint64_t rank,
                                          std::size_t& width) const {
  const Place found = KA_TRY(place(group, name));
  if (!fixed_text(found.type)) return other(name, "text of fixed length", "another type");
  if (found.sizes.size() != rank) {
    return other(name, rank == 0 ? "one text" : "a list of texts", written(found.sizes));
  }
  width = H5Tget_size(found.type.id());
  // place() has checked that so many bytes exist.
  std::string packed(*product(width, found.sizes), '\0');
  const Source source{Stored::uint8, found.at, 1};
  KA_TRY(read_rows(bytes_, source, 0, packed.size(), static_cast<void*>(packed.data())));
  return packed;
}

Result<std::string> Checked::text(hid_t group, const char* name) const {
  std::size_t width = 0;
  const std::string packed = KA_TRY(packed_texts(group, name, 0, width));
  // The text ends at the first NUL, because texts are padded with NUL characters.
  return packed.substr(0, packed.find('\0'));
}

Result<std::vector<std::string>> Checked::texts(hid_t group, const char* name) const {
  std::size_t width = 0;
  const std::string packed = KA_TRY(packed_texts(group, name, 1, width));
  return unpack(packed, width);
}

Result<std::vector<std::string>> Checked::text_attributes(hid_t object, const char* name) const {
  // An absent attribute stands for an empty list.
  if (H5Aexists(object, name) <= 0) return std::vector<std::string>{};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  const auto sizes = sizes_of(space);
  if (!type.good() || !sizes || sizes->size() > 1 || !fixed_text(type)) {
    return other(name, "an attribute of text", "something of another kind");
  }
  // An attribute is stored in the file, so it can't be larger than the file.
  const std::size_t width = H5Tget_size(type.id());
  const auto length = product(width, *sizes);
  if (!length || *length > bytes_.size) {
    return other(name, "an attribute inside the file", "a position beyond its end");
  }
  std::string packed(*length, '\0');
  if (!packed.empty() && H5Aread(attribute.id(), type.id(), packed.data()) < 0) {
    return failure(bytes_, std::string(name) + " as an attribute");
  }
  return unpack(packed, width);
}

Result<std::string> Checked::text_attribute(hid_t object, const char* name) const {
  const auto texts = KA_TRY(text_attributes(object, name));
  if (texts.size() != 1) return other(name, "an attribute of one text", "none");
  return texts.front();
}

Result<std::vector<InputFacts>> Checked::inputs(hid_t group) const {
  // Three attributes of equal length form a list of structures.
  const auto names = KA_TRY(text_attributes(group, "input_names"));
  const auto hashes = KA_TRY(text_attributes(group, "input_sha256"));
  std::vector<std::uint64_t> sizes(names.size());
  if (hashes.size() != names.size())
    return other("input_sha256", "one entry for each name", "others");
  if (!names.empty()) {
    const Handle attribute(H5Aopen(group, "input_bytes", H5P_DEFAULT), H5Aclose);
    const Handle space(H5Aget_space(attribute.id()), H5Sclose);
    const auto found = sizes_of(space);
    if (!found || *found != std::vector<std::uint64_t>{names.size()} ||
        H5Aread(attribute.id(), H5T_NATIVE_UINT64, sizes.data()) < 0) {
      return other("input_bytes", "one number for each name", "something of another kind");
    }
  }
  std::vector<InputFacts> out;
  for (std::size_t i = 0; i < names.size(); ++i) out.push_back({names[i], hashes[i], sizes[i]});
  return out;
}

// Reads only the wanted range of the file. The caller provides the memory.
Result<void> read_rows(const Bytes& bytes, const Source& source, std::uint64_t first,
                       std::uint64_t count, void* to) {
  const std::uint64_t row = source.row_values * size_of(source.stored);
  const std::span<char> room(static_cast<char*>(to), count * row);
  const std::size_t got = KA_TRY(bytes.input->read_at(source.at + first * row, room));
  if (got == room.size()) return {};
  // The file was long enough when it was opened.
  return refuse(bytes.path(), "a file that keeps its length", "a shorter file");
}

// This is a separate function, so that the compiler makes vector code from the loop.
static void widen(std::span<const float> from, double* to) {
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = static_cast<double>(from[i]);
}

Result<void> read_rows(const Bytes& bytes, const Source& source, std::uint64_t first,
                       std::uint64_t count, double* to) {
  // Doubles need no conversion.
  if (source.stored == Stored::float64) {
    return read_rows(bytes, source, first, count, static_cast<void*>(to));
  }
  // The rows are read in pieces that stay in the cache until they are converted.
  constexpr std::uint64_t piece_bytes = std::uint64_t{256} << 10;
  const std::uint64_t row_bytes = source.row_values * sizeof(float);
  const std::uint64_t piece =
      std::max<std::uint64_t>(1, piece_bytes / std::max<std::uint64_t>(1, row_bytes));
  std::vector<float> singles(std::min(piece, count) * source.row_values);
  for (std::uint64_t row = 0; row < count; row += piece) {
    const std::uint64_t rows = std::min(piece, count - row);
    KA_TRY(read_rows(bytes, source, first + row, rows, static_cast<void*>(singles.data())));
    widen({singles.data(), rows * source.row_values}, to + row * source.row_values);
  }
  return {};
}

}  // namespace kinalign::hdf5
