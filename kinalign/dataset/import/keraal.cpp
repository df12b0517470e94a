// SPDX-License-Identifier: Apache-2.0
// Imports Keraal: exercises of the back, recorded with a Kinect v2 and 17 optical targets. The
// files of one recording have the same names except for the device:
// G3-Kinect-CTK-P1T1-Unknown-C-0.txt.
#include "kinalign/dataset/import/corpora.h"

#include <map>
#include <optional>
#include <vector>

namespace kinalign {

namespace {

/// The parts of a file's name. Two files of one recording have the same key.
struct RecordingName {
  std::string device, subject, action;  // "Kinect", "G3P1", "CTK"
  std::string key;                      // the name without the device
};

/// The words of a name: "G3-Kinect-CTK" gives three words.
std::vector<std::string> words_between_dashes(std::string_view stem) {
  std::vector<std::string> out;
  for (;;) {
    const auto dash = stem.find('-');
    out.emplace_back(stem.substr(0, dash));
    if (dash == stem.npos) return out;
    stem.remove_prefix(dash + 1);
  }
}

/// Splits a file's name; absent if the name has another form.
std::optional<RecordingName> recording_of(std::string_view name) {
  const auto parts = words_between_dashes(stem_of(name));
  if (!has_ending(name, ".txt") || parts.size() < 4 || !parts[0].starts_with('G') ||
      !parts[3].starts_with('P') || (parts[1] != "Kinect" && parts[1] != "Vicon")) {
    return std::nullopt;
  }
  // "P1T1" is person 1, trial 1; persons are numbered within their group.
  const auto end = parts[3].find_first_not_of("0123456789", 1);
  RecordingName out{parts[1], parts[0] + parts[3].substr(0, end), parts[2], parts[0]};
  for (std::size_t i = 2; i < parts.size(); ++i) out.key += "-" + parts[i];
  return out;
}

/// The manifest of a pair. The Kinect is fitted to the targets that correspond to its joints.
Manifest recording_manifest(const std::string& kinect, const std::string& vicon) {
  Manifest out;
  out.streams.push_back(stream_of("mocap", vicon, "keraal_vicon"));
  out.streams.push_back(stream_of("kinect", kinect, "keraal_kinect"));
  // The targets lie on the skin near joints, so this list pairs them with joints.
  SpaceOptions& space = out.spaces["kinect"];
  space.method = "fit";
  space.joints = {{"SpineBase", "Hips"},         {"Head", "Head"},
                  {"ShoulderLeft", "LShoulder"}, {"ShoulderRight", "RShoulder"},
                  {"HandLeft", "LHand"},         {"HandRight", "RHand"},
                  {"FootLeft", "LFoot"},         {"FootRight", "RFoot"}};
  return out;
}

/// The files of one recording; a path is empty until its file is found.
struct DevicePair {
  RecordingName name;
  std::string kinect, vicon;
};

/// Pairs files of the two devices whose names are otherwise equal.
Result<Corpus> list_keraal(const ImportInput& input) {
  Corpus out{.name = "Keraal",
             .licence = "BSD-2-Clause",
             .citation =
                 "S. M. Nguyen et al.: A Medical Low-Back Pain Physical Rehabilitation "
                 "Dataset for Human Body Movement Analysis. IJCNN 2024",
             .classes = {{"keraal", "exercises of the back"}},
             .class_id = "keraal"};
  // The map is sorted, so takes have the same order in every import.
  std::map<std::string, DevicePair> pairs;
  for (const SourceFile& file : input.sources) {
    const auto name = recording_of(file.name);
    if (!name) continue;
    DevicePair& pair = pairs[name->key];
    pair.name = *name;
    (name->device == "Kinect" ? pair.kinect : pair.vicon) = file.path;
  }
  for (const auto& [key, pair] : pairs) {
    // A take needs both devices.
    if (pair.kinect.empty() || pair.vicon.empty()) {
      out.left_out.push_back({key, pair.vicon.empty() ? "without Vicon" : "without Kinect"});
      continue;
    }
    out.takes.push_back(
        {pair.name.subject, pair.name.action, 0, recording_manifest(pair.kinect, pair.vicon), key});
  }
  return out;
}

}  // namespace

CorpusKind keraal_corpus() {
  return {"keraal", "G3-Kinect-CTK-P1T1-Unknown-C-0.txt and G3-Vicon-...", false,
          [](FileSystem&, const SourceFile& file) { return recording_of(file.name).has_value(); },
          list_keraal};
}

}  // namespace kinalign
