// SPDX-License-Identifier: Apache-2.0
// Copies of a good data set, each broken in one place, and the findings about them.
#include "tests/formats/bids/data_set.h"
#include "tests/formats/reading.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

namespace doctest {
template <>
struct StringMaker<std::vector<std::string>> {
  static String convert(const std::vector<std::string>& texts) {
    std::string all;
    for (const std::string& text : texts) all += text + "\n";
    return all.c_str();
  }
};
}  // namespace doctest

using namespace kinalign;

namespace {

const DataSet& good_set() {
  static const DataSet set = bids_data_set(bids_streams(1));
  return set;
}

const std::string suit = bids_path(bids_system("suit"), ""),
                  imu = bids_path(bids_system("imu"), ""), scans = bids_scans_path(bids_system(""));
std::string of_suit(const char* ending) { return bids_path(bids_system("suit"), ending); }

/// The findings in a broken data set, without those in the good one: severity and text.
std::vector<std::string> found_when(const std::function<void(DataSet&)>& broken) {
  DataSet set = good_set();
  broken(set);
  std::vector<std::string> out;
  for (const Finding& finding : check_set(set)) {
    out.push_back(std::string(to_string(finding.severity)) + " " + text_of(finding));
  }
  return out;
}

using Texts = std::vector<std::string>;

/// Replaces the first `from` in a file by `to`.
void put(DataSet& set, const std::string& path, const std::string& from, const std::string& to) {
  std::string& text = set.at(path);
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
}

void rename(DataSet& set, const std::string& from, const std::string& to) {
  set[to] = set.at(from);
  set.erase(from);
}

}  // namespace

TEST_CASE("a good data set has no findings") {
  CHECK(found_when([](DataSet&) {}).empty());
}

TEST_CASE(
    "files beside motion.tsv that are missing are found, which the official validator does not") {
  CHECK(found_when([](DataSet& set) { set.erase(of_suit("channels.tsv")); }) ==
        Texts{"error " + of_suit("channels.tsv") + ": expected this file, found none"});
  CHECK(found_when([](DataSet& set) { set.erase(of_suit("motion.json")); }) ==
        Texts{"error " + of_suit("motion.json") + ": expected this file, found none"});
  CHECK(found_when([](DataSet& set) { set.erase(of_suit("channels.json")); }) ==
        Texts{"warning " + of_suit("channels.json") +
              ": expected the reference frame global, found none"});
}

TEST_CASE("a sidecar that holds by inheritance is no missing file") {
  CHECK(found_when([](DataSet& set) {
          rename(set, of_suit("motion.json"), "task-Walk_tracksys-suit_motion.json");
          rename(set, of_suit("channels.json"), "sub-03/sub-03_tracksys-suit_channels.json");
        }) == Texts{});
  CHECK(found_when([](DataSet& set) {
          rename(set, of_suit("motion.json"), "task-Run_tracksys-suit_motion.json");
        }) == Texts{"error " + of_suit("motion.json") + ": expected this file, found none"});
}

TEST_CASE("rows that do not fit the channels are found, which the official validator does not") {
  const std::string rows = of_suit("motion.tsv");
  CHECK(found_when([&](DataSet& set) {
          std::string names;
          for (int c = 0; c < 22; ++c) names += (c > 0 ? "\tcolumn" : "column") + std::to_string(c);
          set[rows] = names + "\n" + set[rows];
        }) ==
        Texts{"error " + rows +
              ":1: expected only rows of numbers, without a line of column names, found column0"});
  CHECK(found_when([&](DataSet& set) {
          std::string& text = set[rows];
          for (std::size_t at = text.find('\n'); at != std::string::npos;
               at = text.find('\n', at + 3)) {
            text.insert(at, "\t1");
          }
        }) ==
        Texts{"error " + rows + ": expected 22 columns, one per row of channels.tsv, found 23"});
  CHECK(found_when([&](DataSet& set) { put(set, rows, "\n", "\t1\n"); }) ==
        Texts{"error " + rows +
                  ":2: expected rows of 23 cells, like the first row, found 22, and 58 more",
              "error " + rows + ": expected 22 columns, one per row of channels.tsv, found 23"});
  CHECK(found_when([&](DataSet& set) { put(set, rows, "\n", "\n\n"); }) ==
        Texts{"error " + rows + ":2: expected no empty lines, found an empty line"});
  CHECK(found_when([&](DataSet& set) { set[rows] = ""; })[0] ==
        "error " + rows + ": expected rows of samples, found none");
  const std::string points = bids_path(bids_system("kinect"), "motion.tsv");
  CHECK(found_when([&](DataSet& set) { put(set, points, "n/a", "NaN"); })
            .at(0)
            .find(": expected n/a for what is missing, found NaN") != std::string::npos);
  CHECK(found_when([&](DataSet& set) { put(set, points, "n/a", ""); })
            .at(0)
            .find(": expected n/a for what is missing, found an empty cell") != std::string::npos);
  CHECK(found_when([&](DataSet& set) { put(set, points, "n/a", "lost"); })
            .at(0)
            .find(": expected a number or n/a, found lost") != std::string::npos);
}

