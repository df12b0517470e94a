// SPDX-License-Identifier: Apache-2.0
// Checks the data set as a whole: positions and names of files, and the tables about all files.
#include "kinalign/formats/bids/check.h"

#include "kinalign/formats/bids/check_context.h"
#include "kinalign/formats/bids/json_text.h"

#include <fmt/format.h>
#include <fnmatch.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// The limit protects the memory. No useful table or JSON file is larger.
constexpr std::size_t largest_text = std::size_t{16} << 20;

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& all, std::string_view one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

// Files and folders that BIDS allows at the top. Data types other than motion are allowed, but not
// checked.
constexpr std::array<std::string_view, 14> top_files{"dataset_description.json",
                                                     "README",
                                                     "README.md",
                                                     "README.rst",
                                                     "README.txt",
                                                     "CHANGES",
                                                     "LICENSE",
                                                     "CITATION.cff",
                                                     "participants.tsv",
                                                     "participants.json",
                                                     "samples.tsv",
                                                     "samples.json",
                                                     "scans.json",
                                                     "sessions.json"};
constexpr std::array<std::string_view, 5> top_folders{"sourcedata", "derivatives", "code",
                                                      "stimuli", "phenotype"};
constexpr std::array<std::string_view, 12> other_types{
    "anat", "beh", "dwi", "eeg", "fmap", "func", "ieeg", "meg", "micr", "nirs", "perf", "pet"};
constexpr std::array<std::string_view, 10> motion_endings{
    "motion.tsv",  "motion.json",   "channels.tsv", "channels.json", "events.tsv",
    "events.json", "physio.tsv.gz", "physio.json",  "stim.tsv.gz",   "stim.json"};
// These files may also be in a folder above `motion`. They then apply to all files below that
// folder.
constexpr std::array<std::string_view, 4> inherited_endings{"motion.json", "channels.json",
                                                            "channels.tsv", "events.json"};
// BIDS requires this order of the entities (pairs such as sub-01) in a name.
constexpr std::array<std::string_view, 8> entity_order{"sub", "ses", "task",      "tracksys",
                                                       "acq", "run", "recording", "desc"};

/// True if a pattern matches the path. Patterns are those of .gitignore: a name at any depth, a
/// path from the top, or a folder with its whole content.
bool is_ignored(const std::vector<std::string>& patterns, std::string_view path) {
  for (std::string_view pattern : patterns) {
    // A pattern without a slash may match a name at any depth.
    if (pattern.starts_with('/')) pattern.remove_prefix(1);
    if (pattern.ends_with('/')) pattern.remove_suffix(1);
    const bool anywhere = pattern.find('/') == std::string_view::npos;
    std::string_view before;
    for (const std::string_view part : split(path, '/')) {
      // The path up to this part. If a folder matches, its whole content matches.
      before = path.substr(0, static_cast<std::size_t>(part.data() + part.size() - path.data()));
      const std::string name(anywhere ? part : before);
      if (::fnmatch(std::string(pattern).c_str(), name.c_str(), FNM_PATHNAME) == 0) return true;
    }
  }
  return false;
}

/// The patterns in .bidsignore. Long patterns and patterns with many '*' are dropped, because
/// matching would take too long.
std::vector<std::string> ignore_patterns(BidsCheck& check) {
  std::vector<std::string> out;
  if (!check.listing.has(".bidsignore")) return out;
  const auto text = check.text_of(".bidsignore");
  constexpr std::size_t longest_pattern = 200, most_patterns = 1000;
  // The file has no header line, so one is added.
  for (const auto& row : read_tsv("pattern\n" + text.value_or("")).rows) {
    const std::string& pattern = row.front();
    const bool good = !pattern.empty() && pattern.front() != '#' &&
                      pattern.size() <= longest_pattern &&
                      std::count(pattern.begin(), pattern.end(), '*') <= 3;
    if (good && out.size() < most_patterns) out.push_back(pattern);
  }
  return out;
}

