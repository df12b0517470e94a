// SPDX-License-Identifier: Apache-2.0
// Error messages for a file that none of our readers knows.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <string_view>

namespace kinalign {

/// True if the file begins with the HDF5 signature; takes are HDF5 files.
bool looks_like_hdf5(std::string_view head);

/// True if the file begins as a SafeTensors file does; models are such files
/// (docs/formats/model.md).
bool looks_like_model(std::string_view head);

/// Short description of a file's beginning for messages: "an empty file", "a gzip archive",
/// "'unix_ms,acc_x'", or that the bytes are no text.
std::string beginning_of(std::string_view head);

/// The error for an unknown file whose first bytes are `head`. It tells the user how to read a
/// table.
Error unknown_file(const std::string& path, std::string_view head);

}  // namespace kinalign
