// SPDX-License-Identifier: Apache-2.0
// Error messages for a file that no reader recognises.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <string_view>

namespace kinalign {

/// True if the file begins with the HDF5 signature. Takes are HDF5 files.
bool looks_like_hdf5(std::string_view head);

/// True if the file begins like a SafeTensors file. Models are SafeTensors files
/// (docs/formats/model.md).
bool looks_like_model(std::string_view head);

/// Describes the beginning of a file for messages, for example "an empty file", "a gzip archive",
/// "'unix_ms,acc_x'", or "bytes that are no plain text".
std::string beginning_of(std::string_view head);

/// The error for an unknown file that begins with `head`. The message explains how to read a table.
Error unknown_file(const std::string& path, std::string_view head);

}  // namespace kinalign
