// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include "apps/cli/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstring>

namespace kinalign {

namespace {

// A global variable is needed, because a signal handler gets no argument from this program.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<bool> ctrl_c = false;  // any thread may read it
static_assert(std::atomic<bool>::is_always_lock_free);

// The ANSI codes, in the order of the enumerators of Colour. Each kind of stream has the same
// colour as on the HTML pages: mocap red, Kinect green, nodes blue.
constexpr std::array<std::string_view, 7> codes{"",         "\x1b[32m", "\x1b[33m", "\x1b[31m",
                                                "\x1b[31m", "\x1b[32m", "\x1b[34m"};
constexpr std::string_view plain = "\x1b[0m";

std::string painted(bool wanted, Colour colour, std::string_view text) {
  const std::string_view code = codes[static_cast<std::size_t>(colour)];
  if (!wanted || code.empty()) return std::string(text);
  return fmt::format("{}{}{}", code, text, plain);
}

/// If --color is "auto", colours appear on a terminal, unless TERM is dumb or the variable NO_COLOR
/// (no-color.org) is not empty.
bool colour_wanted(const Surroundings& surroundings, const Common& common, bool terminal) {
  if (common.color != "auto") return common.color == "always";
  return terminal && surroundings.variable("NO_COLOR").empty() &&
         surroundings.variable("TERM") != "dumb";
}

/// No progress line if the lines of --json go to the same terminal: it would stand between them.
bool progress_wanted(const Surroundings& surroundings, const Common& common) {
  return surroundings.err_is_terminal && !common.quiet && surroundings.variable("TERM") != "dumb" &&
         !(common.json && surroundings.out_is_terminal);
}

/// The speed of the job in its own unit: bytes for reading, hashing and building, takes for
/// comparing, frames for all other jobs.
std::string rate_text(std::string_view what, double per_s) {
  const bool by_bytes = what.starts_with("reading") || what == "hashing" || what == "building";
  if (what == "comparing") return fmt::format("{:.0f} takes/s", per_s);
  if (!by_bytes) return fmt::format("{:.0f} frames/s", per_s);
  if (per_s >= 1e9) return fmt::format("{:.1f} GB/s", per_s / 1e9);
  if (per_s >= 1e6) return fmt::format("{:.1f} MB/s", per_s / 1e6);
  return fmt::format("{:.1f} kB/s", per_s / 1e3);
}

std::string time_text(double s) {
  if (s < 59.5) return fmt::format("{:.0f} s", s);
  const auto minutes = std::llround(s / 60);
  if (minutes < 60) return fmt::format("{} min", minutes);
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

/// Installs the signal handler. SIGPIPE and SIGXFSZ are ignored, so that a failed write returns an
/// error and does not end the program.
void note_signals(unsigned flags) {
  ctrl_c = false;
  struct sigaction action {};
  // A signal handler may do little, so it only sets a flag. The job reads the flag at its next call
  // of progress.
  action.sa_handler = [](int) { ctrl_c = true; };
  action.sa_flags = static_cast<int>(flags);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction hang_up {};
  ::sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN)
    ::sigaction(SIGHUP, &action, nullptr);  // an ignored SIGHUP (nohup) stays ignored
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);  // a file above the size limit then acts like a full disk
}

}  // namespace

// If the total is not known, the line has neither a percentage nor the time left.
std::string progress_line(std::string_view what, std::uint64_t done, std::uint64_t total,
                          double elapsed_s, std::size_t width) {
  std::string line(what);
  const auto doing = static_cast<double>(done);
  const auto all = static_cast<double>(total);
  if (total > 0) line += fmt::format("  {:.0f} %", 100 * std::min(1.0, doing / all));
  // The rate of the first half second is too uncertain to show.
  if (done > 0 && elapsed_s > 0.5) {
    line += "  " + rate_text(what, doing / elapsed_s);
    if (total > done) line += fmt::format("  {} left", time_text(elapsed_s * (all / doing - 1)));
  }
  return line.substr(0, width);
}

// SA_RESETHAND restores the default handler after the first Ctrl-C, so a second Ctrl-C ends the
// program at once.
void take_signals() { note_signals(SA_RESETHAND | SA_RESTART); }
void take_every_signal() { note_signals(SA_RESTART); }

bool interrupted() { return ctrl_c; }

Console::Console(const Surroundings& surroundings, const Common& common, std::string verb)
    : surroundings_(surroundings),
      common_(common),
      verb_(std::move(verb)),
      colour_out_(colour_wanted(surroundings, common, surroundings.out_is_terminal)),
      colour_err_(colour_wanted(surroundings, common, surroundings.err_is_terminal)),
      progress_(progress_wanted(surroundings, common)),
      out_(surroundings.out),
      err_(surroundings.err) {}

// The progress line must not stay on the terminal after the verb has ended.
Console::~Console() {
  erase_shown();
  err_.flush();
  flush();
}

void Console::never_wait() {
  out_.never_wait();
  err_.never_wait();
}

void Console::print(std::string_view text) {
  if (common_.quiet || common_.json) return;
  // Lines in a pipe or a file are not broken, because other programs read them.
  put(surroundings_.out_is_terminal ? broken(text, size_of(surroundings_.out).columns) : text);
}

/// If lines were dropped, a line that reports them is printed before the object.
void Console::print_json(std::string_view object, int version) {
  if (!prints_json()) return;
  if (const std::uint64_t missed = out_.take_dropped()) {
    put_json(fmt::format(R"({{"event": "missed", "lines": {}}})", missed), version);
  }
  put_json(object, version);
}

