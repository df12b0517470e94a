// SPDX-License-Identifier: Apache-2.0
// The output of a verb: results on stdout, everything else on stderr. Colour and the progress line
// appear only if wanted (docs/commands.md).
#pragma once

#include "apps/cli/outlet.h"
#include "apps/cli/verb.h"

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

enum class Colour { plain, good, warning, bad, mocap, kinect, imu };

/// The colour of a finding's severity.
constexpr Colour colour_of(Severity severity) {
  if (severity == Severity::note) return Colour::plain;
  return severity == Severity::warning ? Colour::warning : Colour::bad;
}

/// Lines below an error: the work that was not done, and the next step.
using Advice = std::function<std::vector<std::string>(const Error&)>;

/// Both outlets hold text until it is flushed. On a terminal, lines that stay at the bottom
/// (progress or table) are erased before any other line and drawn again below it; `standing_` has
/// the widths of those that are there now.
class Console {
 public:
  Console(const Surroundings& surroundings, const Common& common, std::string verb);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();

  /// Prints whole lines of the result on stdout. On a terminal, lines are broken at its width.
  /// Silent with --quiet and --json.
  void print(std::string_view text);

  /// Prints JSON for --json. `object` is the text "{...}" of a JSON object, which gets "schema":
  /// "kinalign.<verb>/<version>" as its first member. Silent without --json.
  void print_json(std::string_view object, int version = 1);
  /// Sets another name for <verb>: the schema kinalign.report is that of the report in a take.
  void name_json(std::string name) { json_name_ = std::move(name); }
  /// True if print_json() prints. Callers use it to skip making JSON every second.
  bool prints_json() const { return common_.json; }

  /// Prints text that is the result itself (a man page, a completion) on stdout, whatever the
  /// flags.
  void put(std::string_view text);

  /// Prints a line on stderr; silent with --quiet.
  void note(std::string_view line);
  /// Prints a line on stderr, only with --verbose.
  void detail(std::string_view line);
  /// Prints a line on stderr, with any flags.
  void complain(std::string_view line);

  /// The text in a colour if stdout shows colours.
  std::string paint(Colour colour, std::string_view text) const;

  /// The progress line on stderr. It is shown only on a terminal, not if --json goes to a terminal
  /// too, and erased at the end. The returned function is false after the first Ctrl-C; a second
  /// one ends the program at once.
  Progress progress();

  /// Shows lines on stderr below all other output, under the same conditions as the progress line.
  /// They stay until the next call and are erased at the end. Lines that do not fit into the
  /// terminal are cut.
  void show(std::vector<std::pair<std::string, Colour>> lines);
  /// True if show() shows anything.
  bool shows() const { return progress_; }
  /// Rings the bell, under the same conditions as show().
  void ring();

  /// Sets the advice for the case that the verb fails; the last call counts. It is called after the
  /// verb has returned, so it must hold its data by value.
  void if_it_fails(Advice advice) { advice_ = std::move(advice); }
  /// Sets one line of advice, for any failure.
  void advise(std::string line);
  /// States that the file is complete, even if the verb fails later. An empty path is ignored.
  void wrote(const std::string& path);

  /// Returns the failure for wrong use that only the files show. The exit code is that of wrong
  /// use.
  Failure refuse(Error error);
  bool refused() const { return refused_; }

  /// The columns and the rows that show() can use.
  std::size_t columns() const;
  std::size_t rows() const;

  /// Prints the error and the advice.
  void report(const Error& error);

  /// For a job that must go on while no program reads its output: see Outlet. Lines of --json that
  /// were dropped are reported later by a line {"event": "missed", "lines": N}.
  void never_wait();

  /// Writes held text, for a job that goes on.
  void flush();
  /// The reason why stdout takes no text: "No space left on device". Empty if it works.
  std::string out_trouble() const;
  /// Writes the held text at the end. Fails if stdout refused it; a reader that went away is no
  /// failure.
  Result<void> finish();

 private:
  using Clock = std::chrono::steady_clock;

  void put_json(std::string_view object, int version);
  void erase_shown();
  void draw_table();
  void say_above_table(std::string_view message);
  void show_progress(std::string_view what, std::uint64_t done, std::uint64_t total);
  void say(std::string_view line, Colour colour = Colour::plain);

  const Surroundings& surroundings_;
  const Common& common_;
  std::string verb_, json_name_;
  Advice advice_;
  // Wrong use that only the files showed; see refuse().
  bool refused_ = false;
  bool colour_out_ = false, colour_err_ = false, progress_ = false;
  Outlet out_, err_;
  std::string doing_;                                  // the job in the progress line
  std::vector<std::pair<std::string, Colour>> table_;  // the lines of the last show()
  std::vector<std::size_t> standing_;  // the width of each line on the terminal: table or progress
  Clock::time_point began_{}, drawn_{};
};

/// The progress line: "reading  43 %  1.2 MB/s  12 s left". `elapsed_s`: since the job's begin;
/// `width`: the line is cut there.
std::string progress_line(std::string_view what, std::uint64_t done, std::uint64_t total,
                          double elapsed_s, std::size_t width);

/// From here on the first Ctrl-C, SIGTERM or SIGHUP is only noted, and a reader of stdout that goes
/// away raises no signal. If SIGHUP was ignored at the start (nohup), it stays ignored.
void take_signals();
/// Like take_signals(), but every such signal is only noted: a closed terminal sends SIGHUP, and so
/// does its shell. The caller has to end by itself.
void take_every_signal();
/// True if Ctrl-C, SIGTERM or SIGHUP came since take_signals().
bool interrupted();

}  // namespace kinalign
