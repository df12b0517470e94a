// SPDX-License-Identifier: Apache-2.0
// What to say of a file that no reader of ours knows.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <string_view>

namespace kinalign {

/// A take begins as every HDF5 file does.
bool looks_like_hdf5(std::string_view head);

/// A model begins as every SafeTensors file does (docs/formats/model.md).
bool looks_like_model(std::string_view head);

/// How a file begins, for messages: "an empty file", "a gzip archive", "'unix_ms,acc_x'" or, where
/// the bytes are no text, that alone.
std::string beginning_of(std::string_view head);

/// A file of which `head` are the first bytes; says what to do with a table.
Error unknown_file(const std::string& path, std::string_view head);

}  // namespace kinalign
