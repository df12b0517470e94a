// SPDX-License-Identifier: Apache-2.0
// Texts and stamps of a data set by which strangers could know a person.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/take/report.h"
#include "kinalign/take/take.h"

#include <set>
#include <string>

namespace kinalign {

/// Looks at the texts of dataset.toml and at `names` of streams and nodes. Errors: ids that read
/// like names; texts with a date, an e-mail address, a telephone number or a hardware address;
/// serial numbers of devices. Warnings: free text about a person. Notes: a height or weight that
/// one person alone has. `file`: the dataset.toml.
Findings look_for_people(const Catalogue& catalogue, const std::string& file,
                         const std::set<std::string>& names);

/// Takes names of files and marks out of a take: `kinect.csv` stands for what the device's file was
/// called. Names stand in inputs, parameters and findings.
void hide_names(TakeHeader& header, AlignmentReport& report);

/// Moves all stamps that parameters and report have by as much as the rows.
void move_dates(Duration moved, TakeHeader& header, AlignmentReport& report);

/// A dataset.toml of what is known, without comments, keys of its own, and subjects that `used`
/// does not have.
std::string released_catalogue(const Catalogue& catalogue, const std::set<std::string>& used);

}  // namespace kinalign
