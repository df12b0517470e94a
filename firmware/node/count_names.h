// SPDX-License-Identifier: Apache-2.0
// The names of the counts, in one order for all writers: calls use(name, number) for each.
#pragma once

#include "firmware/node/clockless_node.h"
#include "firmware/node/node.h"

namespace kinalign {

template <class Answers, class Use>
void each_answer_count(Answers& counts, Use use) {
  use("accepted", counts.accepted);
  for (std::size_t i = 1; i < node_refusals; ++i) {
    use(refusal_name(static_cast<NodeRefusal>(i)), counts.refused[i]);
  }
  use("other_node", counts.other_node);
  use("other_boot", counts.other_boot);
  use("unknown_frame", counts.unknown_frame);
  use("not_newer", counts.not_newer);
}

/// Names all counts of a NodeTally, const or not.
template <class Counts, class Use>
void each_node_count(Counts& counts, Use use) {
  use("ticks", counts.samples.ticks);
  use("taken", counts.samples.taken);
  use("missed", counts.samples.missed);
  use("sensor_fails", counts.samples.sensor_fails);
  use("dropped", counts.samples.dropped);
  use("sent", counts.frames.sent);
  use("send_fails", counts.frames.send_fails);
  use("late", counts.frames.late);
  use("samples_sent", counts.frames.samples_sent);
  use("unstampable", counts.frames.unstampable);
  each_answer_count(counts.replies, use);
}

/// Names all counts of a ClocklessCounts, const or not.
template <class Counts, class Use>
void each_clockless_count(Counts& counts, Use use) {
  use("requests", counts.requests);
  use("request_fails", counts.request_fails);
  use("missed", counts.missed);
  use("sensor_fails", counts.sensor_fails);
  use("confirms", counts.confirms);
  use("confirm_fails", counts.confirm_fails);
  each_answer_count(counts.answers, use);
}

}  // namespace kinalign
