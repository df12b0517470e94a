// SPDX-License-Identifier: Apache-2.0
// Figures 8 to 10 of the page: pictures of answers to nodes, and to a Kinect and nodes.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/view/models_page/models_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// The options of the figures. If the path of a model is empty, the model that comes with kinalign
/// is used. If there is no such model, the figure states how to make one.
struct NodeFigureOptions {
  std::string data, split;  // the data set's folder, the file of its split
  std::string pose_model;   // model for five nodes
  std::string head_model;   // model that also has a node on the head
  std::string fuse_model;   // model for a Kinect and nodes
};

/// Makes figures 8, 9 and 10 with their tables, for takes of test people with nodes. If test people
/// have no such takes, all takes with nodes are used. A figure without data or model says so.
Result<std::vector<PosePictures>> node_figures(const NodeFigureOptions& o, Call& call);

}  // namespace kinalign
