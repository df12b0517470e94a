// SPDX-License-Identifier: Apache-2.0
// Figures 8 to 10: the page's pictures of answers to nodes, and to a Kinect and nodes.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/view/models_page/models_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// Each empty path of a model stands for the model that is shipped with the program. Models are
/// optional: without one, the figure states how to make it.
struct NodeFigureOptions {
  std::string data, split;  // the data set's folder; its split file
  std::string pose_model;   // for five nodes; empty: the shipped model
  std::string head_model;   // with a node on the head; empty: the shipped model, if there is one
  std::string fuse_model;   // for a Kinect and nodes; empty: the shipped model
};

/// Figures 8, 9 and 10 with their tables, for takes of test people that have nodes, or for all
/// takes with nodes if test people have none. A figure without data or model says so.
Result<std::vector<PosePictures>> node_figures(const NodeFigureOptions& o, Call& call);

}  // namespace kinalign
