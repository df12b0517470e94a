// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/lab_table.h"

#include "apps/cli/terminal.h"
#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace kinalign {

namespace {

/// A silent sender that another sender of its device has replaced is shown for this time.
constexpr Duration forgotten_after = std::chrono::seconds(30);

// The order is that on the screen. Columns on the right are left out first on a narrow terminal,
// but `device` and `rate` always stay.
enum Column : std::size_t {
  device,
  rate,
  lost,
  late,
  duplicates,
  last,
  offset,
  drift,
  battery,
  recorded,
  link
};
constexpr std::size_t columns = 11;
using Cells = std::array<std::string, columns>;

/// One line before layout: cells, or the device and a text.
/// Invariant: a row with a text has only the device's cell, and the text stands in place of all
/// others.
struct Row {
  Cells cells;
  std::optional<std::string> text{};
  bool bad = false;
};

Row head() {
  return {{"device", "rate/s", "lost", "late", "dup", "last", "clock", "ppm", "battery", "recorded",
           "link"}};
}

/// The clock offset (host minus device) and half the certified interval: "-1000.0031 s ± 1.04 ms".
std::string offset_cell(const std::optional<SenderClock>& clock) {
  if (!clock) return "";
  if (!clock->half_interval) return "not locked";
  return fmt::format("{:.4f} s ± {:.2f} ms", seconds(clock->host_minus_sender),
                     1e3 * seconds(*clock->half_interval));
}

/// A nominal rate of 0 means that the lab does not state one.
std::string rate_cell(const StreamStatus& stream, double nominal_hz) {
  const std::string hz = fmt::format("{:.1f}", stream.rate_hz);
  return nominal_hz > 0 ? fmt::format("{} of {:g}", hz, nominal_hz) : hz;
}

/// "0.1 s", "silent 12 s": readable without colours, too.
std::string last_cell(const StreamStatus& stream, HostTime now) {
  const double ago = seconds(now - stream.last_arrival);
  return is_silent(stream, now) ? fmt::format("silent {:.0f} s", ago)
                                : fmt::format("{:.1f} s", ago);
}

/// True if another sender of the same device sends now: a program that was restarted has another
/// port. Each node is a sender of its own.
bool is_replaced(const StreamStatus& stream, const LabStatus& status) {
  return stream.node.empty() &&
         std::any_of(status.streams.begin(), status.streams.end(), [&](const StreamStatus& other) {
           return other.stream == stream.stream && !is_silent(other, status.now);
         });
}

/// The cells of a sender's row.
/// The order of the cells is that of Column.
Cells cells_of(const StreamStatus& stream, const DeviceOptions& options, const LabStatus& status) {
  const auto clock = clock_of(stream, node_of(stream, status.nodes));
  const SequenceCounts& order = stream.counts.order;
  return {name_of(stream),
          rate_cell(stream, nominal_rate_hz(options)),
          grouped(order.lost),
          grouped(order.late),
          grouped(order.duplicates),
          last_cell(stream, status.now),
          offset_cell(clock),
          clock ? fmt::format("{:+.1f}", 1e6 * clock->drift) : "",
          stream.battery_volts ? fmt::format("{:.2f} V", *stream.battery_volts) : "",
          fmt::format("{:.1f} MB", megabytes(stream.counts.bytes)),
          options.transport + " " + stream.sender};
}

/// A row about something that has no numbers yet.
Row note(std::string who, std::string text, bool bad) {
  Row row{{}, std::move(text), bad};
  row.cells[device] = std::move(who);
  return row;
}

/// Losses at a port can't be assigned to a sender, so they have a row of their own.
void add_losses(const std::string& port, const LabStatus& status, std::vector<Row>& rows) {
  for (const auto& [name, counts] : status.ports) {
    const std::string text = name == port ? loss_of(counts, frames_lost(name, status.streams)) : "";
    if (!text.empty()) rows.push_back(note(name, text, true));
  }
}

/// Adds a row for each sender of a device, for each node or device that has sent nothing yet, and
/// for losses at its port.
void add_device(const DeviceOptions& options, const LabStatus& status, std::vector<Row>& rows) {
  for (const StreamStatus& stream : status.streams) {
    if (stream.stream != options.name) continue;
    const bool silent = is_silent(stream, status.now);
    // A program that was restarted leaves its old sender behind, which is no fault.
    const bool replaced = silent && is_replaced(stream, status);
    if (replaced && status.now - stream.last_arrival >= forgotten_after) continue;
    // Only a required device makes its line red.
    const bool bad = options.required && silent && !replaced;
    rows.push_back({cells_of(stream, options, status), std::nullopt, bad});
  }
  // Nodes with a place that never sent, or the whole device.
  for (const std::string& name : unseen(options, status)) {
    rows.push_back(note(name,
                        fmt::format("{}nothing yet, {:.0f} s", options.required ? "missing: " : "",
                                    seconds(status.now - status.begun)),
                        options.required));
  }
  add_losses(options.name, status, rows);
}

using Widths = std::array<std::size_t, columns>;  // width of each column; 0: left out

/// True while no sender has a row; column heads would then head nothing.
bool only_devices(const Widths& wide) {
  return std::all_of(wide.begin() + 1, wide.end(), [](std::size_t places) { return places == 0; });
}

/// The widths of the columns. If the row does not fit, columns are left out from the right.
Widths widths_of(const std::vector<Row>& rows, std::size_t width) {
  Widths wide{};
  for (const Row& row : rows) {
    if (&row == &rows.front()) continue;  // a head alone needs no column
    for (std::size_t i = 0; i < columns; ++i) wide[i] = std::max(wide[i], places(row.cells[i]));
  }
  if (only_devices(wide)) return wide;
  // The first column is as wide as its head needs at least.
  std::size_t all = wide[device] = std::max(wide[device], places(rows.front().cells[device]));
  for (std::size_t i = device + 1; i < columns; ++i) {
    if (wide[i] > 0) wide[i] = std::max(wide[i], places(rows.front().cells[i]));
    all += wide[i] > 0 ? wide[i] + 1 : 0;
    // A column that does not fit is left out, and so are all columns to its right, since `all`
    // keeps growing.
    if (all > width && i > rate) wide[i] = 0;
  }
  return wide;
}

/// The row as text. A text behind the device takes the place of all other cells.
std::string line_of(const Row& row, const Widths& wide) {
  std::string line;
  for (std::size_t i = 0; i < columns; ++i) {
    if (wide[i] == 0) continue;
    // Widths are places on the terminal and not bytes: a name may have letters of several bytes.
    const std::string gap(wide[i] - std::min(wide[i], places(row.cells[i])), ' ');
    const bool to_the_left = i == device || i == link;
    line += (i == 0 ? "" : " ") + (to_the_left ? row.cells[i] + gap : gap + row.cells[i]);
    if (row.text) return line + " " + *row.text;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status, std::size_t width) {
  std::vector<Row> rows{head()};
  for (const DeviceOptions& options : lab.devices) add_device(options, status, rows);
  // The ports of marks belong to no device, but may lose data as well.
  for (const char* port : {"marks", "trigger"}) add_losses(port, status, rows);
  const auto wide = widths_of(rows, width);
  std::vector<TableLine> lines;
  lines.reserve(rows.size());
  for (const Row& row : rows) {
    const bool is_head = &row == &rows.front();
    if (!is_head || !only_devices(wide)) lines.push_back({line_of(row, wide), row.bad, is_head});
  }
  return lines;
}

std::vector<TableLine> fitted(std::vector<TableLine> table, std::size_t rows) {
  if (table.size() <= rows) return table;
  // A terminal of two lines has no room for a table.
  if (rows == 0) return {};
  const auto is_bad = [](const TableLine& line) { return line.bad; };
  // The head stays on top. Bad lines keep their order among themselves.
  std::stable_partition(table.begin() + (table.front().head ? 1 : 0), table.end(), is_bad);
  // One line is used for the number of the hidden ones.
  const auto out = table.begin() + static_cast<std::ptrdiff_t>(rows) - 1;
  const bool any_bad = std::any_of(out, table.end(), is_bad);
  const std::string text = fmt::format("… {} more", table.end() - out);
  table.erase(out, table.end());
  table.push_back({text, any_bad});
  return table;
}

}  // namespace kinalign