TEST_CASE("latencies that do not rise and quaternions of another length are found") {
  const std::string rows = of_suit("motion.tsv");
  CHECK(found_when([&](DataSet& set) {
          const std::size_t second = set[rows].find('\n') + 1;
          const std::size_t tab = set[rows].find('\t', second);
          set[rows].replace(second, tab - second, "0");
        }) == Texts{"error " + rows + ":2: expected rising latencies, found 0"});
}

TEST_CASE("channels that BIDS does not know are found") {
  const std::string path = of_suit("channels.tsv");
  const auto with = [&](const std::string& from, const std::string& to) {
    const auto all = found_when([&](DataSet& set) { put(set, path, from, to); });
    return all.empty() ? "" : all[0];
  };
  CHECK(with("name\tcomponent", "component\tname") ==
        "error " + path + ":1: expected name as column 1, found component");
  CHECK(with("\tunits", "\tunit") ==
        "error " + path + ":1: expected units as column 5, found unit");
  CHECK(with("\tPOS\t", "\tpos\t") ==
        "error " + path + ":3: expected types in capitals, found pos");
  CHECK(with("\tPOS\t", "\tPLACE\t") ==
        "error " + path + ":3: expected a type of BIDS, such as POS or GYRO, found PLACE");
  CHECK(with("Hips_POS_x\tx", "Hips_POS_x\tX") ==
        "error " + path +
            ":3: expected component x, y, z, quat_x, quat_y, quat_z, quat_w or n/a, found X");
  CHECK(with("Hips_POS_x\tx", "Hips_POS_x\tquat_x") ==
        "error " + path + ":3: expected a component of POS, found quat_x");
  CHECK(with("\tm\t", "\tfurlong\t") ==
        "warning " + path + ":3: expected a unit of POS, found furlong");
  CHECK(with("ORNT_quat_w\tquat_w\tORNT\tHips\tn/a", "ORNT_quat_w\tquat_w\tORNT\tHips\trad") ==
        "warning " + path + ":6: expected the unit n/a of a quaternion, found rad");
  CHECK(with("Hips_POS_y", "Hips_POS_x") ==
        "error " + path + ":4: expected channels with different names, found Hips_POS_x again");
  CHECK(with("Hips_ORNT_quat_w\tquat_w", "Hips_ORNT_quat_w\tquat_x") ==
        "error " + path + ": expected all four parts of the quaternion of Hips, found 3");
  CHECK(with("Hips_POS_x\tx\tPOS", "Hips_POS_x\tn/a\tMISC") ==
        "warning " + path + ": expected x, y and z of the POS of Hips, found 2");
  CHECK(with("\tglobal", "\troom") ==
        "warning " + of_suit("channels.json") + ": expected the reference frame room, found none");
  CHECK(with("\tHips\tglobal", "\tHips") == "error " + path + ":3: expected 7 cells, found 6");
}

