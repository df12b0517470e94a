// SPDX-License-Identifier: Apache-2.0
// Names in a ZIP's list of contents (APPNOTE 6.3.10, 4.3.12): libarchive ends a name at a NUL, so
// that two readers would see two names.
#pragma once

#include "kinalign/formats/archive/archive.h"

namespace kinalign {

/// Fails with the entry's name where one has a NUL. Passes where the list can't be found: reading
/// says what is wrong with such a file.
Result<void> check_zip_names(const ArchiveBytes& bytes);

}  // namespace kinalign
