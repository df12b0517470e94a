// SPDX-License-Identifier: Apache-2.0
// Compares the files of one tracking system with each other: channels.tsv, channels.json,
// motion.json and motion.tsv.
#include "kinalign/core/files.h"
#include "kinalign/formats/bids/channels.h"
#include "kinalign/formats/bids/check_context.h"
#include "kinalign/formats/bids/json_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace kinalign {

namespace {

using FoundJson = nlohmann::ordered_json;

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> all) {
  return std::find(all.begin(), all.end(), text) != all.end();
}

/// True if the channel's type allows its component. Only orientations have parts of a quaternion,
/// and a latency has no component.
bool fits(const BidsChannel& channel) {
  const bool axis = is_one_of(channel.component, {"x", "y", "z"});
  if (channel.type == "ORNT") return axis || channel.component.starts_with("quat_");
  if (is_one_of(channel.type, {"POS", "VEL", "ACCEL", "ANGACCEL", "GYRO", "MAGN"})) return axis;
  if (channel.type == "LATENCY") return channel.component == "n/a";
  return true;
}

/// The path of the sidecar file with this ending.
std::string sidecar(std::string_view motion_tsv, const char* ending) {
  motion_tsv.remove_suffix(std::string_view("motion.tsv").size());
  return std::string(motion_tsv) + ending;
}

std::string in_capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return text;
}

/// Checks the header line of channels.tsv: five required columns in order, and no repeated name.
/// BIDS requires the order of these columns only.
void check_columns(const std::string& path, const TsvTable& table, BidsCheck& check) {
  constexpr std::array<const char*, 5> needed{"name", "component", "type", "tracked_point",
                                              "units"};
  for (std::size_t c = 0; c < needed.size(); ++c) {
    if (c < table.columns.size() && table.columns[c] == needed[c]) continue;
    check.error(path, fmt::format("{} as column {}", needed[c], c + 1),
                c < table.columns.size() ? shown(table.columns[c]) : "none", 1);
  }
  const std::set<std::string> names(table.columns.begin(), table.columns.end());
  if (names.size() != table.columns.size())
    check.error(path, "columns with different names", "a name twice", 1);
}

/// Checks one row of channels.tsv: type, component and unit.
void check_channel(const std::string& path, std::int64_t line, const BidsChannel& channel,
                   BidsCheck& check) {
  if (!is_bids_type(channel.type)) {
    // Types in lower case are a frequent fault, so they have their own message.
    const bool lower = is_bids_type(in_capitals(channel.type));
    check.error(path, lower ? "types in capitals" : "a type of BIDS, such as POS or GYRO",
                shown(channel.type), line);
    return;
  }
  if (!is_bids_component(channel.component)) {
    check.error(path, "component x, y, z, quat_x, quat_y, quat_z, quat_w or n/a",
                shown(channel.component), line);
  } else if (!fits(channel)) {
    check.error(path, "a component of " + channel.type, shown(channel.component), line);
  }
  // These types may have any unit.
  const bool free_unit = is_one_of(channel.type, {"MAGN", "MISC", "VEL"});
  if (channel.units.empty() || (!free_unit && unit_scale(channel.type, channel.units) == 0.0)) {
    check.warning(path, "a unit of " + channel.type, shown(channel.units), line);
  }
  // The parts of a quaternion have no unit, but angles have a unit.
  const bool quaternion = channel.component.starts_with("quat_");
  if (channel.type == "ORNT" && quaternion != (channel.units == "n/a")) {
    check.warning(path, quaternion ? "the unit n/a of a quaternion" : "rad or deg of an angle",
                  shown(channel.units), line);
  }
}

/// Checks for each tracked point and type that a quaternion has all four parts and a vector all
/// three.
void check_groups(const std::string& path, const std::vector<BidsChannel>& channels,
                  BidsCheck& check) {
  // The key is the tracked point and the type. A repeated component counts once.
  std::map<std::pair<std::string, std::string>, std::set<std::string>> groups;
  for (const BidsChannel& c : channels) {
    if (c.component != "n/a" && is_bids_type(c.type))
      groups[{c.tracked_point, c.type}].insert(c.component);
  }
  for (const auto& [key, parts] : groups) {
    const auto quaternion = static_cast<std::size_t>(
        std::count_if(parts.begin(), parts.end(),
                      [](const std::string& part) { return part.starts_with("quat_"); }));
    if (quaternion != 0 && quaternion != 4) {
      check.error(path, "all four parts of the quaternion of " + shown(key.first),
                  std::to_string(quaternion));
    }
    const auto& [point, type] = key;
    if (parts.size() < 3 && is_one_of(type, {"POS", "VEL", "ACCEL", "ANGACCEL", "GYRO", "MAGN"})) {
      check.warning(path, "x, y and z of the " + type + " of " + shown(point),
                    std::to_string(parts.size()));
    }
  }
}

