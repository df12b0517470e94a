// SPDX-License-Identifier: Apache-2.0
// A small BIDS-Motion data set with a suit, a Kinect and two nodes, in a folder or in memory.
#pragma once

#include "tests/folder.h"
#include "tests/formats/any_points.h"
#include "tests/formats/written_text.h"

#include "kinalign/formats/bids/check.h"
#include "kinalign/formats/bids/dataset.h"
#include "kinalign/formats/bids/motion_write.h"
#include "kinalign/formats/bids/names.h"

#include <map>
#include <random>
#include <string>

namespace kinalign {

/// path -> text of the file
using DataSet = std::map<std::string, std::string>;

constexpr std::int64_t bids_start_ns = 1'790'000'000'000'000'123;

inline Clip bids_clip(std::size_t frames, std::mt19937_64& random) {
  std::normal_distribution<double> any;
  Clip clip;
  clip.skeleton = {
      {"Hips", "Spine", "Head"}, {-1, 0, 1}, {Vec3::Zero(), Vec3(0, 0.3, 0), Vec3(0, 0.4, 0)}, {}};
  for (std::size_t t = 0; t < frames; ++t) {
    clip.frames.stamps.push_back(
        utc_time(bids_start_ns + 16'666'667 * static_cast<std::int64_t>(t)));
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 at = j == 0 ? Vec3(any(random), 1, any(random)) : clip.skeleton.rest_offsets[j];
      const Quat q = Quat(any(random), any(random), any(random), any(random)).normalized();
      clip.frames.local_positions.insert(clip.frames.local_positions.end(), {at[0], at[1], at[2]});
      clip.frames.local_rotations.insert(clip.frames.local_rotations.end(),
                                         {q.w(), q.x(), q.y(), q.z()});
    }
  }
  return clip;
}

inline ImuStream bids_nodes(const ImuContent& content, std::size_t samples,
                            std::mt19937_64& random) {
  std::normal_distribution<double> any;
  ImuStream out{{"waist", "wrist"}, content, {}};
  for (std::size_t t = 0; t < samples; ++t) {
    out.samples.stamps.push_back(
        utc_time(bids_start_ns + 5'000'000 * static_cast<std::int64_t>(t)));
    for (std::size_t s = 0; s < 2; ++s) {
      const bool valid = random() % 6 != 0;
      const Quat q = Quat(any(random), any(random), any(random), any(random)).normalized();
      out.samples.valid.push_back(valid ? 1 : 0);
      if (content.orientation) {
        for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
          out.samples.orientation.push_back(valid ? part : 0.0);
        }
      }
      for (int k = 0; k < 3; ++k) {
        if (content.acceleration)
          out.samples.acceleration.push_back(valid ? 9.8 * any(random) : 0.0);
        if (content.angular_velocity)
          out.samples.angular_velocity.push_back(valid ? any(random) : 0.0);
      }
    }
  }
  return out;
}

/// Puts the four files of a tracking system into the set; gives the onset for scans.tsv.
template <class Frames>
Time put_system(const BidsEntities& entities, const BidsSource& source, const Frames& frames,
                double rate_hz, DataSet& set) {
  BidsSidecars sidecars;
  set[bids_path(entities, "motion.tsv")] = written_text([&](TextOut& out) -> Result<void> {
                                             BidsMotionWriter writer(source, out);
                                             KA_TRY(writer.append(frames));
                                             BidsSystemFacts facts;
                                             facts.task_name = "Walk";
                                             facts.system_name = entities.system;
                                             facts.rate_hz = rate_hz;
                                             sidecars = writer.sidecars(facts);
                                             return {};
                                           }).value();
  set[bids_path(entities, "channels.tsv")] = sidecars.channels_tsv;
  set[bids_path(entities, "channels.json")] = sidecars.channels_json;
  set[bids_path(entities, "motion.json")] = sidecars.motion_json;
  return sidecars.onset;
}

struct BidsStreams {
  Clip clip;
  PointStream points;
  ImuStream nodes;
};

inline BidsStreams bids_streams(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return {bids_clip(60, random), any_points(4, 30, 30.0, bids_start_ns, random),
          bids_nodes({.orientation = true, .acceleration = true, .angular_velocity = true}, 200,
                     random)};
}

inline BidsEntities bids_system(const std::string& system) { return {"03", "Walk", system, ""}; }

/// A data set without findings.
inline DataSet bids_data_set(const BidsStreams& streams) {
  DataSet set;
  const Time suit =
      put_system(bids_system("suit"), streams.clip.skeleton, streams.clip.frames, 60.0, set);
  const Time kinect = put_system(bids_system("kinect"), PointHeader{streams.points.joint_names},
                                 streams.points.frames, 30.0, set);
  const Time imu =
      put_system(bids_system("imu"), ImuHeader{streams.nodes.node_names, streams.nodes.content},
                 streams.nodes.samples, 200.0, set);
  const auto name = [](const char* system) {
    return bids_path(bids_system(system), "motion.tsv").substr(std::string("sub-03/").size());
  };
  set[bids_scans_path(bids_system(""))] =
      scans_tsv({{name("suit"), suit}, {name("kinect"), kinect}, {name("imu"), imu}});
  set["dataset_description.json"] =
      dataset_description_json({"Walks", "CC0", {"A. Author", "B. Author"}, "", ""});
  const BidsParticipants participants{{{"age", "age at the recording", "year", {}},
                                       {"sex", "sex", "", {{"F", "female"}, {"M", "male"}}}},
                                      {{"03", {"31", "F"}}}};
  set["participants.tsv"] = participants_tsv(participants);
  set["participants.json"] = participants_json(participants);
  set["README"] =
      std::string("Walks of one person, recorded by a suit, a Kinect and two inertial nodes.\n") +
      "A file for tests: the motion is random.\n";
  return set;
}

inline Findings check_set(const DataSet& set) {
  BidsListing listing;
  for (const auto& [path, text] : set) listing.paths.insert(path);
  listing.read = [&set](const std::string& path, const FileSink& use) -> Result<void> {
    const auto found = set.find(path);
    if (found == set.end()) return Failure(Error{path, 0, "a readable file", "none"});
    for (std::size_t at = 0; at < found->second.size(); at += 1000) {
      KA_TRY(use(std::string_view(found->second).substr(at, 1000)));
    }
    return {};
  };
  return check_bids(listing);
}

}  // namespace kinalign
