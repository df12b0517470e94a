// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/twin_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kinalign {

namespace {

/// An empty table with the columns of the paper, of the plan and of the takes made.
Table table_with(const std::string& key, const std::string& caption) {
  Table table;
  table.caption = caption;
  table.has_sum = true;
  table.columns = {{key, key}};
  for (const std::string whose : {"paper", "asked", "made"}) {
    // The keys name the origin for programs. Only the first title of three names it for people.
    table.columns.push_back({whose + "_mocap", whose + ": mocap"});
    table.columns.push_back({whose + "_kinect", "Kinect"});
    table.columns.push_back({whose + "_imu", "IMU"});
  }
  return table;
}

void add_row(const std::string& name, const std::vector<ModalityFrames>& values, Table& table) {
  std::vector<Cell> row{name};
  for (const ModalityFrames& one : values) {
    for (const std::uint64_t frames : {one.mocap, one.kinect, one.imu}) {
      row.emplace_back(static_cast<std::int64_t>(frames));
    }
  }
  table.rows.push_back(std::move(row));
}

/// The people of one row of the paper's table 6, as that table writes them.
std::string ids_of(const PaperPeople& people) {
  return fmt::format(
      "{}", fmt::join(people.ids.begin(),
                      people.ids.begin() + static_cast<std::ptrdiff_t>(people.count()), ", "));
}

}  // namespace

std::vector<Table> twin_tables(double scale, const TwinCounts& made) {
  // A scale of 1 gives the paper's own counts.
  const TwinCounts paper = paper_counts(1.0), asked = paper_counts(scale);
  Table people = table_with("people", "Frames by people (the paper's table 6)");
  for (std::size_t i = 0; i < paper_people.size(); ++i) {
    add_row(ids_of(paper_people[i]), {paper.people[i], asked.people[i], made.people[i]}, people);
  }
  Table classes = table_with("class", "Frames by classes (the paper's table 7)");
  for (std::size_t i = 0; i < paper_classes.size(); ++i) {
    add_row(std::string(paper_classes[i].id), {paper.classes[i], asked.classes[i], made.classes[i]},
            classes);
  }
  Table choices = table_with("devices", "Frames by devices that recorded together");
  for (std::size_t i = 0; i < device_choices.size(); ++i) {
    add_row(std::string(device_choices[i]), {paper.choices[i], asked.choices[i], made.choices[i]},
            choices);
  }
  std::vector<Table> out{std::move(people), std::move(classes), std::move(choices)};
  // All three tables end with the same sums.
  for (Table& table : out) add_row("sum", {paper.sum(), asked.sum(), made.sum()}, table);
  return out;
}

}  // namespace kinalign
