// SPDX-License-Identifier: Apache-2.0
// The frames in tables 6 and 7 of the HFUT-MMD paper (README.md), and one division of them among
// people and classes that agrees with both tables. The paper states only the sums for people and
// for classes; the division is ours.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

/// Frames at 60 Hz. `mocap` counts all frames; `kinect` and `imu` count frames of takes with that
/// device.
struct ModalityFrames {
  std::uint64_t mocap = 0, kinect = 0, imu = 0;

  bool operator==(const ModalityFrames&) const = default;
};

/// A row of table 6: all people of one sex and height.
struct PaperPeople {
  std::array<std::string_view, 4> ids;  // unused ones at the end are empty
  ModalityFrames frames;

  // The number of people in the row.
  std::size_t count() const;
};
inline constexpr std::array<PaperPeople, 7> paper_people{
    {{{"09"}, {132'948, 132'948, 132'948}},
     {{"10"}, {43'034, 13'258, 43'034}},
     {{"05"}, {179'902, 179'902, 0}},
     {{"07"}, {33'680, 33'680, 0}},
     {{"04"}, {171'231, 171'231, 171'231}},
     {{"00", "03", "06", "11"}, {1'860'469, 1'860'469, 335'640}},
     {{"01", "02", "08"}, {540'317, 540'317, 395'329}}}};

/// A row of table 7: one class of actions.
struct PaperClass {
  std::string_view id;
  ModalityFrames frames;
};
inline constexpr std::array<PaperClass, 6> paper_classes{{{"S1", {621'208, 621'208, 129'944}},
                                                          {"S2", {659'291, 629'515, 583'859}},
                                                          {"S3", {764'570, 764'570, 272'335}},
                                                          {"S4", {179'902, 179'902, 0}},
                                                          {"S5", {702'930, 702'930, 92'044}},
                                                          {"S6", {33'680, 33'680, 0}}}};

/// Frames of some people in one class, recorded with the suit and one choice of further devices.
struct PaperCell {
  std::size_t people = 0, of_class = 0;  // rows of the two tables
  bool kinect = true, imu = false;
  std::uint64_t frames = 0;
};

/// Cells whose sums agree with both tables: first those with all three devices, then mocap and
/// Kinect, then mocap and nodes. Of all possible divisions, the north-west corner rule gives this
/// one.
std::vector<PaperCell> paper_cells();

}  // namespace kinalign
