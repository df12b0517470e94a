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

/// Looks at the texts and ids of dataset.toml and at `names` of streams and nodes. Errors:
/// subjects' ids that read like names; texts and ids with a date, an e-mail address, a telephone
/// number or a hardware address, but in a citation and a licence the addresses alone; serial
/// numbers of devices. Warnings: free text about a person, and other ids that read like names.
/// Notes: a height or weight that one person alone has. `file`: the dataset.toml.
Findings look_for_people(const Catalogue& catalogue, const std::string& file,
                         const std::set<std::string>& names);

/// Takes names of files and marks out of a take: `kinect.csv` stands for what the device's file was
/// called. Names stand in inputs, parameters and findings. Texts by which rows of a table were
/// selected are emptied.
void hide_names(TakeHeader& header, AlignmentReport& report);

/// Moves the report's grid by as much as the rows. Stamps of each stream count from its own first
/// one: they may be on the device's clock, and would then give away by how much the rows moved.
void move_dates(Duration moved, TakeHeader& header, AlignmentReport& report);

/// A dataset.toml of what is known, without comments, keys of its own, and subjects that `used`
/// does not have.
std::string released_catalogue(const Catalogue& catalogue, const std::set<std::string>& used);

}  // namespace kinalign