/// True for a label of letters, digits and '+'. BIDS 1.9 allows letters and digits only, and BIDS
/// 1.11 allows '+', too.
bool is_label(std::string_view label) {
  std::string without(label);
  std::erase(without, '+');
  return !label.empty() && (without.empty() || is_bids_label(without));
}

/// Checks the entities of a name: they must be known, in the order of BIDS, and have valid labels.
void check_entities(const std::string& path, const BidsName& name, BidsCheck& check) {
  std::size_t next = 0;
  for (const auto& [key, label] : name.entities) {
    // The search begins at the position of the last entity, so that a wrong order is found.
    const auto* const known = std::find(entity_order.begin() + next, entity_order.end(), key);
    if (known == entity_order.end()) {
      check.error(path, "entities sub, ses, task, tracksys, acq, run in this order", shown(key));
      return;
    }
    // The next search begins behind this entity, because each entity may occur only once.
    next = static_cast<std::size_t>(known - entity_order.begin()) + 1;
    if (!is_label(label)) check.error(path, "letters and digits for " + key, shown(label));
    const bool digits =
        std::all_of(label.begin(), label.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (key == "run" && !digits) check.error(path, "digits for run", shown(label));
  }
}

struct Place {
  std::string subject, session;  // labels of the folders that contain the file
};

/// Checks the name of a file below sub-.../ or sub-.../ses-.../. The name must repeat subject and
/// session of these folders.
void check_file_name(const std::string& path, const Place& place, std::string_view type,
                     BidsCheck& check) {
  const auto name = parse_bids_name(file_name(path));
  if (!name) {
    check.error(path, "a name of key-label parts and a suffix",
                std::string(shown(file_name(path))));
    return;
  }
  check_entities(path, *name, check);
  if (name->label("sub") != place.subject) {
    check.error(path, "sub-" + place.subject + ", as in the name of the folder",
                "sub-" + shown(name->label("sub")));
  }
  if (name->label("ses") != place.session) {
    check.error(path,
                place.session.empty() ? "no ses, because there is no session folder"
                                      : "ses-" + place.session + ", as in the name of the folder",
                "ses-" + shown(name->label("ses")));
  }
  if (type != "motion") return;
  // Other data types have other endings, which are not checked.
  if (!contains(motion_endings, name->ending)) {
    check.error(path, "motion.tsv, motion.json, channels.tsv, channels.json or events.tsv",
                shown(name->ending));
    return;
  }
  // events.tsv and its sidecar files belong to the task, not to a tracking system.
  const bool of_system =
      name->ending.starts_with("motion.") || name->ending.starts_with("channels.");
  if (name->label("task").empty()) check.error(path, "a task", "none");
  if (of_system && name->label("tracksys").empty()) check.error(path, "a tracksys", "none");
}

/// True for a table that may be directly in the folder of a subject or session.
bool is_table_of_subject(std::string_view ending) {
  return ending == "scans.tsv" || ending == "scans.json" || ending == "sessions.tsv" ||
         ending == "sessions.json";
}

/// Checks the path of a file below a subject's folder. `parts`: its folders and its name.
void check_subject_path(const std::string& path, std::vector<std::string_view> parts,
                        BidsCheck& check) {
  // Both "sub-" and "ses-" have four characters.
  Place place{std::string(parts.front().substr(4)), ""};
  if (!is_label(place.subject))
    check.error(path, "letters and digits for sub", shown(place.subject));
  parts.erase(parts.begin());
  if (parts.size() > 1 && parts.front().starts_with("ses-")) {
    place.session = parts.front().substr(4);
    if (!is_label(place.session))
      check.error(path, "letters and digits for ses", shown(place.session));
    parts.erase(parts.begin());
  }
  // The file is directly in the folder of a subject or session.
  if (parts.size() == 1) {
    const auto name = parse_bids_name(parts.front());
    if (name && (is_table_of_subject(name->ending) || contains(inherited_endings, name->ending))) {
      check_file_name(path, place, "", check);
    } else {
      check.error(path, "scans.tsv, sessions.tsv or an inherited file in a subject's folder",
                  "another file");
    }
    return;
  }
  if (parts.size() == 2 && parts.front() == "motion")
    return check_file_name(path, place, "motion", check);
  // Files of other data types are not checked here.
  if (contains(other_types, parts.front())) return;
  check.error(path, "a folder of a data type of BIDS, such as motion", shown(parts.front()));
}

/// Checks the path of any file. The file may be at the top, below a subject's folder, or below
/// another folder of BIDS.
void check_path(const std::string& path, BidsCheck& check) {
  const auto parts = split(path, '/');
  const std::string_view first = parts.front();
  // Hidden files, such as .bidsignore, are not checked.
  if (first.starts_with('.')) return;
  if (parts.size() > 1 && first.starts_with("sub-")) return check_subject_path(path, parts, check);
  // The path is in a folder at the top that does not belong to a subject.
  if (parts.size() > 1) {
    if (!contains(top_folders, first)) {
      check.error(path, "a folder sub-..., sourcedata, derivatives, code, stimuli or phenotype",
                  shown(first));
    }
    return;
  }
  if (contains(top_files, first)) return;
  // Such files at the top apply to all subjects.
  const auto name = parse_bids_name(first);
  if (name && contains(inherited_endings, name->ending)) return check_entities(path, *name, check);
  check.error(path, "a file that BIDS knows; others belong into sourcedata/ or .bidsignore",
              shown(first));
}

/// Checks dataset_description.json: required keys, types of values, and a license.
void check_description(BidsCheck& check) {
  const std::string path = "dataset_description.json";
  if (!check.listing.has(path)) return check.error(path, "this file", "none");
  const auto json = check.json_of(path);
  if (!json) return;
  for (const char* key : {"Name", "BIDSVersion"}) {
    if (text_in(*json, key).empty()) check.error(path, std::string("a text ") + key, "none");
  }
  // Without DatasetType, the data set is raw.
  const std::string type = json->contains("DatasetType") ? text_in(*json, "DatasetType") : "raw";
  if (type != "raw" && type != "derivative") {
    check.error(path, "DatasetType raw or derivative", shown(type));
  }
  if (type == "derivative" && !json->contains("GeneratedBy")) {
    check.error(path, "GeneratedBy, which a derivative needs", "none");
  }
  if (const auto authors = json->find("Authors"); authors != json->end() && !authors->is_array()) {
    check.error(path, "an array of Authors", "another value");
  }
  if (!json->contains("License")) check.warning(path, "a License", "none");
}

void check_readme(BidsCheck& check) {
  for (const char* name : {"README", "README.md", "README.rst", "README.txt"}) {
    if (check.listing.has(name)) return;
  }
  check.warning("README", "this file", "none");
}

std::set<std::string> subjects_of(const BidsListing& listing) {
  std::set<std::string> out;
  // Many paths contain the same subject. The set keeps each name once.
  for (const std::string& path : listing.paths) {
    if (path.starts_with("sub-")) out.insert(path.substr(0, path.find('/')));
  }
  return out;
}

/// Compares the rows of participants.tsv with the folders of subjects.
void check_participant_rows(const std::string& path, const TsvTable& table, BidsCheck& check) {
  const std::set<std::string> subjects = subjects_of(check.listing);
  std::set<std::string> listed;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const std::int64_t line = line_of_row(i);
    check.is_whole_row(path, table, i);
    if (!listed.insert(row.front()).second) {
      check.error(path, "each participant once", shown(row.front()) + " again", line);
    }
    // A participant may have data of another type, or no data yet.
    if (!subjects.contains(row.front())) {
      check.warning(path, "a folder of each participant", "no folder of " + shown(row.front()),
                    line);
    }
  }
  // A subject without a row in the table is an error.
  for (const std::string& subject : subjects) {
    if (!listed.contains(subject)) check.error(path, "a row of " + shown(subject), "none");
  }
}

