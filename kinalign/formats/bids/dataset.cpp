// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/dataset.h"

#include "kinalign/formats/bids/json_text.h"
#include "kinalign/formats/bids/names.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string dataset_description_json(const BidsDataset& dataset) {
  Json out;
  out["Name"] = dataset.name;
  out["BIDSVersion"] = "1.9.0";  // the first version with motion
  out["DatasetType"] = dataset.generated_by.empty() ? "raw" : "derivative";
  if (!dataset.license.empty()) out["License"] = dataset.license;
  if (!dataset.authors.empty()) out["Authors"] = dataset.authors;
  if (!dataset.how_to_acknowledge.empty()) out["HowToAcknowledge"] = dataset.how_to_acknowledge;
  if (!dataset.generated_by.empty()) {
    Json program = {{"Name", dataset.generated_by}};
    if (!dataset.generated_by_version.empty()) program["Version"] = dataset.generated_by_version;
    // GeneratedBy is a list, because several programs may have processed a data set.
    out["GeneratedBy"] = Json::array({program});
  }
  return bids_json_text(out);
}

std::string participants_tsv(const BidsParticipants& participants) {
  // The cells in BidsParticipants do not include participant_id.
  TsvTable table{{"participant_id"}, {}};
  for (const BidsColumn& column : participants.columns) table.columns.push_back(column.name);
  for (const auto& [subject, cells] : participants.rows) {
    table.rows.push_back({"sub-" + subject});
    for (std::size_t c = 0; c < participants.columns.size(); ++c) {
      table.rows.back().push_back(c < cells.size() ? cells[c] : "");
    }
  }
  return write_tsv(table);
}

std::string participants_json(const BidsParticipants& participants) {
  Json out = Json::object();
  out["participant_id"] = {{"Description", "the label of the participant's folder"}};
  for (const BidsColumn& column : participants.columns) {
    Json& one = out[column.name];
    one["Description"] = column.description;
    if (!column.units.empty()) one["Units"] = column.units;
    for (const auto& [value, meaning] : column.levels) one["Levels"][value] = meaning;
  }
  return bids_json_text(out);
}

std::string scans_tsv(const std::vector<BidsScan>& scans) {
  TsvTable table{{"filename", "acq_time"}, {}};
  for (const auto& [path, onset] : scans) {
    table.rows.push_back({path, onset ? acq_time_text(*onset) : "n/a"});
  }
  return write_tsv(table);
}

}  // namespace kinalign
