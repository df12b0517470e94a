// SPDX-License-Identifier: Apache-2.0
// The content of a data set's page as plain data. kinalign/dataset/report fills it; dataset_html.h
// makes the page.
#pragma once

#include "kinalign/view/page/take_page.h"
#include "kinalign/view/table.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A row of the page's table. The page sorts and filters rows by these values.
struct DatasetTake {
  std::string name, subject, class_id, action, action_name;
  std::string verdict, reason;  // "usable"; the most severe finding
  std::uint64_t frames = 0;
  double seconds = 0.0;
  bool has_mocap = false, has_kinect = false, has_imu = false;
  std::optional<double> residual_cm;
  std::optional<double> kinect_valid, imu_valid;  // shares of valid samples, for the worst stream
  std::string page;                               // relative link to the take's page, or empty
  std::vector<PageBody> bodies;                   // one row of each body, K = 1; empty: no picture
};

/// The counts are those of the whole data set; the table may contain only its worst takes.
struct DatasetPage {
  std::string name, licence, contact, description, citation, software;
  std::uint64_t people = 0, takes = 0;
  // Counted as in the HFUT-MMD paper.
  std::uint64_t mocap_frames = 0, kinect_frames = 0, imu_frames = 0;
  std::uint64_t good = 0, usable = 0, bad = 0;
  std::uint64_t not_built = 0;  // manifests without a take
  double seconds = 0.0;
  std::string folder;                    // text as given by the user, for commands
  std::vector<Table> tables;             // tables 6 and 7 of the HFUT-MMD paper, pairs and triples
  std::vector<DatasetTake> worst;        // takes in the table, the worst first
  std::uint64_t takes_without_page = 0;  // takes in the table that have no page
};

}  // namespace kinalign
