// SPDX-License-Identifier: Apache-2.0
// Figures 8 to 10: what the page shows of answers to nodes, and to a Kinect and nodes.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/view/models_page/models_page.h"

#include <string>
#include <vector>

namespace kinalign {

struct NodeFigureOptions {
  std::string data, split;  // the data set's folder; its file of a split
  std::string pose_model;   // five nodes; empty: the shipped model
  std::string head_model;   // with a node on the head; empty: the figure says that none was given
  std::string fuse_model;   // empty: the shipped model
};

/// Figures 8, 9 and 10 with their tables, on takes of the test people that have nodes; on all takes
/// that have some where no test person has. A figure whose data or model is not there says so.
Result<std::vector<PosePictures>> node_figures(const NodeFigureOptions& o, Call& call);

}  // namespace kinalign