/// Checks participants.tsv. Also checks that participants.json describes each further column.
void check_participants(BidsCheck& check) {
  const std::string path = "participants.tsv", described = "participants.json";
  if (!check.listing.has(path)) return check.warning(path, "this file", "none");
  const auto table = check.table_of(path);
  if (!table) return;
  if (table->columns.empty() || table->columns.front() != "participant_id") {
    return check.error(path, "participant_id as the first column",
                       table->columns.empty() ? "none" : shown(table->columns.front()), 1);
  }
  check_participant_rows(path, *table, check);
  // Without participants.json, no column is described.
  const auto json = check.listing.has(described) ? check.json_of(described) : std::nullopt;
  for (std::size_t c = 1; c < table->columns.size(); ++c) {
    if (json && json->contains(table->columns[c])) continue;
    check.warning(described, "a description of the column " + shown(table->columns[c]), "none");
  }
}

/// Checks one scans.tsv. Each row must name an existing file, and each motion.tsv of the folder
/// must have a row.
void check_scans(const std::string& path, BidsCheck& check) {
  const auto table = check.table_of(path);
  if (!table) return;
  const auto file = table->column("filename"), time = table->column("acq_time");
  if (!file) return check.error(path, "a column filename", "none", 1);
  // Paths in scans.tsv are relative to the folder of the table.
  const std::string above(folder(path));
  std::set<std::string> listed;
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    const auto& row = table->rows[i];
    const std::int64_t line = line_of_row(i);
    // A row with a wrong number of cells can't be read by column.
    if (!check.is_whole_row(path, *table, i)) continue;
    if (!check.listing.has(above + row[*file]))
      check.error(path, "an existing file", shown(row[*file]), line);
    listed.insert(above + row[*file]);
    if (time && row[*time] != "n/a" && !is_acq_time(row[*time])) {
      check.error(path, "acq_time YYYY-MM-DDThh:mm:ss[.000000][Z]", shown(row[*time]), line);
    }
  }
  // Files in this folder without a row in the table.
  for (const std::string& one : check.listing.paths) {
    if (one.starts_with(above + "motion/") && one.ends_with("_motion.tsv") &&
        !listed.contains(one)) {
      check.warning(path, "a row of each motion.tsv", "no row of " + std::string(file_name(one)));
    }
  }
}

