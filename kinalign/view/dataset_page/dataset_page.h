// SPDX-License-Identifier: Apache-2.0
// The content of a data set's page as plain data. The room dataset/report fills it in;
// dataset_html.h makes the page.
#pragma once

#include "kinalign/view/page/take_page.h"
#include "kinalign/view/table.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A row of the page's table.
/// The page sorts and filters rows by these values.
struct DatasetTake {
  std::string name, subject, class_id, action, action_name;
  std::string verdict, reason;  // "usable"; the most severe finding in words
  std::uint64_t frames = 0;
  double seconds = 0.0;
  bool has_mocap = false, has_kinect = false, has_imu = false;
  std::optional<double> residual_cm;
  std::optional<double> kinect_valid, imu_valid;  // shares, of the worst stream
  std::string page;                               // relative link to the take's page; empty: none
  std::vector<PageBody> bodies;                   // one row of each, K = 1; empty: no picture
};

/// Counts are over the whole data set, although the table may have only its worst takes.
struct DatasetPage {
  std::string name, licence, contact, description, citation, software;
  std::uint64_t people = 0, takes = 0;
  std::uint64_t mocap_frames = 0, kinect_frames = 0, imu_frames = 0;  // counted as in the paper
  std::uint64_t good = 0, usable = 0, bad = 0;
  std::uint64_t not_built = 0;  // manifests without a take
  double seconds = 0.0;
  std::string folder;                    // the user's text, for commands
  std::vector<Table> tables;             // the paper's tables 6 and 7, pairs and triples
  std::vector<DatasetTake> worst;        // the takes in the table, worst first
  std::uint64_t takes_without_page = 0;  // among the takes in the table
};

}  // namespace kinalign
