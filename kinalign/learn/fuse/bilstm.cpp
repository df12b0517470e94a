// SPDX-License-Identifier: Apache-2.0
// The bidirectional LSTM of the HFUT-MMD paper (README.md; figure 10 there). One network is trained
// for both devices, each of which is missing at times. Two more are trained for one device each.
#include "kinalign/learn/fuse/fuse_methods.h"

namespace kinalign {

namespace {

// These sizes are our choice, because the paper gives none.
constexpr std::size_t bilstm_units = 192, bilstm_width = 256;

/// The layers of the network.
Architecture bilstm_architecture(const FuseLayout& layout) {
  const Layer recurrent{.kind = LayerKind::lstm, .out = bilstm_units, .bidirectional = true};
  return {layout.channels(),
          {{.kind = LayerKind::linear, .out = bilstm_width},
           {.kind = LayerKind::relu},
           {.kind = LayerKind::dropout, .rate = 0.2},
           recurrent,
           recurrent,
           {.kind = LayerKind::linear, .out = bilstm_width},
           {.kind = LayerKind::relu},
           {.kind = LayerKind::linear, .out = layout.answers()}}};
}

}  // namespace

// Three networks for the comparison in the HFUT-MMD paper. The networks for one device show the
// accuracy of that device without shared weights.
FuseMethod bilstm_method(Devices devices) {
  FuseMethod out{.name = "bilstm",
                 .summary = "the paper's bidirectional LSTM on a Kinect and nodes",
                 .source = "HFUT-MMD, figure 10",
                 .architecture = bilstm_architecture,
                 .training = {},
                 .options = {.steps = 900, .rate = 2e-3, .rise = 0.1, .average = false}};
  // The paper mentions no augmentation, so crops are not varied.
  out.training.variety = no_variety;
  out.training.draws.devices = devices;
  if (devices == Devices::kinect) {
    out.name = "bilstm-kinect";
    out.summary = "the same on a Kinect alone";
  } else if (devices == Devices::nodes) {
    out.name = "bilstm-nodes";
    out.summary = "the same on nodes alone";
  }
  return out;
}

}  // namespace kinalign
