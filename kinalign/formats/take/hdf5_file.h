// SPDX-License-Identifier: Apache-2.0
// Wraps the C functions of HDF5. Handles close themselves, and failures become errors. A file
// driver makes HDF5 read and write with the functions of kinalign/core. If a write fails, the error
// is kept and HDF5 gets no error, because HDF5 1.10 can't close a file after a failed write.
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

// Types of HDF5 under other names, so that only .cpp files include <hdf5.h>. hdf5_file.cpp checks
// that they are equal.
using Id = std::int64_t;          // HDF5's hid_t
using Size = unsigned long long;  // HDF5's hsize_t

/// Owns an identifier of HDF5. `close` is HDF5's function for this kind of identifier. reset()
/// returns true if closing succeeded.
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

/// The file that HDF5 uses. Either `input` or `output` is set. The object must not move while HDF5
/// has the file open, because HDF5 keeps a pointer to it.
struct Bytes {
  InputFile* input = nullptr;
  OutputFile* output = nullptr;
  std::uint64_t size = 0;
  std::optional<Error> failure;  // the first failure, which HDF5 did not get

  std::string path() const { return input != nullptr ? input->path() : output->path(); }
  Result<void> write(std::uint64_t at, std::string_view bytes);
};

/// Creates an empty file in a version of the format that old HDF5 and MATLAB can read.
Result<Handle> create(Bytes& bytes);
/// Opens a file for reading. Plug-ins that the file names are not loaded.
Result<Handle> open(Bytes& bytes);
/// The error "expected `expected`, found (HDF5's last message)". `expected` names the object that
/// could not be read or created.
Failure failure(const Bytes& bytes, std::string expected);

/// The type and the size of a data set or an attribute.
struct Shape {
  Id type = -1;             // HDF5's type
  std::vector<Size> sizes;  // empty: a scalar
};

Handle text_type(std::size_t bytes);  // fixed length, UTF-8, padded with NUL
Handle space(const std::vector<Size>& sizes);
Handle create_group(Id parent, const std::string& name);
/// Creates a data set in one piece. It has a position in the file, but its values are not written.
Handle create_dataset(Id parent, const std::string& name, const Shape& shape);

bool put_attribute(Id object, const char* name, const Shape& shape, const void* value);
bool put_text(Id object, const char* name, std::string_view text);
bool put_texts(Id object, const char* name, const std::vector<std::string>& texts);

/// Texts of a common length (at least one byte), one after the other. HDF5 stores a list of texts
/// in this form.
struct PackedTexts {
  std::size_t width = 1;
  std::string bytes;
};
PackedTexts pack(const std::vector<std::string>& texts);
std::vector<std::string> unpack(std::string_view bytes, std::size_t width);

}  // namespace kinalign::hdf5
