// SPDX-License-Identifier: Apache-2.0
// Checks the names in a ZIP's central directory (APPNOTE 6.3.10, 4.3.12). libarchive ends a name at
// a NUL, so two readers would see two different names.
#pragma once

#include "kinalign/formats/archive/archive.h"

namespace kinalign {

/// Fails, with the entry's name, if a name has a NUL. Passes if the directory can't be found:
/// reading then reports the fault of such a file.
Result<void> check_zip_names(const ArchiveBytes& bytes);

}  // namespace kinalign
