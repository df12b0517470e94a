// SPDX-License-Identifier: Apache-2.0
// The text of `simulate` about a rehearsal: lines for people, objects for programs.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/simulate/live_rehearsal.h"

#include <optional>
#include <string>

namespace kinalign {

/// The references must live as long as the summary.
struct RehearsalSummary {
  const TrueRecording& truth;
  const Rehearsal& rehearsal;
  std::string folder{};
  std::optional<double> asked_s;  // --seconds; the motion may be shorter
};

/// Reports the written files.
void print_files(const RehearsalSummary& summary, Console& console);

/// Reports the rehearsal before it is sent, so that the recorder can be started.
void print_start(const RehearsalSummary& summary, const LiveOptions& options, Console& console);

/// The end of a live rehearsal. The exit code of the verb depends on whole() and unanswered().
struct SentRehearsal {
  LiveCounts counts{};
  LiveOptions options{};
  std::string folder{};
  double length_s = 0.0, sent_s = 0.0;  // the motion's; sent_s is less if it was stopped
  bool recorded_there = false;          // the file that recording.toml names exists

  bool whole() const { return sent_s >= length_s; }
  /// No datagram came back: no reply to a node or to the Kinect, no answer to a mark.
  bool unanswered() const { return counts.all().received == 0; }
};

/// The lines for people: what was sent, ports without a receiver, the next step. `no_reply` is
/// printed as a warning; it may be empty.
struct SentText {
  std::string sent, no_reply, next;
};
SentText sent_text(const SentRehearsal& sent);

void print_end(const SentRehearsal& sent, Console& console);

}  // namespace kinalign
