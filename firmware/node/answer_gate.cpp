// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/answer_gate.h"

namespace kinalign {

DatagramOrigin AnswerGate::issue() {
  const DatagramOrigin origin = next_;
  ++next_.sequence;
  if (open_ < window) ++open_;
  if (sent_ < window) ++sent_;
  return origin;
}

bool AnswerGate::admit(const DatagramOrigin& answered) {
  if (answered.node_id != next_.node_id) return ignore(counts_.other_node);
  if (answered.boot_id != next_.boot_id) return ignore(counts_.other_boot);
  // 1: the last frame; the difference wraps with the numbers.
  const std::uint32_t back = next_.sequence - answered.sequence;
  if (back == 0 || back > sent_) return ignore(counts_.unknown_frame);
  if (back > open_) return ignore(counts_.not_newer);
  open_ = back - 1;
  ++counts_.accepted;
  return true;
}

}  // namespace kinalign
