// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/twin/twin_plan.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/twin/twin_actions.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <map>
#include <numeric>
#include <set>

using namespace kinalign;

TEST_CASE("the cells of the paper add up to its tables 6 and 7, and to all its frames") {
  TwinCounts counts;
  for (const PaperCell& cell : paper_cells()) {
    TwinTake take;
    take.people = cell.people;
    take.of_class = cell.of_class;
    take.kinect = cell.kinect;
    take.imu = cell.imu;
    count(take, cell.frames, counts);
  }
  for (std::size_t i = 0; i < paper_people.size(); ++i) {
    CHECK(counts.people[i] == paper_people[i].frames);
  }
  for (std::size_t i = 0; i < paper_classes.size(); ++i) {
    CHECK(counts.classes[i] == paper_classes[i].frames);
  }
  // The sums that the paper prints below both tables.
  CHECK(counts.sum() == ModalityFrames{2'961'581, 2'931'805, 1'078'182});
  CHECK(counts.choices[1] == ModalityFrames{29'776, 0, 29'776});
  CHECK(counts.choices[0].imu == 0);
}

TEST_CASE("a twin of scale 1 has the paper's frames, in takes of half a minute at most") {
  TwinCounts counts;
  for (const TwinTake& take : plan_twin({.scale = 1.0, .seed = 1})) {
    CHECK(take.frames <= longest_twin_take);
    CHECK(take.frames >= shortest_twin_take);
    count(take, take.frames, counts);
  }
  CHECK(counts.people == paper_counts(1.0).people);
  CHECK(counts.classes == paper_counts(1.0).classes);
  CHECK(counts.choices == paper_counts(1.0).choices);
}

TEST_CASE("a small twin still has all people, all classes and all choices of devices") {
  for (const double scale : {0.0001, 0.005, 0.02}) {
    CAPTURE(scale);
    const auto takes = plan_twin({.scale = scale, .seed = 3});
    std::set<std::string> people, classes;
    TwinCounts counts;
    for (const TwinTake& take : takes) {
      people.insert(take.name.subject);
      classes.insert(take.name.action.substr(0, 2));
      count(take, take.frames, counts);
      CHECK(take.frames >= shortest_twin_take);
    }
    CHECK(people.size() == 12);
    CHECK(classes.size() == 6);
    for (const std::uint64_t of_choice : counts.takes) CHECK(of_choice > 0);
  }
}

TEST_CASE("names and seeds are each take's own; a person has one body") {
  const auto takes = plan_twin({.scale = 0.1, .seed = 3});
  std::set<TakeName> names;
  std::set<std::uint64_t> seeds, bodies;
  std::map<std::string, std::set<std::uint64_t>> body_of;
  for (const TwinTake& take : takes) {
    names.insert(take.name);
    seeds.insert(take.seed);
    bodies.insert(take.person_seed);
    body_of[take.name.subject].insert(take.person_seed);
  }
  CHECK(names.size() == takes.size());
  CHECK(seeds.size() == takes.size());
  CHECK(bodies.size() == 12);
  for (const auto& [id, own] : body_of) CHECK(own.size() == 1);
}

TEST_CASE("the same seed gives the same plan, another one other draws of the same takes") {
  const auto one = plan_twin({.scale = 0.02, .seed = 3}),
             again = plan_twin({.scale = 0.02, .seed = 3});
  const auto other = plan_twin({.scale = 0.02, .seed = 4});
  CHECK(one == again);
  REQUIRE(one.size() == other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].name == other[i].name);
    CHECK(one[i].seed != other[i].seed);
    CHECK(one[i].person_seed != other[i].person_seed);
  }
}

TEST_CASE("the file of a plan differs wherever the plan does") {
  const TwinOptions options{.scale = 0.02, .seed = 3};
  const auto takes = plan_twin(options);
  const std::string text = twin_json(options, {}, takes);
  const auto json = nlohmann::json::parse(text);
  CHECK(json["schema"] == "kinalign.twin/1");
  CHECK(json["takes"].size() == takes.size());
  CHECK(json["takes"][0]["seed"] == takes[0].seed);
  CHECK(twin_json({.scale = 0.03, .seed = 3}, {}, takes) != text);
  CHECK(twin_json(options, {"walk.bvh"}, takes) != text);
}

TEST_CASE("every action of the template has movements, and a name in dataset.toml") {
  const auto text = twin_catalogue("twin");
  REQUIRE(text);
  const auto catalogue = read_catalogue(*text, "dataset.toml");
  REQUIRE(catalogue);
  CHECK(catalogue->subjects.size() == 12);
  REQUIRE(catalogue->actions.size() == twin_actions().size());
  for (std::size_t i = 0; i < catalogue->actions.size(); ++i) {
    CHECK(catalogue->actions[i].id == twin_actions()[i].id);
    CHECK(catalogue->actions[i].name == twin_actions()[i].name);
    CHECK_FALSE(twin_actions()[i].pieces.empty());
  }
}

TEST_CASE("all movements stand in some action") {
  std::set<Piece> all;
  for (const TwinAction& action : twin_actions()) {
    all.insert(action.pieces.begin(), action.pieces.end());
  }
  all.insert(Piece::t_pose);
  CHECK(all.size() == piece_names.size());
}

TEST_CASE("a programme begins in T-pose, is as long as asked, and has no piece under 5 s") {
  for (const auto seed : fresh_seeds(30)) {
    CAPTURE(seed);
    for (const TwinAction& action : twin_actions()) {
      for (const double length : {11.0, 31.0}) {
        const Programme programme = twin_programme(action, length, seed);
        CHECK(programme.front().piece == Piece::t_pose);
        double sum = 0.0;
        for (std::size_t i = 0; i < programme.size(); ++i) {
          sum += programme[i].length_s;
          if (i > 0) CHECK(programme[i].length_s >= 5.0);
        }
        CHECK(sum == about(length));
      }
    }
  }
}
