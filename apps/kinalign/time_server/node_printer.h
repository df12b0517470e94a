// SPDX-License-Identifier: Apache-2.0
// Prints what happens at the nodes' port while the time server runs. If the file of the lab key is
// replaced, the server takes the new key.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/text/clock_event_lines.h"

#include "kinalign/capture/nodes/node_receiver.h"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace kinalign {

/// The key of a lab and its file. Both are empty if the nodes have no keys.
struct LabKeyFile {
  std::string path;
  std::optional<LabKey> key;
};

/// Prints a message with date and time on stderr, since the server may run for days.
void print_live(Console& console, std::string_view what);

/// Prints events of the nodes' port. It lives as long as the server and is called from the server's
/// only thread. Each fault and event is printed once, so that a log of many days stays readable.
/// Printing never waits for the program that reads the output.
class NodePrinter {
 public:
  /// `lab`: the key that `receiver` uses now, and its file.
  NodePrinter(NodeReceiver& receiver, Console& console, FileSystem& files, LabKeyFile lab)
      : receiver_(receiver), console_(console), files_(files), lab_(std::move(lab)) {}

  /// The server calls it several times a second. Returns a short status: "3 nodes, 2 locked".
  std::string operator()();
  /// Prints the state of every node at the end; called when the server has stopped.
  void print_end();

 private:
  using Clock = std::chrono::steady_clock;

  void print_events();
  void print_status();
  // A lab may change its key while nodes are running. The server then uses the new key without a
  // restart.
  void look_at_key();
  void print_key_trouble(const std::string& trouble);

  std::string summary_of(const NodeStatus& status) const;

  NodeReceiver& receiver_;
  Console& console_;
  FileSystem& files_;
  LabKeyFile lab_;
  ClockEventLines clock_lines_;
  std::string key_trouble_;  // the fault that was printed and still lasts
  // The time of the next status grows by whole seconds, so a late call does not delay later ones.
  Clock::time_point next_status_ = Clock::now() + std::chrono::seconds(1);
  int counts_in_s_ = 10;
};

}  // namespace kinalign
