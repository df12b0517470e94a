// SPDX-License-Identifier: Apache-2.0
// What a verb says: results on stdout, everything else on stderr. Colour and the progress line only
// where they are wanted (docs/commands.md).
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

/// The colour that a finding's word has.
constexpr Colour colour_of(Severity severity) {
  if (severity == Severity::note) return Colour::plain;
  return severity == Severity::warning ? Colour::warning : Colour::bad;
}

/// Lines under an error: what was left undone, what to do next.
using Advice = std::function<std::vector<std::string>(const Error&)>;

class Console {
 public:
  Console(const Surroundings& surroundings, const Common& common, std::string verb);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();

  /// A piece of the result, whole lines for people: on stdout, as it stands, on a terminal with
  /// lines no wider than that. Silent with --quiet and --json.
  void print(std::string_view text);

  /// What --json asks for: `object` is the text "{...}" of a JSON object, which gets
  /// "schema": "kinalign.<verb>/<version>" as its first member. Silent without --json.
  void print_json(std::string_view object, int version = 1);
  /// Another name for <verb>: the schema kinalign.report is that of the report in a take.
  void name_json(std::string name) { json_name_ = std::move(name); }
  /// Whether print_json() prints anything: what is told each second is made only then.
  bool prints_json() const { return common_.json; }

  /// Text that is the result itself (a man page, a completion): on stdout whatever the flags.
  void put(std::string_view text);

  /// A line on stderr; silent with --quiet.
  void note(std::string_view line);
  /// A line on stderr, with --verbose only.
  void detail(std::string_view line);
  /// A line on stderr in any case.
  void complain(std::string_view line);

  /// `text` in a colour where stdout shows one.
  std::string paint(Colour colour, std::string_view text) const;

  /// One line on stderr, on a terminal only, gone when the job is done; none where --json goes to a
  /// terminal. Asks the job to stop after the first Ctrl-C (the second one ends the program at
  /// once).
  Progress progress();

  /// Lines that stand on stderr until the next ones, on a terminal where progress would be, below
  /// all that is said meanwhile, and are gone when the job is done; no wider and no more than the
  /// terminal has room for.
  void show(std::vector<std::pair<std::string, Colour>> lines);
  /// Whether show() shows anything.
  bool shows() const { return progress_; }
  /// A sound, where show() shows anything.
  void ring();

  /// To be said if the verb fails; the last call counts. Asked after the verb has returned: it
  /// holds what it needs, by value.
  void if_it_fails(Advice advice) { advice_ = std::move(advice); }
  /// Whatever fails from here on, the file is there. An empty path: there is none.
  void wrote(const std::string& path);

  /// Wrong use that only the files show: the failure to return, with the exit code of wrong use.
  Failure refuse(Error error);
  bool refused() const { return refused_; }

  /// Places in a line of what show() shows, and lines that it has room for.
  std::size_t columns() const;
  std::size_t rows() const;

  /// Says what went wrong and what was advised.
  void report(const Error& error);

  /// For a job that must not stand still while nobody reads: see Outlet. What --json then lacks is
  /// told, once there is room again, by a line {"event": "missed", "lines": N}.
  void never_wait();

  /// Writes what is held, for a job that goes on.
  void flush();
  /// What keeps stdout from taking it, for a job that goes on: "No space left on device"; empty:
  /// nothing.
  std::string out_trouble() const;
  /// Writes what is still held. Fails where stdout took no more; a reader that went away is fine.
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
  bool refused_ = false;
  bool colour_out_ = false, colour_err_ = false, progress_ = false;
  Outlet out_, err_;
  std::string doing_;                                  // what the progress line says
  std::vector<std::pair<std::string, Colour>> table_;  // what show() showed last
  std::vector<std::size_t> standing_;  // of each line that stands, the table's or progress: places
  Clock::time_point began_{}, drawn_{};
};

/// "reading  43 %  1.2 MB/s  12 s left": of a job that has run for `elapsed_s`, cut to `width`.
std::string progress_line(std::string_view what, std::uint64_t done, std::uint64_t total,
                          double elapsed_s, std::size_t width);

/// From here on the first Ctrl-C, SIGTERM or SIGHUP is only noted, and a reader of stdout that goes
/// away is no signal. Who started the program with SIGHUP ignored (nohup) wants it to go on.
void take_signals();
/// As take_signals(), but all of them are only noted, however soon one follows another: a terminal
/// that is closed and its shell send SIGHUP both. Who asks for it has to end by itself.
void take_every_signal();
/// Ctrl-C was pressed, or SIGTERM or SIGHUP came, since take_signals().
bool interrupted();

}  // namespace kinalign