TEST_CASE("facts in motion.json that contradict the channels or the rows are found") {
  const std::string path = of_suit("motion.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    return found_when([&](DataSet& set) { put(set, path, from, to); });
  };
  CHECK(with("\"MotionChannelCount\": 22", "\"MotionChannelCount\": 21") ==
        Texts{"error " + path + ": expected MotionChannelCount 22, found 21"});
  CHECK(with("\"POSChannelCount\": 9", "\"POSChannelCount\": 8") ==
        Texts{"error " + path + ": expected POSChannelCount 9, found 8"});
  CHECK(with("\"POSChannelCount\": 9", "\"POSChannelCount\": \"nine\"") ==
        Texts{"error " + path + ": expected a number POSChannelCount, found another value"});
  CHECK(with("\"TrackedPointsCount\": 3", "\"TrackedPointsCount\": 4") ==
        Texts{"error " + path + ": expected TrackedPointsCount 3, found 4"});
  CHECK(with("\"SamplingFrequency\"", "\"Frequency\"") ==
        Texts{"error " + path + ": expected a SamplingFrequency above 0, found none"});
  CHECK(with("\"SamplingFrequency\": 60.0", "\"SamplingFrequency\": 30.0") ==
        Texts{"warning " + path +
              ": expected a RecordingDuration of 60 rows at 30 Hz, 2 s, found 1"});
  CHECK(
      with("\"SamplingFrequencyEffective\": ", "\"SamplingFrequencyEffective\": 9")[0].starts_with(
          "warning " + path +
          ": expected a SamplingFrequencyEffective of 60, as the latencies say, found 9"));
  CHECK(with("\"TaskName\": \"Walk\"", "\"TaskName\": \"Run\"") ==
        Texts{"warning " + path + ": expected a TaskName that gives the label Walk, found Run"});
  CHECK(with("\"TaskName\"", "\"Task\"") ==
        Texts{"error " + path + ": expected a TaskName, found none"});
  CHECK(with("\"TrackingSystemName\"", "\"System\"") ==
        Texts{"warning " + path + ": expected a TrackingSystemName, found none"});
  CHECK(with("{", "[") ==
        Texts{"error " + path + ": expected a JSON object, found text that is no JSON"});
}

TEST_CASE("names and places that BIDS does not know are found") {
  const auto moved = [](const std::string& to) {
    return found_when([&](DataSet& set) { set[to] = "x"; });
  };
  CHECK(moved("notes.txt") ==
        Texts{"error notes.txt: expected a file that BIDS knows; others belong into "
              "sourcedata/ or .bidsignore, found notes.txt"});
  CHECK(moved("raw/a.bvh") ==
        Texts{"error raw/a.bvh: expected a folder sub-..., sourcedata, derivatives, "
              "code, stimuli or phenotype, found raw"});
  CHECK(moved("sourcedata/a.bvh") == Texts{});
  CHECK(moved("sub-03/eeg/anything") == Texts{});
  CHECK(moved("sub-03/kinect/a.csv") == Texts{"error sub-03/kinect/a.csv: expected a folder of a "
                                              "data type of BIDS, such as motion, found kinect"});
  CHECK(moved("sub-03/motion/sub-03_a.csv")[0] ==
        "error sub-03/motion/sub-03_a.csv: expected motion.tsv, motion.json, channels.tsv, "
        "channels.json or "
        "events.tsv, found a.csv");
  CHECK(moved("sub-03/motion/sub-03_task-s1-a02_tracksys-k_channels.json")[0] ==
        "error sub-03/motion/sub-03_task-s1-a02_tracksys-k_channels.json: expected letters and "
        "digits for "
        "task, found s1-a02");
  CHECK(moved("sub-03/motion/sub-03_task-a_channels.json") ==
        Texts{"error sub-03/motion/sub-03_task-a_channels.json: expected a tracksys, found none"});
  CHECK(moved("sub-03/motion/sub-03_tracksys-k_task-a_channels.json") ==
        Texts{"error sub-03/motion/sub-03_tracksys-k_task-a_channels.json: expected entities sub, "
              "ses, task, "
              "tracksys, acq, run in this order, found task"});
  CHECK(moved("sub-03/motion/sub-04_task-a_tracksys-k_channels.json") ==
        Texts{"error sub-03/motion/sub-04_task-a_tracksys-k_channels.json: expected sub-03, as in "
              "the name of the folder, found sub-04"});
  CHECK(moved("sub-03/motion/sub-03_ses-a_task-a_tracksys-k_channels.json") ==
        Texts{"error sub-03/motion/sub-03_ses-a_task-a_tracksys-k_channels.json: expected no ses, "
              "because there is no session folder, found ses-a"});
  CHECK(moved("sub-03/motion/sub-03_task-a_tracksys-k_run-b_channels.json") ==
        Texts{"error sub-03/motion/sub-03_task-a_tracksys-k_run-b_channels.json: expected digits "
              "for run, found b"});
  CHECK(moved("sub-03/motion/sub-03_task-a_tracksys-k_motion.json") ==
        Texts{"error sub-03/motion/sub-03_task-a_tracksys-k_motion.json: expected the motion.tsv "
              "that belongs to this file, found none"});
}

