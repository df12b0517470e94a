// SPDX-License-Identifier: Apache-2.0
// Other methods, re-implemented on simulated exchanges: the paper's, and the ideas of liblsl, of
// SNTP clients and of a Kalman filter, each in the form of the reference simulator in Python. They
// are not those programs themselves. All give the error of each frame that arrived, s, in the order
// of arrival; frames without a stamp are left out.
#pragma once

#include "kinalign/simulate/nodes/exchanges.h"

#include <string_view>
#include <vector>

namespace kinalign {

struct PeerErrors {
  std::vector<double> sent;   // when the frame was sent, s
  std::vector<double> error;  // s
};

struct Peer {
  std::string_view name;
  bool live;  // each stamp uses only the frames that had arrived until then
  PeerErrors (*errors)(const SimulatedExchanges& exchanges);
};

/// In the order of the table.
const std::vector<Peer>& peers();

}  // namespace kinalign
