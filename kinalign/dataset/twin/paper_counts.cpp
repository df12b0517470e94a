// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/twin/paper_counts.h"

#include <algorithm>

namespace kinalign {

namespace {

// Some rows of both tables belong together, as their numbers show. Only person 05 did class S4, and
// only person 07 did S6. Only person 10 was recorded without a Kinect, in class S2.
constexpr std::size_t person_10 = 1, person_05 = 2, person_07 = 3;
constexpr std::size_t baduanjin = 1, wuqinxi = 3, dance = 5;
constexpr std::uint64_t without_kinect = 29'776;

/// Frames by people and frames by classes. They are the sums of the rows and of the columns of the
/// table that is computed.
using Supplies = std::array<std::uint64_t, paper_people.size()>;
using Demands = std::array<std::uint64_t, paper_classes.size()>;

/// Divides the people's frames among the classes, by the north-west corner rule. The first person's
/// frames fill the first class and then the next one, and so on. The two arrays must have the same
/// sum. The result has few cells.
void transport(Supplies supplies, Demands demands, bool imu, std::vector<PaperCell>& out) {
  for (std::size_t who = 0; who < supplies.size(); ++who) {
    for (std::size_t what = 0; what < demands.size(); ++what) {
      const std::uint64_t frames = std::min(supplies[who], demands[what]);
      if (frames == 0) continue;
      out.push_back({who, what, true, imu, frames});
      supplies[who] -= frames;
      demands[what] -= frames;
    }
  }
}

}  // namespace

std::size_t PaperPeople::count() const {
  return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), std::string_view{}) -
                                  ids.begin());
}

std::vector<PaperCell> paper_cells() {
  Supplies all_three{}, pairs{};
  Demands all_three_of{}, pairs_of{};
  // The takes with all three devices come first. All frames with nodes also have a Kinect, except
  // some frames of person 10.
  for (std::size_t i = 0; i < all_three.size(); ++i) all_three[i] = paper_people[i].frames.imu;
  for (std::size_t i = 0; i < all_three_of.size(); ++i) {
    all_three_of[i] = paper_classes[i].frames.imu;
  }
  all_three[person_10] -= without_kinect;
  all_three_of[baduanjin] -= without_kinect;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = paper_people[i].frames.kinect - all_three[i];
  }
  for (std::size_t i = 0; i < pairs_of.size(); ++i) {
    pairs_of[i] = paper_classes[i].frames.kinect - all_three_of[i];
  }
  // The cells of these two people are known, so they are left out here and added below.
  pairs[person_05] = pairs[person_07] = 0;
  pairs_of[wuqinxi] = pairs_of[dance] = 0;
  // The takes are made in the order of these cells.
  std::vector<PaperCell> out;
  transport(all_three, all_three_of, true, out);
  transport(pairs, pairs_of, false, out);
  out.push_back({person_05, wuqinxi, true, false, paper_people[person_05].frames.mocap});
  out.push_back({person_07, dance, true, false, paper_people[person_07].frames.mocap});
  out.push_back({person_10, baduanjin, false, true, without_kinect});
  return out;
}

}  // namespace kinalign
