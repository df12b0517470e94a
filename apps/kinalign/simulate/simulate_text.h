// SPDX-License-Identifier: Apache-2.0
// What `simulate` says of a rehearsal: lines for people, objects for programs.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/simulate/live_rehearsal.h"

#include <optional>
#include <string>

namespace kinalign {

struct ToldRehearsal {
  const TrueRecording& truth;
  const Rehearsal& rehearsal;
  std::string folder{};
  std::optional<double> asked_s;  // of a motion that may have less
};

/// Files were written.
void tell_files(const ToldRehearsal& told, Console& console);

/// What is sent is said before it is, for the recorder to be started.
void tell_start(const ToldRehearsal& told, const LiveOptions& options, Console& console);

struct SentRehearsal {
  LiveCounts counts{};
  LiveOptions options{};
  std::string folder{};
  double length_s = 0.0, sent_s = 0.0;  // of the motion; sent_s: less where it was stopped
  bool recorded_there = false;          // the file that recording.toml names

  bool whole() const { return sent_s >= length_s; }
  /// No datagram came back, of nodes' replies, a recorder's to the Kinect, or for a mark.
  bool unanswered() const { return counts.all().heard == 0; }
};

/// Lines for people: what was sent, who was not there, what comes next. `nobody` is bad news and
/// stands by itself; empty: there is none.
struct SentText {
  std::string sent, nobody, next;
};
SentText sent_text(const SentRehearsal& sent);

void tell_end(const SentRehearsal& sent, Console& console);

}  // namespace kinalign
