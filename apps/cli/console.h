// SPDX-License-Identifier: Apache-2.0
// The output of a verb: results on stdout, all other text on stderr. docs/commands.md states when
// colours and the progress line appear.
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

/// Text for stdout and stderr is held until it is flushed. On a terminal the progress line or a
/// table stays at the bottom: it is erased before any other line and drawn again below. `standing_`
/// has the widths of the lines now at the bottom.
class Console {
 public:
  Console(const Surroundings& surroundings, const Common& common, std::string verb);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();

  /// Prints whole lines of the result on stdout. On a terminal, lines are broken at its width.
  /// Prints nothing with --quiet or --json.
  void print(std::string_view text);

  /// Prints a line of JSON on stdout if --json was given. `object` is the text "{...}" of a JSON
  /// object; the member "schema": "kinalign.<verb>/<version>" is added as its first.
  void print_json(std::string_view object, int version = 1);
  /// Sets a name for the schema other than <verb>. For example, the report in a take has
  /// kinalign.report.
  void name_json(std::string name) { json_name_ = std::move(name); }
  /// True if print_json() prints. A caller that would make JSON every second asks first.
  bool prints_json() const { return common_.json; }

  /// Prints text on stdout with any flags, such as a man page or a completion script.
  void put(std::string_view text);

  /// Prints a line on stderr, but not with --quiet.
  void note(std::string_view line);
  /// Prints a line on stderr only with --verbose.
  void detail(std::string_view line);
  /// Prints a line on stderr, with any flags.
  void complain(std::string_view line);

  /// Puts the text into the codes of a colour if stdout shows colours.
  std::string paint(Colour colour, std::string_view text) const;

  /// Shows the progress line on stderr and erases it at the end. The line appears only on a
  /// terminal, and not if --json goes to a terminal, too. The returned function gives false after
  /// the first Ctrl-C. A second Ctrl-C ends the program at once.
  Progress progress();

  /// Shows lines on stderr below all other output, under the same conditions as the progress line.
  /// The lines stay until the next call of show() and are erased at the end. Lines too long for the
  /// terminal are cut.
  void show(std::vector<std::pair<std::string, Colour>> lines);
  /// True if show() shows anything.
  bool shows() const { return progress_; }
  /// Rings the bell, under the same conditions as show().
  void ring();

  /// Sets the advice that is printed if the verb fails; the last call counts. `advice` is called
  /// after the verb has returned, so it must hold copies of its data and no references.
  void if_it_fails(Advice advice) { advice_ = std::move(advice); }
  /// Sets one line of advice for any failure.
  void advise(std::string line);
  /// Makes a later error message say that this file is complete. An empty path is ignored.
  void wrote(const std::string& path);

  /// Returns a failure for which the program exits with the code of wrong use. Verbs call it if
  /// only the content of the files shows that the command was wrong.
  Failure refuse(Error error);
  bool refused() const { return refused_; }

  /// The number of columns and of rows that show() can use.
  std::size_t columns() const;
  std::size_t rows() const;

  /// Prints the error and the advice.
  void report(const Error& error);

  /// Output no longer delays the job, even if no program reads it (Outlet::never_wait). If lines of
  /// --json were dropped, a later line {"event": "missed", "lines": N} counts them.
  void never_wait();

  /// Writes the held text now; the job goes on.
  void flush();
  /// The reason why stdout takes no text: "No space left on device". Empty if stdout takes text.
  std::string out_trouble() const;
  /// Writes the held text at the end. Fails if stdout refuses the text. A reader that has closed
  /// the pipe is no failure.
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
  // True after refuse() was called.
  bool refused_ = false;
  bool colour_out_ = false, colour_err_ = false, progress_ = false;
  Outlet out_, err_;
  // The current job, which the progress line names.
  std::string doing_;
  std::vector<std::pair<std::string, Colour>> table_;  // the lines of the last show()
  std::vector<std::size_t> standing_;  // the width of each line on the terminal: table or progress
  Clock::time_point began_{}, drawn_{};
};

/// The progress line: "reading  43 %  1.2 MB/s  12 s left". `elapsed_s`: the time since the job
/// began. `width`: the number of columns at which the line is cut.
std::string progress_line(std::string_view what, std::uint64_t done, std::uint64_t total,
                          double elapsed_s, std::size_t width);

/// After this call the first Ctrl-C, SIGTERM or SIGHUP does not end the program; interrupted()
/// reports it. A SIGHUP that was ignored at the start (nohup) stays ignored. A reader that closes
/// stdout raises no signal.
void take_signals();
/// Works like take_signals(), but no later signal ends the program either. A closed terminal sends
/// SIGHUP twice, since its shell sends one, too. The caller has to stop by itself.
void take_every_signal();
/// True if Ctrl-C, SIGTERM or SIGHUP came since take_signals().
bool interrupted();

}  // namespace kinalign
