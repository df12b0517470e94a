// SPDX-License-Identifier: Apache-2.0
// What in a data set could tell strangers who a person is.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/take/report.h"
#include "kinalign/take/take.h"

namespace kinalign {

/// Looks at the texts of dataset.toml. Errors: ids that read like names; texts with a date, an
/// e-mail address, a telephone number or a hardware address; serial numbers of devices. Warnings:
/// free text about a person. Notes: a height or weight that one person alone has. `file`: the
/// dataset.toml.
Findings look_for_people(const Catalogue& catalogue, const std::string& file);

/// Takes names of raw files, marks and findings' files out of a take: `kinect.csv` stands for what
/// the device's file was called.
void hide_names(TakeHeader& header, AlignmentReport& report);

}  // namespace kinalign
