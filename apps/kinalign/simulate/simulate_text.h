// SPDX-License-Identifier: Apache-2.0
// Texts of `simulate` about a rehearsal (a simulated recording session): lines for people, JSON
// objects for programs.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/simulate/live_rehearsal.h"

#include <optional>
#include <string>

namespace kinalign {

/// The facts about a rehearsal that are printed. The references must live as long as the summary.
struct RehearsalSummary {
  const TrueRecording& truth;
  const Rehearsal& rehearsal;
  std::string folder{};
  std::optional<double> asked_s;  // the value of --seconds; the motion may be shorter
};

/// Prints the report about the written files.
void print_files(const RehearsalSummary& summary, Console& console);

/// Prints the report before the sending begins, so that the user can start the recorder.
void print_start(const RehearsalSummary& summary, const LiveOptions& options, Console& console);

/// The result of a live rehearsal. The verb's exit code depends on whole() and unanswered().
struct SentRehearsal {
  LiveCounts counts{};
  LiveOptions options{};
  std::string folder{};
  double length_s = 0.0, sent_s = 0.0;  // length of the motion, and of the part that was sent
  bool recorded_there = false;          // true: the file that recording.toml names exists

  bool whole() const { return sent_s >= length_s; }
  /// True if no datagram came back: no reply to a node or the Kinect, no answer to a mark.
  bool unanswered() const { return counts.all().received == 0; }
};

/// The lines for people about a live rehearsal: what was sent, which ports refused datagrams, the
/// next step. `no_reply` is printed as a warning and may be empty.
struct SentText {
  std::string sent, no_reply, next;
};
SentText sent_text(const SentRehearsal& sent);

void print_end(const SentRehearsal& sent, Console& console);

}  // namespace kinalign
