// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/twin_maker.h"

#include "apps/kinalign/simulate/simulate_folder.h"

#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/twin/twin_actions.h"
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/documents/truth_json.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/interpolation/clip_motion.h"
#include "kinalign/simulate/person/built_in_motion.h"
#include "kinalign/simulate/person/carried_motion.h"
#include "kinalign/simulate/person/perception_neuron.h"
#include "kinalign/simulate/random.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

constexpr double clicks_s = 1.0;  // before the suit's first frame and after its last
/// The height of a person if the catalogue states none.
constexpr double usual_height_cm = 175.0;
// A larger BVH is refused, because several takes are made at once and memory is limited.
constexpr std::size_t most_bvh_bytes = std::size_t{256} << 20;
constexpr double skipped_frames = 2.0;  // at the beginning of a BVH file
constexpr double smooth_s = 0.02;       // optical mocap jitters more than a suit

/// The time between two frames of a clip, s. All frames have the same distance, so the first two
/// are enough. 0 with fewer than two frames.
double step_s(const ClipFrames& frames) {
  if (frames.size() < 2) return 0.0;
  return std::chrono::duration<double>(frames.stamps[1] - frames.stamps[0]).count();
}

/// The folder for the devices' files of one take. It is removed when the take is finished or has
/// failed. It is also emptied at the start, since a killed run may have left files there.
class RawFolder {
 public:
  explicit RawFolder(std::string path) : path_(std::move(path)) { remove(); }
  RawFolder(const RawFolder&) = delete;
  RawFolder& operator=(const RawFolder&) = delete;
  ~RawFolder() { remove(); }

  const std::string& path() const { return path_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  std::string path_;
};

}  // namespace

std::string twin_truth_path(const TakeName& name) { return "truth/" + to_string(name) + ".json"; }

std::optional<TakeSummary> TwinMaker::known(const TwinTake& take) const {
  const std::string& folder = place_.folder;
  auto summary = read_summary(place_.files, folder, take.name);
  if (!summary) return std::nullopt;
  // The summary states the size of the take's file. A take with another size is made again.
  std::error_code fault;
  const auto bytes = fs::file_size(path_of(folder, take.name, TakeFile::take), fault);
  if (fault || bytes != summary->bytes) return std::nullopt;
  return *std::move(summary);
}

double TwinMaker::height_m(const TwinTake& take) const {
  const Subject* person = find_subject(place_.catalogue, take.name.subject);
  const auto height_cm = person == nullptr ? std::nullopt : person->height_cm;
  return 0.01 * height_cm.value_or(usual_height_cm);
}

/// A built-in motion: the movements of the take's action, with the body of the take's person.
Result<Motion> TwinMaker::built_in(const TwinTake& take, double length_s) const {
  const auto& actions = twin_actions();
  const auto action = std::find_if(actions.begin(), actions.end(), [&](const TwinAction& one) {
    return one.id == take.name.action;
  });
  // The plan has only actions from this table, so the action is always found.
  return built_in_motion({.height_m = height_m(take),
                          .programme = twin_programme(*action, length_s, take.seed),
                          .seed = take.seed,
                          .person = take.person_seed});
}

/// The motion of a BVH file on the body of the take's person. A part with the right length is cut
/// from a long file. A short file is played forwards and backwards.
Result<Motion> TwinMaker::carried(const TwinTake& take, double length_s,
                                  const std::string& file) const {
  const auto named = in_file(file);
  const std::string text = KA_TRY(read_whole(place_.files, file, most_bvh_bytes));
  const BvhFile bvh = KA_TRY(read_bvh(text, file, {}));
  Motion recorded = KA_TRY(kinalign::motion_of(bvh.clip, {.smooth_s = smooth_s}).map_error(named));
  // CMU's BVH files by cgspeed begin with a T-pose, after which the motion jumps.
  const double first_s = skipped_frames * step_s(bvh.clip.frames);
  const double room_s = std::max(0.0, recorded.length_s - first_s - length_s);
  // The begin of the part is random, but depends only on the seed of the take. 133 is the number of
  // the random stream for it.
  const double begin_s = first_s + room_s * RandomStream(take.seed, 133).uniform(0, 0);
  const double end_s = std::min(recorded.length_s, begin_s + length_s);
  Motion carried =
      // The angles are applied to a suit's skeleton of the person's height, so every take has the
      // bones of its person.
      KA_TRY(carried_over(std::move(recorded), perception_neuron(height_m(take), take.person_seed))
                 .map_error(named));
  return there_and_back(std::move(carried), begin_s, end_s, length_s).map_error(named);
}

/// Every second take has the motion of a file, if there are files.
Result<TwinMaker::Named> TwinMaker::motion_of(const TwinTake& take, std::size_t number) const {
  // The user clicks before the suit's first frame, so the motion is longer than the take.
  const double length_s = clicks_s + static_cast<double>(take.frames) / twin_rate_hz;
  const auto& motions = place_.motions;
  if (motions.empty() || number % 2 == 0) {
    Motion motion = KA_TRY(built_in(take, length_s));
    return Named{std::move(motion), "built-in " + take.name.action};
  }
  // The files are used in turn: the second take gets the first file, the fourth take the second
  // file, and so on.
  const std::string& file = motions[number / 2 % motions.size()];
  Motion motion = KA_TRY(carried(take, length_s, file));
  return Named{std::move(motion), std::string(file_name(file))};
}

Result<TakeSummary> TwinMaker::make(const TwinTake& take, std::size_t number,
                                    const Progress& progress) {
  FileSystem& files = place_.files;
  const std::string& folder = place_.folder;
  const auto [motion, name] = KA_TRY(motion_of(take, number));
  // rehearse() simulates all devices with their clocks and errors, from the seed. The truth has
  // what no device measures.
  const Rehearsal rehearsal =
      KA_TRY(rehearse(motion, {.seed = take.seed, .person = take.person_seed}));
  TrueRecording truth = truth_of(rehearsal, motion, utc_time(take.start_ns));
  truth.seed = take.seed;
  truth.motion = name;
  // The path contains the take's name, so each thread has its own folder. The destructor removes
  // the folder, after a failure, too.
  const RawFolder raw(folder + "/" + std::string(cache_folder) + "/twin/" + to_string(take.name));
  KA_TRY(make_folders(raw.path()));
  KA_TRY(make_folders(folder + "/sub-" + take.name.subject));
  KA_TRY(write_devices({files, raw.path()}, rehearsal, motion,
                       {.stamps = NodeStamps::received, .kinect = take.kinect, .nodes = take.imu},
                       truth));
  // The truth is written first, so that a take with a summary always has its truth.
  KA_TRY(write_whole(files, folder + "/" + twin_truth_path(take.name), truth_json(truth),
                     Overwrite::yes));
  const std::string recording = raw.path() + "/recording.toml";
  Manifest manifest =
      // The devices' files have a manifest like that of a user. From here on the take is made in
      // the same way as a user's take.
      KA_TRY(read_manifest(KA_TRY(read_whole(files, recording, longest_manifest)), recording));
  manifest.subject = take.name.subject;
  manifest.action = take.name.action;
  return takes_.make(take.name, manifest, raw.path() + "/", progress);
}

}  // namespace kinalign
