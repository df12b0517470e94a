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

/// A silent sender is removed from the table after this time if another sender of its device has
/// taken its place.
constexpr Duration forgotten_after = std::chrono::seconds(30);

// The columns from left to right. On a narrow terminal the rightmost columns are left out first;
// `device` and `rate` always stay.
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

/// One row of the table. Invariant: a row has either all cells, or the cell `device` and a text
/// that replaces all other cells.
struct Row {
  Cells cells;
  std::optional<std::string> text{};
  bool bad = false;
};

Row head() {
  return {{"device", "rate/s", "lost", "late", "dup", "last", "clock", "ppm", "battery", "recorded",
           "link"}};
}

/// The clock offset (host minus device) and the half-width of its certified interval: "-1000.0031 s
/// ± 1.04 ms".
std::string offset_cell(const std::optional<SenderClock>& clock) {
  if (!clock) return "";
  if (!clock->half_interval) return "not locked";
  return fmt::format("{:.4f} s ± {:.2f} ms", seconds(clock->host_minus_sender),
                     1e3 * seconds(*clock->half_interval));
}

/// The measured rate, and the nominal rate if lab.toml states one (`nominal_hz` is 0 otherwise).
std::string rate_cell(const StreamStatus& stream, double nominal_hz) {
  const std::string hz = fmt::format("{:.1f}", stream.rate_hz);
  return nominal_hz > 0 ? fmt::format("{} of {:g}", hz, nominal_hz) : hz;
}

/// The time since the last message: "0.1 s", or "silent 12 s", which can be read without colours,
/// too.
std::string last_cell(const StreamStatus& stream, HostTime now) {
  const double ago = seconds(now - stream.last_arrival);
  return is_silent(stream, now) ? fmt::format("silent {:.0f} s", ago)
                                : fmt::format("{:.1f} s", ago);
}

/// True if another sender of the same device sends now. A program that was restarted has another
/// port and is therefore another sender. Nodes are never replaced: each node is a sender.
bool is_replaced(const StreamStatus& stream, const LabStatus& status) {
  return stream.node.empty() &&
         std::any_of(status.streams.begin(), status.streams.end(), [&](const StreamStatus& other) {
           return other.stream == stream.stream && !is_silent(other, status.now);
         });
}

/// The cells of a sender's row, in the order of Column.
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

/// A row with a text, for a device or a port without numbers.
Row note(std::string who, std::string text, bool bad) {
  Row row{{}, std::move(text), bad};
  row.cells[device] = std::move(who);
  return row;
}

/// Adds a row for losses at a port. They can't be assigned to one sender.
void add_losses(const std::string& port, const LabStatus& status, std::vector<Row>& rows) {
  for (const auto& [name, counts] : status.ports) {
    const std::string text = name == port ? loss_of(counts, frames_lost(name, status.streams)) : "";
    if (!text.empty()) rows.push_back(note(name, text, true));
  }
}

/// Adds the rows of a device: one for each sender, one for each node or device that has sent
/// nothing, and one for losses at the device's port.
void add_device(const DeviceOptions& options, const LabStatus& status, std::vector<Row>& rows) {
  for (const StreamStatus& stream : status.streams) {
    if (stream.stream != options.name) continue;
    const bool silent = is_silent(stream, status.now);
    // If the device's program was restarted, its old sender is silent; that is no fault.
    const bool replaced = silent && is_replaced(stream, status);
    if (replaced && status.now - stream.last_arrival >= forgotten_after) continue;
    // Only a required device that is silent makes its line red.
    const bool bad = options.required && silent && !replaced;
    rows.push_back({cells_of(stream, options, status), std::nullopt, bad});
  }
  // unseen() gives the nodes with places that have never sent, or the whole device.
  for (const std::string& name : unseen(options, status)) {
    rows.push_back(note(name,
                        fmt::format("{}nothing yet, {:.0f} s", options.required ? "missing: " : "",
                                    seconds(status.now - status.begun)),
                        options.required));
  }
  add_losses(options.name, status, rows);
}

// The width of each column. A column of width 0 is left out.
using Widths = std::array<std::size_t, columns>;

/// True if no sender has a row. The table then needs no heads of columns.
bool only_devices(const Widths& wide) {
  return std::all_of(wide.begin() + 1, wide.end(), [](std::size_t places) { return places == 0; });
}

/// The widths of the columns. If the lines do not fit, the rightmost columns are left out.
Widths widths_of(const std::vector<Row>& rows, std::size_t width) {
  Widths wide{};
  for (const Row& row : rows) {
    if (&row == &rows.front()) continue;  // a column without values is left out
    for (std::size_t i = 0; i < columns; ++i) wide[i] = std::max(wide[i], places(row.cells[i]));
  }
  if (only_devices(wide)) return wide;
  // The first column is at least as wide as its head.
  std::size_t all = wide[device] = std::max(wide[device], places(rows.front().cells[device]));
  for (std::size_t i = device + 1; i < columns; ++i) {
    if (wide[i] > 0) wide[i] = std::max(wide[i], places(rows.front().cells[i]));
    all += wide[i] > 0 ? wide[i] + 1 : 0;
    // `all` grows with each column, so if a column does not fit, neither do the columns to its
    // right.
    if (all > width && i > rate) wide[i] = 0;
  }
  return wide;
}

/// The row as one line. A text stands in place of all cells but the device's.
std::string line_of(const Row& row, const Widths& wide) {
  std::string line;
  for (std::size_t i = 0; i < columns; ++i) {
    if (wide[i] == 0) continue;
    // Widths are counted in columns of the terminal, since a letter may have several bytes.
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
  // The ports for marks belong to no device, but may lose data, too.
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
  // If the terminal has too few lines, there is no table.
  if (rows == 0) return {};
  const auto is_bad = [](const TableLine& line) { return line.bad; };
  // The head stays on top. Lines with faults come next, in the same order as before.
  std::stable_partition(table.begin() + (table.front().head ? 1 : 0), table.end(), is_bad);
  // The last line states the number of hidden lines.
  const auto out = table.begin() + static_cast<std::ptrdiff_t>(rows) - 1;
  const bool any_bad = std::any_of(out, table.end(), is_bad);
  const std::string text = fmt::format("… {} more", table.end() - out);
  table.erase(out, table.end());
  table.push_back({text, any_bad});
  return table;
}

}  // namespace kinalign
