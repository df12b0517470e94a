// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/tables.h"

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

/// Appends a row titled `title` with the sums of the columns from `first` on.
void add_sums(Table& table, std::size_t first, const std::string& title) {
  std::vector<Cell> sums(table.columns.size());
  sums.front() = title;
  for (std::size_t c = first; c < sums.size(); ++c) {
    std::int64_t sum = 0;
    for (const auto& row : table.rows) {
      if (const auto* whole = std::get_if<std::int64_t>(&row[c])) sum += *whole;
    }
    sums[c] = sum;
  }
  table.rows.push_back(std::move(sums));
  // Programs that show the table separate this last row.
  table.has_sum = true;
}

/// A row of table 1 in the HFUT-MMD paper. -1: the paper does not state the number.
struct Published {
  const char* name;
  std::int64_t frames, clips, kinds, people;  // the paper states either frames or clips
  const char* modalities;
};
// The numbers are copied from that table.
constexpr Published published[] = {{"HDM05", 1'531'745, -1, 100, 5, "joints"},
                                   {"CMU-MMAC", -1, 6'650, 23, 5, "RGB, 3D joints, IMU, audio"},
                                   {"Human3.6M", 3'578'080, -1, 6, 11, "RGB, depth, 3D joints"},
                                   {"UTD-MHAD", -1, 861, 27, 8, "RGB, depth, 3D joints, IMU"},
                                   {"DIP-IMU", 330'178, -1, 5, 10, "IMU"},
                                   {"KTH", -1, 2'391, 6, 25, "RGB"},
                                   {"UCF YouTube", -1, 3'040, 11, -1, "RGB"},
                                   {"IXMAS", -1, 2'340, 13, 10, "RGB"},
                                   {"MADS", 51'267, -1, 5, 5, "RGB, depth, 3D joints"},
                                   {"UMONS-TAICHI", -1, 2'200, 13, 12, "RGB, depth, 3D joints"},
                                   {"TotalCapture", 1'892'176, -1, 4, 5, "RGB, 3D joints, IMU"}};

/// A number as a cell; empty if the paper does not state it.
Cell count(std::int64_t value) { return value < 0 ? Cell() : Cell(value); }

std::int64_t whole(const Cell& cell) {
  const auto* value = std::get_if<std::int64_t>(&cell);
  return value == nullptr ? 0 : *value;
}

}  // namespace

Result<Table> table_of_data_sets(const DatasetIndex& index) {
  Table out;
  out.caption = "Data sets of human motion (the paper's table 1) and this one";
  out.columns = {{"name", "data set"}, {"frames", "frames"}, {"clips", "clips"},
                 {"kinds", "kinds"},   {"people", "people"}, {"modalities", "modalities"}};
  for (const Published& one : published) {
    out.rows.push_back({std::string(one.name), count(one.frames), count(one.clips),
                        count(one.kinds), count(one.people), std::string(one.modalities)});
  }
  // The row of this data set. Its frames are summed over the modalities.
  const Table own = KA_TRY(index.select(
      "select coalesce(sum(mocap + kinect + imu), 0), count(*), count(distinct action), "
      "count(distinct subject), coalesce(sum(mocap), 0), coalesce(sum(kinect), 0), "
      "coalesce(sum(imu), 0) from takes"));
  const std::vector<Cell>& sums = own.rows.front();
  std::string modalities;
  const char* const names[] = {"mocap joints", "Kinect joints", "IMU"};
  for (std::size_t m = 0; m < 3; ++m) {
    // The last three sums are the numbers of frames of each modality.
    if (whole(sums[4 + m]) > 0)
      modalities += (modalities.empty() ? "" : ", ") + std::string(names[m]);
  }
  const std::string& name = index.catalogue().name;
  out.rows.push_back({name.empty() ? std::string("this one") : name, sums[0], sums[1], sums[2],
                      sums[3], modalities});
  return out;
}

/// The frames are summed for each person first, then for each sex and height. Otherwise a person
/// would be listed once for each take.
Result<Table> table_by_subject(const DatasetIndex& index) {
  Table out = KA_TRY(index.select(
      "select group_concat(subject, ', ') as subjects, sex, height_cm, sum(mocap) as mocap, "
      "sum(kinect) as kinect, sum(imu) as imu from (select subject, sex, height_cm, "
      "sum(mocap) as mocap, sum(kinect) as kinect, sum(imu) as imu from takes group by subject "
      "order by subject) group by sex, height_cm order by height_cm, sex"));
  out.caption = "Frames by sex and height (the paper's table 6)";
  // The other columns have their usual titles.
  out.columns[0] = {"subjects", "people"};
  add_sums(out, 3, "sum");
  return out;
}

Result<Table> table_by_class(const DatasetIndex& index) {
  Table out = KA_TRY(index.select(
      "select class, class_name, sum(mocap) as mocap, sum(kinect) as kinect, sum(imu) as imu "
      "from takes group by class order by class"));
  out.caption = "Frames by class (the paper's table 7)";
  out.columns[1].title = "name";
  add_sums(out, 2, "sum");
  return out;
}

/// The names of a take's modalities are joined in SQL, so each combination becomes one group.
Result<Table> table_by_modalities(const DatasetIndex& index) {
  Table out = KA_TRY(
      index.select("select case when mocap > 0 then 'mocap' else '' end || "
                   "case when kinect > 0 then ' + Kinect' else '' end || "
                   "case when imu > 0 then ' + IMU' else '' end as modalities, count(*) as takes, "
                   "sum(frames) as frames from takes group by modalities order by frames desc"));
  out.caption = "Takes and frames by the modalities that were recorded together";
  out.columns = {{"modalities", "recorded together"}, {"takes", "takes"}, {"frames", "frames"}};
  add_sums(out, 1, "sum");
  return out;
}

}  // namespace kinalign
