// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/system.h"

#include "kinalign/formats/bids/json_text.h"
#include "kinalign/formats/bids/names.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::string_view motion_ending = "motion.tsv";
// The largest files that are read into memory, bytes.
constexpr std::size_t largest_table = std::size_t{16} << 20, largest_json = std::size_t{1} << 20;

struct SidecarPaths {
  // scans_tsv is empty if the path has no folder motion/.
  std::string channels_tsv, motion_json, channels_json, scans_tsv;
};

/// The path of scans.tsv, which is in the folder above motion/. Its name contains the subject and
/// the session.
std::string scans_path_of(const std::string& path) {
  const auto name = parse_bids_name(file_name(path));
  std::string_view above = folder(path);
  if (!name || !above.ends_with("motion/")) return "";
  above.remove_suffix(std::string_view("motion/").size());
  std::string out = std::string(above) + "sub-" + std::string(name->label("sub"));
  if (!name->label("ses").empty()) out += "_ses-" + std::string(name->label("ses"));
  return out + "_scans.tsv";
}

// The paths of the sidecar files, which have the name of the data file with another ending.
SidecarPaths paths_of(const std::string& path) {
  const std::string stem = path.substr(0, path.size() - motion_ending.size());
  return {stem + "channels.tsv", stem + "motion.json", stem + "channels.json", scans_path_of(path)};
}

// True if the file can be opened. One byte is enough to know.
bool is_there(FileSystem& files, const std::string& path) {
  return !path.empty() && InputFile::open(files, path, 1).has_value();
}

Result<nlohmann::ordered_json> read_json(FileSystem& files, const std::string& path) {
  return parse_bids_json(KA_TRY(read_whole(files, path, largest_json)), path);
}

Result<double> read_rate(FileSystem& files, const std::string& path) {
  const auto json = KA_TRY(read_json(files, path));
  const auto rate = json.find("SamplingFrequency");
  const bool number = rate != json.end() && rate->is_number();
  // The rate must be a number and not a text.
  const double hz = number ? rate->get<double>() : 0.0;
  if (hz >= 1e-3 && hz <= 1e6) return hz;
  return refuse(path, "a SamplingFrequency of 0.001 to 1,000,000",
                number ? std::to_string(hz) : "none");
}

/// The start of the file in scans.tsv. The result is empty if file, row or a valid time is missing.
Result<std::optional<Time>> read_onset(FileSystem& files, const std::string& scans,
                                       const std::string& path) {
  std::optional<Time> out;
  if (!is_there(files, scans)) return out;
  const TsvTable table = read_tsv(KA_TRY(read_whole(files, scans, largest_table)));
  const auto file = table.column("filename"), time = table.column("acq_time");
  if (!file || !time) return out;
  const std::string wanted = "motion/" + std::string(file_name(path));
  // Rows of other files are skipped. If several rows match, the last one is used.
  for (const auto& row : table.rows) {
    if (row.size() <= std::max(*file, *time) || row[*file] != wanted) continue;
    out = parse_acq_time(row[*time]);
  }
  return out;
}

}  // namespace

bool named_as_bids_motion(std::string_view path) {
  const auto name = parse_bids_name(file_name(path));
  // The name must contain the tracking system, because a folder may contain files of several
  // systems.
  return name && name->ending == motion_ending && !name->label("tracksys").empty();
}

bool has_positions(const BidsSystem& system) {
  return std::any_of(system.channels.begin(), system.channels.end(),
                     [](const BidsChannel& channel) { return channel.type == "POS"; });
}

std::vector<std::string> bids_sidecar_paths(FileSystem& files, const std::string& path) {
  const SidecarPaths paths = paths_of(path);
  std::vector<std::string> out;
  for (const std::string* one :
       {&paths.channels_tsv, &paths.motion_json, &paths.channels_json, &paths.scans_tsv}) {
    if (is_there(files, *one)) out.push_back(*one);
  }
  return out;
}

Result<BidsSystem> read_bids_system(FileSystem& files, const std::string& path) {
  if (!named_as_bids_motion(path)) {
    return refuse(path, "a name such as sub-01_task-walk_tracksys-suit_motion.tsv", "another name");
  }
  const SidecarPaths paths = paths_of(path);
  BidsSystem out;
  const std::string channels = KA_TRY(read_whole(files, paths.channels_tsv, largest_table));
  out.channels = KA_TRY(channels_of(read_tsv(channels), paths.channels_tsv));
  out.rate_hz = KA_TRY(read_rate(files, paths.motion_json));
  if (is_there(files, paths.channels_json)) {
    out.letters = frames_in(KA_TRY(read_json(files, paths.channels_json)));
  }
  // Without an onset, the stamps of a file begin at 0.
  out.onset = KA_TRY(read_onset(files, paths.scans_tsv, path));
  return out;
}

}  // namespace kinalign
