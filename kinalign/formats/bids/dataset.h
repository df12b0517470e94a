// SPDX-License-Identifier: Apache-2.0
// Writes the files that describe a whole BIDS data set: its description, its participants, and the
// start time of each file.
#pragma once

#include "kinalign/formats/bids/tsv_table.h"
#include "kinalign/wire/time.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// Facts about a data set. Optional texts that are empty are not written.
struct BidsDataset {
  std::string name, license;
  std::vector<std::string> authors;
  /// The program that made a derivative (an aligned or cleaned data set); empty for raw data.
  std::string generated_by, generated_by_version;
  std::string how_to_acknowledge{};  // the publication to cite
};

/// The text of dataset_description.json.
std::string dataset_description_json(const BidsDataset& dataset);

/// A column of participants.tsv, except participant_id.
struct BidsColumn {
  std::string name, description, units;
  std::map<std::string, std::string> levels;  // values and their meanings
};

/// The participants. Each row has a cell for each column. A missing cell becomes n/a.
struct BidsParticipants {
  std::vector<BidsColumn> columns;
  std::vector<std::pair<std::string, std::vector<std::string>>> rows;  // subject's label, cells
};
std::string participants_tsv(const BidsParticipants& participants);
std::string participants_json(const BidsParticipants& participants);

/// A row of scans.tsv: the path of a file below the folder of the subject or session, and its
/// start. An unknown start becomes n/a. Latencies count from the start (acq_time), so a reader
/// computes stamps from both.
using BidsScan = std::pair<std::string, std::optional<Time>>;
std::string scans_tsv(const std::vector<BidsScan>& scans);

}  // namespace kinalign
