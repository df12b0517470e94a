// SPDX-License-Identifier: Apache-2.0
// Imports KinectMultiTrack: logs of two Kinects v2 that see one person. The skeletons of both are
// in one table, as numbers 0 and 1.
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/sources/formats.h"

#include <array>

namespace kinalign {

namespace {

// The built-in layout that reads these logs.
constexpr std::string_view layout = "kinect_multitrack";

/// True for a log. It is recognised by its columns, so its first bytes are read. A file that can't
/// be opened is not a log.
bool is_log(FileSystem& files, const SourceFile& file) {
  if (!has_ending(file.name, ".csv")) return false;
  auto opened = InputFile::open(files, file.path, 4096);
  if (!opened) return false;
  const auto head = opened->next();
  if (!head) return false;
  const auto format = find_format(files, {}, {file.path, ""}, *head);
  return format && format->name == layout;
}

/// The digits after `lead`: with "Study_", "Study_10_Kinect_0_Time_..." gives "10". Empty if there
/// are none.
std::string number_behind(std::string_view text, std::string_view lead) {
  const auto at = text.find(lead);
  if (at == text.npos) return "";
  text.remove_prefix(at + lead.size());
  const auto end = text.find_first_not_of("0123456789");
  return std::string(text.substr(0, end));
}

/// The manifest of a log. Both Kinects are in one table, and each stream selects its rows.
Manifest log_manifest(const std::string& path) {
  Manifest out;
  constexpr std::array<const char*, 2> names{"kinect0", "kinect1"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    out.streams.push_back(stream_of(names[k], path, std::string(layout)));
    out.streams.back().select = {{"Skeleton#", std::to_string(k)}};
  }
  out.streams.back().clock = "shared";  // the server stamped both Kinects
  out.spaces[names[1]].method = "fit";  // the logger's own calibration is wrong by some degrees
  return out;
}

/// Lists each log as a take. The study is the subject, the arrangement of the Kinects the action.
Result<Corpus> list_kinect_multitrack(const ImportInput& input) {
  Corpus out{.name = "KinectMultiTrack",
             .licence = "MIT",
             .citation = "C.-J. Wu: KinectMultiTrack. Thesis, University of St Andrews, 2015",
             .classes = {{"multitrack", "standing, stepping and walking before two Kinects"}},
             .actions = {{"kinect0", "multitrack", "Kinects in parallel"},
                         {"kinect1", "multitrack", "Kinects at 45 degrees"},
                         {"kinect2", "multitrack", "Kinects at 90 degrees"}},
             .class_id = "multitrack"};
  for (const SourceFile& file : input.sources) {
    if (!is_log(input.files, file)) continue;
    const std::string stem(stem_of(file.name));
    const std::string study = number_behind(stem, "Study_"), rig = number_behind(stem, "Kinect_");
    // The user's subject and action are used only if the file's name states none.
    const std::string subject = study.empty() ? input.subject : study;
    const std::string action = rig.empty() ? input.action : "kinect" + rig;
    if (subject.empty() || action.empty()) {
      out.left_out.push_back({stem, "without Study_N and Kinect_N in its name"});
      continue;
    }
    out.takes.push_back({subject, action, 0, log_manifest(file.path), stem});
  }
  return out;
}

}  // namespace

CorpusKind kinect_multitrack_corpus() {
  return {"kinectmultitrack", "Study_1_Kinect_0_*.csv with Skeleton# and Tracker_Time", false,
          is_log, list_kinect_multitrack};
}

}  // namespace kinalign