void check_status(const std::string& path, const TsvTable& table, BidsCheck& check) {
  const auto status = table.column("status");
  // The column is optional.
  if (!status) return;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].size() <= *status) continue;
    if (is_one_of(table.rows[i][*status], {"good", "bad", "n/a"})) continue;
    check.error(path, "status good or bad", shown(table.rows[i][*status]), line_of_row(i));
  }
}

/// Checks channels.tsv row by row. Returns its channels; empty if the table can't be understood.
std::vector<BidsChannel> check_channels(const std::string& path, BidsCheck& check) {
  const auto table = check.table_of(path);
  if (!table) return {};
  check_columns(path, *table, check);
  // check_columns() has reported the missing column.
  const auto channels = channels_of(*table, path);
  if (!channels) return {};
  std::set<std::string> names;
  for (std::size_t i = 0; i < channels->size(); ++i) {
    const std::int64_t line = line_of_row(i);
    // In a row with a wrong number of cells, the column of a cell is not known.
    if (!check.is_whole_row(path, *table, i)) continue;
    check_channel(path, line, (*channels)[i], check);
    if (!names.insert((*channels)[i].name).second) {
      check.error(path, "channels with different names", shown((*channels)[i].name) + " again",
                  line);
    }
  }
  check_status(path, *table, check);
  check_groups(path, *channels, check);
  return *channels;
}

/// The names of the reference frames in a channels.json file, which stand in reference_frame:
/// Levels. Adds a warning if SpatialAxes are invalid.
std::set<std::string> described_frames(const std::string& path, BidsCheck& check) {
  std::set<std::string> out;
  const auto json = check.json_of(path);
  if (!json) return out;
  for (const auto& [name, letters] : frames_in(*json)) {
    out.insert(name);
    // "n/a" is allowed: the directions are then unknown.
    if (!letters || *letters == "n/a" || axes_of_letters(*letters)) continue;
    check.warning(path, "SpatialAxes of three letters A or P, L or R, S or I", shown(*letters));
  }
  return out;
}

/// Checks that channels.json describes each reference frame in channels.tsv.
void check_frames(const std::string& motion_tsv, const std::vector<BidsChannel>& channels,
                  BidsCheck& check) {
  std::set<std::string> frames;
  // "n/a" and an empty cell do not name a frame.
  for (const BidsChannel& c : channels) frames.insert(c.reference_frame);
  frames.erase("n/a");
  frames.erase("");
  if (frames.empty()) return;
  const auto paths = check.inherited(motion_tsv, "channels.json");
  // Every inherited file may describe frames.
  std::set<std::string> described;
  for (const std::string& path : paths) described.merge(described_frames(path, check));
  for (const std::string& one : frames) {
    if (described.contains(one)) continue;
    check.warning(paths.empty() ? sidecar(motion_tsv, "channels.json") : paths.back(),
                  "the reference frame " + shown(one), "none");
  }
}

/// The merged keys of all motion.json files that apply to the motion.tsv. A nearer file overrides
/// the others. If one file can't be read, the result is empty, because incomplete keys would give
/// wrong findings.
std::optional<FoundJson> merged_json(const std::string& motion_tsv, BidsCheck& check) {
  const auto paths = check.inherited(motion_tsv, "motion.json");
  if (paths.empty()) {
    check.error(sidecar(motion_tsv, "motion.json"), "this file", "none");
    return std::nullopt;
  }
  FoundJson all = FoundJson::object();
  for (const std::string& path : paths) {
    const auto json = check.json_of(path);
    if (!json) return std::nullopt;
    all.update(*json);
  }
  return all;
}

/// Compares the keys in motion.json with the channels and the rows. A key that is absent is not
/// compared.
class FactsCheck {
 public:
  FactsCheck(std::string path, const FoundJson& json, BidsCheck& check)
      : path_(std::move(path)), json_(json), check_(check) {}

