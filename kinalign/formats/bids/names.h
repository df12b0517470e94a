// SPDX-License-Identifier: Apache-2.0
// Names and paths of files in a BIDS-Motion data set, and times in the notation of scans.tsv.
// Layout: docs/formats/bids.md.
#pragma once

#include "kinalign/wire/time.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// True for one or more letters and digits.
bool is_bids_label(std::string_view text);

/// Labels in the file names of a tracking system. An empty run is left out of names.
struct BidsEntities {
  std::string subject, task, system, run;
};

/// "sub-01/"
std::string bids_subject_folder(const BidsEntities& entities);
/// For the ending "motion.tsv":
/// "sub-01/motion/sub-01_task-walk_tracksys-kinect_run-2_motion.tsv".
std::string bids_path(const BidsEntities& entities, std::string_view ending);
/// "sub-01/sub-01_scans.tsv"
std::string bids_scans_path(const BidsEntities& entities);

/// The parts of a file name: sub-01_task-walk_motion.tsv has the entities sub and task and the
/// ending motion.tsv. Parsing gives nothing if a part is not of the form key-label.
struct BidsName {
  std::vector<std::pair<std::string, std::string>> entities;  // in the order of the name
  std::string ending;

  /// The label of an entity; empty if the name has no such entity.
  std::string_view label(std::string_view key) const;
};
std::optional<BidsName> parse_bids_name(std::string_view file_name);

/// "2026-11-26T10:22:50.000001Z"; fractions of a microsecond are cut off.
std::string acq_time_text(Time time);
/// Reads YYYY-MM-DDThh:mm:ss, optionally with fractions and a Z. A time without Z is taken as UTC.
/// Empty if the text is no such time, or if its year is not within 1850 to 2090.
std::optional<Time> parse_acq_time(std::string_view text);
/// True for a time in that notation, of any year.
bool is_acq_time(std::string_view text);

}  // namespace kinalign
