// SPDX-License-Identifier: Apache-2.0
// Names and paths of files in a BIDS-Motion data set, and times in the form of scans.tsv. Layout:
// docs/formats/bids.md.
#pragma once

#include "kinalign/wire/time.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// True if the text consists of one or more letters and digits.
bool is_bids_label(std::string_view text);

/// The labels in the file names of a tracking system. An empty run does not appear in names.
struct BidsEntities {
  std::string subject, task, system, run;
};

/// The folder of a subject, for example "sub-01/".
std::string bids_subject_folder(const BidsEntities& entities);
/// The path of a file. For the ending "motion.tsv" it is, for example,
/// "sub-01/motion/sub-01_task-walk_tracksys-kinect_run-2_motion.tsv".
std::string bids_path(const BidsEntities& entities, std::string_view ending);
/// The path of a scans.tsv, for example "sub-01/sub-01_scans.tsv".
std::string bids_scans_path(const BidsEntities& entities);

/// The parts of a file name: sub-01_task-walk_motion.tsv has the entities sub and task, and the
/// ending motion.tsv. Parsing gives an empty result if a part does not have the form key-label.
struct BidsName {
  std::vector<std::pair<std::string, std::string>> entities;  // in the order of the name
  std::string ending;

  /// The label of an entity; empty if the name does not have this entity.
  std::string_view label(std::string_view key) const;
};
std::optional<BidsName> parse_bids_name(std::string_view file_name);

/// The time as a text, for example "2026-11-26T10:22:50.000001Z". Fractions of a microsecond are
/// cut off.
std::string acq_time_text(Time time);
/// Reads YYYY-MM-DDThh:mm:ss, optionally with fractions and a Z. A time without Z is read as UTC.
/// The result is empty if the text has another form, or if the year is not within 1850 to 2090.
std::optional<Time> parse_acq_time(std::string_view text);
/// True if the text has this form, with any year.
bool is_acq_time(std::string_view text);

}  // namespace kinalign