  std::optional<double> number(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) return std::nullopt;
    if (found->is_number()) return found->get<double>();
    check_.error(path_, std::string("a number ") + key, "another value");
    return std::nullopt;
  }

  /// Compares a count. An absent count is not a fault.
  void count(const std::string& key, std::size_t is) const {
    const auto stated = number(key.c_str());
    if (stated && *stated != static_cast<double>(is)) {
      check_.error(path_, fmt::format("{} {}", key, is), fmt::format("{}", *stated));
    }
  }

  /// Checks TaskName and TrackingSystemName. In BIDS, the task label consists of the letters and
  /// digits of TaskName.
  void names(std::string_view task) const {
    const std::string name = text_in(json_, "TaskName");
    std::string label;
    for (const char c : name) {
      if (is_bids_label(std::string_view(&c, 1))) label += c;
    }
    if (name.empty()) {
      check_.error(path_, "a TaskName", "none");
    } else if (label != task) {
      check_.warning(path_, "a TaskName that gives the label " + shown(task), shown(name));
    }
    if (text_in(json_, "TrackingSystemName").empty())
      check_.warning(path_, "a TrackingSystemName", "none");
  }

  /// Compares the counts of channels and tracked points with channels.tsv.
  void counts(const std::vector<BidsChannel>& channels) const {
    for (const auto& [key, is] : bids_counts(channels)) count(key, is);
    const auto misc = static_cast<std::size_t>(
        std::count_if(channels.begin(), channels.end(),
                      [](const BidsChannel& channel) { return channel.type == "MISC"; }));
    // Both spellings of the key are accepted.
    count("MISCChannelCount", misc);
    count("MiscChannelCount", misc);
  }

  /// Compares rates and duration with the number of rows and the latencies.
  void times(const BidsRowsSummary& rows) const {
    const auto rate = number("SamplingFrequency");
    if (!rate || !(*rate > 0.0)) {
      check_.error(path_, "a SamplingFrequency above 0", rate ? fmt::format("{}", *rate) : "none");
      return;
    }
    const auto n = static_cast<double>(rows.rows);
    // The tolerance is 2 % and two rows, because rates are nominal.
    const auto duration = number("RecordingDuration");
    if (duration && rows.rows > 0 &&
        std::abs(*duration - n / *rate) > 0.02 * n / *rate + 2.0 / *rate) {
      check_.warning(path_,
                     fmt::format("a RecordingDuration of {} rows at {:g} Hz, {:.6g} s", rows.rows,
                                 *rate, n / *rate),
                     fmt::format("{:g}", *duration));
    }
    // With fewer than two latencies, the rate can't be computed.
    const auto effective = number("SamplingFrequencyEffective");
    if (!effective || !rows.last_latency_s || *rows.last_latency_s <= *rows.first_latency_s) return;
    const double by_latency =
        static_cast<double>(rows.latencies - 1) / (*rows.last_latency_s - *rows.first_latency_s);
    if (std::abs(*effective - by_latency) <= 0.01 * by_latency) return;
    check_.warning(
        path_,
        fmt::format("a SamplingFrequencyEffective of {:.6g}, as the latencies say", by_latency),
        fmt::format("{:g}", *effective));
  }

 private:
  std::string path_;
  const FoundJson& json_;
  BidsCheck& check_;
};

}  // namespace

void check_bids_system(const std::string& motion_tsv, BidsCheck& check) {
  const auto tables = check.inherited(motion_tsv, "channels.tsv");
  std::vector<BidsChannel> channels;
  // Without channels.tsv, the rows are compared with each other only.
  if (tables.empty()) {
    check.error(sidecar(motion_tsv, "channels.tsv"), "this file", "none");
  } else {
    // In BIDS only the nearest table is used; tables are not merged.
    channels = check_channels(tables.back(), check);
    check_frames(motion_tsv, channels, check);
  }
  const BidsRowsSummary rows = check_bids_rows(motion_tsv, channels, check);
  const auto json = merged_json(motion_tsv, check);
  if (!json) return;
  // Findings name the nearest file.
  const FactsCheck facts(check.inherited(motion_tsv, "motion.json").back(), *json, check);
  const auto name = parse_bids_name(file_name(motion_tsv));
  facts.names(name ? name->label("task") : "");
  // If channels.tsv could not be read, its counts are not known.
  if (!channels.empty()) facts.counts(channels);
  facts.times(rows);
}

}  // namespace kinalign
