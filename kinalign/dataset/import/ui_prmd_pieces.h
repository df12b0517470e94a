// SPDX-License-Identifier: Apache-2.0
// Unpacks UI-PRMD, an NPZ for each person, to the texts of its source. Layout:
// docs/dataset_import.md.
#pragma once

#include "kinalign/dataset/import/new_folder.h"
#include "kinalign/formats/archive/archive.h"

#include <string>

namespace kinalign {

/// Writes three text files for each repetition: Kinect/Positions/m01_s01_e01_positions.txt,
/// Kinect/Angles/m01_s01_e01_angles.txt and Vicon/Positions/m01_s01_e01_positions.txt. `person`:
/// "s01". The pack has markers at 50 Hz, every second row of the source.
Result<void> write_ui_prmd_pieces(const ArchiveBytes& bytes, const std::string& person,
                                  const PutFile& put);

}  // namespace kinalign