TEST_CASE("what .bidsignore names is passed over") {
  const auto ignoring = [](const std::string& pattern) {
    return found_when([&](DataSet& set) {
             set["raw/take 1/a.bvh"] = set["notes.txt"] = "x";
             set[".bidsignore"] = pattern;
           })
        .size();
  };
  CHECK(ignoring("# a comment\n") == 2);
  CHECK(ignoring("raw/\nnotes.txt\n") == 0);
  CHECK(ignoring("*.bvh\n/notes.txt") == 0);
  CHECK(ignoring("raw/take*/a.bvh\n*.txt") == 0);
  CHECK(ignoring("raw/take [0-9]/?.bvh\nnotes.???") == 0);
  CHECK(ignoring("raw/b/\nnote.txt") == 2);
}

TEST_CASE("tables about the whole set are checked") {
  CHECK(found_when([](DataSet& set) { set.erase("dataset_description.json"); }) ==
        Texts{"error dataset_description.json: expected this file, found none"});
  CHECK(found_when([](DataSet& set) {
          put(set, "dataset_description.json", "\"Name\"", "\"Nom\"");
        }) == Texts{"error dataset_description.json: expected a text Name, found none"});
  CHECK(found_when([](DataSet& set) {
          put(set, "dataset_description.json", "\"raw\"", "\"derivative\"");
        }) ==
        Texts{"error dataset_description.json: expected GeneratedBy, which a derivative needs, "
              "found none"});
  CHECK(found_when([](DataSet& set) { set.erase("README"); }) ==
        Texts{"warning README: expected this file, found none"});
  CHECK(found_when([](DataSet& set) { set.erase("participants.json"); }) ==
        Texts{"warning participants.json: expected a description of the column age, found none",
              "warning participants.json: expected a description of the column sex, found none"});
  CHECK(found_when([](DataSet& set) { put(set, "participants.tsv", "sub-03", "sub-3"); }) ==
        Texts{"warning participants.tsv:2: expected a folder of each participant, found no folder "
              "of sub-3",
              "error participants.tsv: expected a row of sub-03, found none"});
  CHECK(found_when([](DataSet& set) { put(set, "participants.tsv", "participant_id", "id"); }) ==
        Texts{"error participants.tsv:1: expected participant_id as the first column, found id"});
  CHECK(found_when([](DataSet& set) { put(set, scans, "tracksys-imu", "tracksys-i"); }) ==
        Texts{"error " + scans +
                  ":4: expected an existing file, found "
                  "motion/sub-03_task-Walk_tracksys-i_motio...",
              "warning " + scans +
                  ": expected a row of each motion.tsv, found no row of "
                  "sub-03_task-Walk_tracksys-imu_motion.tsv"});
  CHECK(found_when([](DataSet& set) { put(set, scans, "2026-09-21T", "2026-9-21 "); }) ==
        Texts{"error " + scans +
              ":2: expected acq_time YYYY-MM-DDThh:mm:ss[.000000][Z], found 2026-9-21 "
              "14:13:20.000000Z"});
  CHECK(check_set({}).size() >= 3);
}

TEST_CASE("a file that can't be read is a finding, and the others are checked") {
  DataSet set = good_set();
  BidsListing listing;
  for (const auto& [path, text] : set) listing.paths.insert(path);
  set.erase("participants.tsv");
  listing.read = [&set](const std::string& path, const FileSink& use) -> Result<void> {
    const auto found = set.find(path);
    if (found == set.end()) return Failure(Error{"", 0, "a readable file", "Permission denied"});
    return use(found->second);
  };
  const Findings findings = check_bids(listing);
  REQUIRE(findings.size() == 1);
  CHECK(text_of(findings[0]) ==
        "participants.tsv: expected a readable file, found Permission denied");
}

TEST_CASE("a published data set without signals has the findings that it should have" *
          doctest::skip(!shared_data())) {
  DataSet set;
  const std::string root = shared_path("bids_motion/motion_dualtask/");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.is_regular_file())
      set[entry.path().string().substr(root.size())] = bytes_in(entry.path());
  }
  std::vector<std::string> errors;
  for (const Finding& finding : check_set(set)) {
    if (finding.severity == Severity::error) errors.push_back(text_of(finding));
  }
  // scans.tsv names EEG files and participants that are not in the copy, and rows of samples are
  // empty lines there.
  std::size_t missing = 0, empty = 0;
  for (const std::string& error : errors) {
    missing += error.find("expected an existing file") != std::string::npos ? 1 : 0;
    empty += error.find("expected no empty lines") != std::string::npos ||
                     error.find("expected rows of samples") != std::string::npos
                 ? 1
                 : 0;
  }
  CHECK(missing > 0);
  CHECK(empty == 4);
  CHECK(errors.size() == missing + empty);
}
