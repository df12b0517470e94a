// SPDX-License-Identifier: Apache-2.0
// The list of takes in a simulated twin of the HFUT-MMD paper's data set (README.md). The paper
// counts frames and not takes, so the scale is a share of its frames. The limit of half a minute
// for a take is our choice.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/twin/paper_counts.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

// The rate at which the paper counts frames.
inline constexpr double twin_rate_hz = 60.0;
inline constexpr std::uint64_t longest_twin_take = 1800, shortest_twin_take = 600;  // in frames

/// One take of the plan, with everything that its simulation needs. The same plan gives the same
/// takes on every machine.
struct TwinTake {
  TakeName name;
  std::size_t people = 0, of_class = 0;  // row of table 6; row of table 7
  bool kinect = true, imu = false;
  std::uint64_t frames = 0;       // alignment may remove some
  std::uint64_t seed = 0;         // for everything that differs between takes of one person
  std::uint64_t person_seed = 0;  // for the body, its way of moving, and a Kinect's errors on it
  std::int64_t start_ns = 0;      // UTC; takes follow one another

  bool operator==(const TwinTake&) const = default;
};

/// The choices of the user. The numbers of the paper are fixed.
struct TwinOptions {
  double scale = 0.02;  // share of the paper's frames
  std::uint64_t seed = 1;
};

/// Plans the takes. Each cell of the two tables (paper_cells) becomes takes of nearly equal length.
/// A take has at least `shortest_twin_take` frames, so a small scale gives more frames than
/// requested. People of a row and actions of a class take turns.
std::vector<TwinTake> plan_twin(const TwinOptions& options);

/// Numbers of frames in the rows of the two tables.
struct TwinCounts {
  std::array<ModalityFrames, paper_people.size()> people;
  std::array<ModalityFrames, paper_classes.size()> classes;
  std::array<ModalityFrames, 3> choices;  // mocap + Kinect, mocap + nodes, all three
  std::array<std::uint64_t, 3> takes{};   // for each choice

  ModalityFrames sum() const;
};
inline constexpr std::array<std::string_view, 3> device_choices{"mocap + Kinect", "mocap + IMU",
                                                                "all three"};

/// Adds a take with this number of frames to `counts`. It may have fewer frames than planned.
void count(const TwinTake& take, std::uint64_t frames, TwinCounts& counts);
/// The paper's own counts times `scale`, rounded.
TwinCounts paper_counts(double scale);

/// The estimated size of takes and truths on the disk, bytes.
std::uint64_t bytes_of(const std::vector<TwinTake>& takes);

/// The plan as JSON, schema kinalign.twin/1, from which a stopped job continues. `motions`: the
/// names of the motion files, used for the takes in turn; empty: the built-in person.
std::string twin_json(const TwinOptions& options, const std::vector<std::string>& motions,
                      const std::vector<TwinTake>& takes);

}  // namespace kinalign
