// SPDX-License-Identifier: Apache-2.0
// Names and places of files in a BIDS-Motion data set, and times as scans.tsv writes them. Layout:
// docs/formats/bids.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/wire/time.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// Letters and digits, one or more.
bool is_bids_label(std::string_view text);

/// What a tracking system's files are called by; session, acquisition and run may be empty.
struct BidsEntities {
  std::string subject, session, task, system, acquisition, run;
};

/// Fails where a label isn't made of letters and digits, or a run of digits.
Result<void> check_labels(const BidsEntities& entities);

/// "sub-01_ses-a_task-walk_tracksys-kinect_run-2"
std::string bids_stem(const BidsEntities& entities);
/// "sub-01/ses-a/"
std::string bids_subject_folder(const BidsEntities& entities);
/// "sub-01/ses-a/motion/sub-01_ses-a_task-walk_tracksys-kinect_run-2_motion.tsv": ending is
/// "motion.tsv".
std::string bids_path(const BidsEntities& entities, std::string_view ending);
/// "sub-01/ses-a/sub-01_ses-a_scans.tsv"
std::string bids_scans_path(const BidsEntities& entities);

/// A file's name taken apart: sub-01_task-walk_motion.tsv has sub and task, and the ending
/// motion.tsv. Empty where a part is no key-label.
struct BidsName {
  std::vector<std::pair<std::string, std::string>> entities;  // in the order of the name
  std::string ending;

  /// Empty where the name has no such entity.
  std::string_view label(std::string_view key) const;
};
std::optional<BidsName> parse_bids_name(std::string_view file_name);

/// "2026-11-26T10:22:50.000001Z"; what is below a microsecond is cut off.
std::string acq_time_text(Time time);
/// Reads YYYY-MM-DDThh:mm:ss, with fractions and Z or without; without Z it is taken for UTC. Empty
/// where it is none, or outside 1850 to 2090.
std::optional<Time> parse_acq_time(std::string_view text);
/// The same of any year, without the value.
bool is_acq_time(std::string_view text);

}  // namespace kinalign