/// Inserts the member "schema" at the front of the object.
void Console::put_json(std::string_view object, int version) {
  const std::string_view members = object.substr(object.find('{') + 1);
  const bool none = members.find_first_not_of(" \n") == members.find('}');
  std::string name = json_name_.empty() ? verb_ : json_name_;
  // The name of a verb in a group has a blank. The schema has a dot instead:
  // "kinalign.dataset.build".
  std::replace(name.begin(), name.end(), ' ', '.');
  put(fmt::format("{{\"schema\": \"kinalign.{}/{}\"{}{}\n", name, version, none ? "" : ", ",
                  members.substr(std::min(members.find_first_not_of(" \n"), members.size()))));
}

void Console::put(std::string_view text) { out_.put(text); }

void Console::note(std::string_view line) {
  if (!common_.quiet) say(line);
}

void Console::detail(std::string_view line) {
  if (common_.verbose && !common_.quiet) say(line);
}

void Console::complain(std::string_view line) { say(line, Colour::bad); }

std::string Console::paint(Colour colour, std::string_view text) const {
  return painted(colour_out_, colour, text);
}

Progress Console::progress() {
  began_ = Clock::now();
  return [this](std::string_view what, std::uint64_t done, std::uint64_t total) {
    if (progress_) show_progress(what, done, total);
    return !interrupted();
  };
}

void Console::show(std::vector<std::pair<std::string, Colour>> lines) {
  if (!progress_) return;
  table_ = std::move(lines);
  // While the terminal takes no text, no new table is added: it would be out of date when it
  // appears.
  if (err_.holds()) return;
  erase_shown();
  draw_table();
  err_.flush();
}

/// Draws as many lines of the table as the terminal has rows for.
void Console::draw_table() {
  // A table higher than the terminal would scroll and could not be erased.
  const std::size_t count = std::min(table_.size(), rows());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [text, colour] = table_[i];
    const std::string_view line = first_places(text, columns());
    err_.put((i > 0 ? "\n" : "") + painted(colour_err_, colour, line));
    standing_.push_back(places(line));
  }
}

std::size_t Console::columns() const { return size_of(surroundings_.err).columns - 1; }
std::size_t Console::rows() const { return size_of(surroundings_.err).rows - 1; }

void Console::ring() {
  if (!progress_) return;
  err_.put("\a");
  err_.flush();
}

void Console::advise(std::string line) {
  advice_ = [line = std::move(line)](const Error&) { return std::vector<std::string>{line}; };
}

Failure Console::refuse(Error error) {
  refused_ = true;
  advise("kinalign " + verb_ + " --help lists its arguments and flags, with examples");
  return Failure(std::move(error));
}

void Console::wrote(const std::string& path) {
  if (path.empty()) return;
  advise(harmless(path) + " was written completely before this error");
}

void Console::report(const Error& error) {
  const std::string name = verb_.empty() ? "kinalign" : "kinalign " + verb_;
  complain(name + ": " + to_string(error));
  if (!advice_) return;
  for (const std::string& line : advice_(error)) say("  " + line);
}

std::string Console::out_trouble() const {
  return out_.fault() == 0 ? "" : std::strerror(out_.fault());
}

/// Waits up to a second for a slow reader. A reader that has closed the pipe (EPIPE) is no error.
Result<void> Console::finish() {
  // A reader that never reads must not keep the program alive.
  constexpr std::chrono::milliseconds last_words{1000};
  erase_shown();
  err_.flush();
  table_.clear();
  out_.flush(last_words);
  err_.flush(last_words);
  if (out_.fault() == 0 || out_.fault() == EPIPE) return {};
  return Failure(Error{"standard output", 0, "room to write", std::strerror(out_.fault())});
}

/// Redraws the progress line, at most ten times a second.
void Console::show_progress(std::string_view what, std::uint64_t done, std::uint64_t total) {
  const Clock::time_point now = Clock::now();
  // Each part of a job has its own rate and its own remaining time.
  if (doing_ != what) {
    doing_ = what;
    began_ = now;
  }
  constexpr auto redraw = std::chrono::milliseconds(100);
  if ((!standing_.empty() && now - drawn_ < redraw) || err_.holds()) return;
  drawn_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - began_).count();
  const std::string line = progress_line(what, done, total, elapsed_s, columns());
  if (standing_.empty()) err_.put(start_of_lines(1));  // a terminal prints "^C" for Ctrl-C
  erase_shown();
  err_.put(line);
  err_.flush();
  standing_ = {places(line)};
}

/// Erases the progress line or the table. If the terminal was made narrower, it has broken their
/// lines into more rows, which are counted anew.
void Console::erase_shown() {
  if (standing_.empty()) return;
  const std::size_t width = size_of(surroundings_.err).columns;
  std::size_t rows = 0;
  for (const std::size_t line : standing_) rows += rows_of(line, width);
  err_.put(start_of_lines(rows));
  standing_.clear();
}

/// Writes the message above the table, all in one piece so that the table does not flicker. Text
/// held for stdout is written before. While the terminal takes no text, the table is not drawn
/// again with each message.
void Console::say_above_table(std::string_view message) {
  const bool stuck = err_.holds();
  erase_shown();
  if (out_.holds()) {
    err_.flush();
    out_.flush();
  }
  err_.put(message);
  if (!stuck) draw_table();
  err_.flush();
}

void Console::flush() {
  const bool over_it = surroundings_.out_is_terminal && !standing_.empty() && out_.holds();
  if (over_it) {
    say_above_table("");
  } else {
    out_.flush();
  }
}

void Console::say(std::string_view line, Colour colour) {
  std::string text(line);
  if (surroundings_.err_is_terminal && !line.empty()) {
    text = broken(line, size_of(surroundings_.err).columns);
    text.pop_back();
  }
  say_above_table(painted(colour_err_, colour, text) + "\n");
}

}  // namespace kinalign