/// Checks that the motion.tsv of a sidecar file exists. Otherwise the data file is missing or has a
/// wrong name.
void check_unpaired(const std::string& path, BidsCheck& check) {
  // The name of the data file follows from the name of the sidecar file.
  for (const std::string_view ending : {"motion.json", "channels.tsv"}) {
    if (path.find("/motion/") == std::string::npos || !path.ends_with("_" + std::string(ending)))
      continue;
    const std::string data = path.substr(0, path.size() - ending.size()) + "motion.tsv";
    if (!check.listing.has(data)) {
      check.error(path, "the motion.tsv that belongs to this file", "none");
    }
  }
}

}  // namespace

void BidsCheck::error(const std::string& path, std::string expected, std::string found,
                      std::int64_t line) {
  findings.push_back({Severity::error, Error{path, line, std::move(expected), std::move(found)},
                      "the data set is not valid BIDS", ""});
}

void BidsCheck::warning(const std::string& path, std::string expected, std::string found,
                        std::int64_t line) {
  add_warning(findings, {path, line, std::move(expected), std::move(found)}, "BIDS recommends it");
}

std::optional<std::string> BidsCheck::text_of(const std::string& path) {
  std::string text;
  const auto read = listing.read(path, [&](std::string_view piece) -> Result<void> {
    text += piece;
    // The bytes are counted while they arrive.
    if (text.size() <= largest_text) return {};
    return refuse(path, "a file of at most 16 MiB", "a larger file");
  });
  if (read) return text;
  unreadable(path, read.error());
  return std::nullopt;
}

