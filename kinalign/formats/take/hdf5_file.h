// SPDX-License-Identifier: Apache-2.0
// Wraps HDF5's C API: handles that close themselves, failures as errors, and a file driver of our
// own, so that every byte goes through core's files. A failed write is kept and reported to HDF5 as
// successful, because HDF5 1.10 can't close a file that it could not write.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign::hdf5 {

// Aliases of HDF5's types, so that <hdf5.h> stays in .cpp files; hdf5_file.cpp checks them.
using Id = std::int64_t;          // hid_t
using Size = unsigned long long;  // hsize_t

/// Owns one of HDF5's identifiers.
/// `close` is the function of HDF5 for this kind of identifier. reset() reports whether closing
/// succeeded.
class Handle {
 public:
  using Close = int (*)(Id);
  Handle() = default;
  Handle(Id id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  Id id() const { return id_; }
  bool good() const { return id_ >= 0; }
  bool reset() { return !good() || close_(std::exchange(id_, -1)) >= 0; }

 private:
  Id id_ = -1;
  Close close_ = nullptr;
};

/// The file below HDF5: `input` or `output` is set. Must not move while HDF5 has the file open.
/// HDF5 gets a pointer to it (access_to()).
struct Bytes {
  InputFile* input = nullptr;
  OutputFile* output = nullptr;
  std::uint64_t size = 0;
  std::optional<Error> failure;  // the first failure that HDF5 does not know of

  std::string path() const { return input != nullptr ? input->path() : output->path(); }
  Result<void> write(std::uint64_t at, std::string_view bytes);
};

/// Creates an empty file in a version that old HDF5 and MATLAB can read.
Result<Handle> create(Bytes& bytes);
/// Opens a file for reading only. Loads no plug-in that the file might ask for.
Result<Handle> open(Bytes& bytes);
/// The error "expected `expected`, found (HDF5's message about its last failure)".
/// `expected` names the object that could not be read or made.
Failure failure(const Bytes& bytes, std::string expected);

/// Type and size of a data set or an attribute.
struct Shape {
  Id type = -1;             // HDF5's type
  std::vector<Size> sizes;  // empty: a scalar
};

Handle text_type(std::size_t bytes);  // fixed length, UTF-8, padded with NUL
Handle space(const std::vector<Size>& sizes);
Handle create_group(Id parent, const std::string& name);
/// Creates a contiguous data set: it has a position in the file, but no bytes yet.
Handle create_dataset(Id parent, const std::string& name, const Shape& shape);

bool put_attribute(Id object, const char* name, const Shape& shape, const void* value);
bool put_text(Id object, const char* name, std::string_view text);
bool put_texts(Id object, const char* name, const std::vector<std::string>& texts);

/// Texts padded to one length, at least one byte, one after the other.
/// HDF5 stores a list of texts of fixed length in this form.
struct PackedTexts {
  std::size_t width = 1;
  std::string bytes;
};
PackedTexts pack(const std::vector<std::string>& texts);
std::vector<std::string> unpack(std::string_view bytes, std::size_t width);

}  // namespace kinalign::hdf5
