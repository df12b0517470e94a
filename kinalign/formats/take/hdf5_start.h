// SPDX-License-Identifier: Apache-2.0
// What a file's first bytes say of HDF5, read without HDF5 (its File Format Specification, III.A).
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <string_view>

namespace kinalign::hdf5 {

/// First bytes that show a superblock of any version with its addresses.
constexpr std::size_t start_bytes = 128;

/// Fails where a file of `size` bytes that begins with `head` is no HDF5 ("found 'HIERARCHY'"), or
/// one that states to be longer.
Result<void> check_start(const std::string& path, std::string_view head, std::uint64_t size);

}  // namespace kinalign::hdf5