void BidsCheck::unreadable(const std::string& path, Error what) {
  // The error gets the path in the listing instead of the path on the disk.
  what.file = path;
  findings.push_back({Severity::error, std::move(what), "the file can't be checked", ""});
}

bool BidsCheck::is_whole_row(const std::string& path, const TsvTable& table, std::size_t row) {
  const std::size_t cells = table.rows[row].size();
  if (cells == table.columns.size()) return true;
  error(path, fmt::format("{} cells", table.columns.size()), std::to_string(cells),
        line_of_row(row));
  return false;
}

std::optional<TsvTable> BidsCheck::table_of(const std::string& path) {
  const auto text = text_of(path);
  if (!text) return std::nullopt;
  return read_tsv(*text);
}

std::optional<Json> BidsCheck::json_of(const std::string& path) {
  const auto text = text_of(path);
  if (!text) return std::nullopt;
  auto json = parse_bids_json(*text, path);
  if (json) return *std::move(json);
  // A JSON file that can't be read is an error of the data set and not of the checker.
  error(path, json.error().expected, json.error().found);
  return std::nullopt;
}

std::vector<std::string> BidsCheck::inherited(const std::string& path,
                                              std::string_view ending) const {
  const auto own = parse_bids_name(file_name(path));
  std::vector<std::string> out;
  if (!own) return out;
  for (const std::string& other : listing.paths) {
    // Only files in the same folder or above can apply. The ending is compared again below, because
    // one ending may be the end of another.
    if (!other.ends_with(ending) || !path.starts_with(folder(other))) continue;
    const auto name = parse_bids_name(file_name(other));
    if (!name || name->ending != ending) continue;
    const bool holds =
        // If a file lacks an entity, it applies to all values of this entity.
        std::all_of(name->entities.begin(), name->entities.end(),
                    [&](const auto& entity) { return own->label(entity.first) == entity.second; });
    if (holds) out.push_back(other);
  }
  // The nearest file comes last, so that its keys override the others when the files are merged.
  std::stable_sort(out.begin(), out.end(), [](const std::string& a, const std::string& b) {
    return folder(a).size() < folder(b).size();
  });
  return out;
}

Result<BidsListing> list_bids_folder(FileSystem& files, const std::string& folder) {
  namespace fs = std::filesystem;
  BidsListing listing;
  std::error_code failed;
  // Links to folders are not followed, so the loop always ends.
  for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    if (at->is_regular_file(failed)) {
      listing.paths.insert(at->path().lexically_relative(folder).generic_string());
    }
  }
  if (failed) return refuse(folder, "a folder that can be read", failed.message());
  // `folder` is copied, because the listing exists longer than this call.
  listing.read = [&files, folder](const std::string& path, const FileSink& use) -> Result<void> {
    InputFile file = KA_TRY(InputFile::open(files, folder + "/" + path));
    for (auto piece = KA_TRY(file.next()); !piece.empty(); piece = KA_TRY(file.next())) {
      KA_TRY(use(piece));
    }
    return {};
  };
  return listing;
}

Findings check_bids(const BidsListing& listing) {
  BidsCheck check(listing);
  check_description(check);
  check_readme(check);
  check_participants(check);
  // .bidsignore is read first. Files that match its patterns are not checked.
  const auto ignored = ignore_patterns(check);
  bool motion = false;
  for (const std::string& path : listing.paths) {
    if (is_ignored(ignored, path)) continue;
    check_path(path, check);
    // Only folders of subjects contain data and sidecar files.
    if (!path.starts_with("sub-")) continue;
    check_unpaired(path, check);
    if (path.ends_with("_scans.tsv")) check_scans(path, check);
    if (path.ends_with("_motion.tsv") && path.find("/motion/") != std::string::npos) {
      check_bids_system(path, check);
      motion = true;
    }
  }
  if (!motion) check.error("sub-*/motion", "a motion.tsv", "none");
  return std::move(check.findings);
}

}  // namespace kinalign
