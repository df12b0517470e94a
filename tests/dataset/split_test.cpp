// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/split.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace kinalign;

namespace {

Catalogue catalogue() { return *read_catalogue(*catalogue_template("hfut-mmd", "x"), "x"); }

/// Takes with the people and actions of the template: each person does some actions of each class.
std::vector<SplitTake> many() {
  std::vector<SplitTake> out;
  const Catalogue of = catalogue();
  for (std::size_t i = 0; i < 340; ++i) {
    SplitTake take;
    take.name = {of.subjects[(i * 7) % 12].id, of.actions[i % 34].id,
                 static_cast<std::uint32_t>(i + 1)};
    take.summary.frames = 100 + (i * 37) % 900;
    take.summary.sha256 = "take " + std::to_string(i);
    take.summary.inputs = {{"a.bvh", "raw " + std::to_string(i), 1}, {"rig.toml", "rig", 1}};
    take.summary.sample_files = {"a.bvh"};
    take.summary.streams.resize(i % 3 == 0 ? 3 : 2);
    take.summary.streams[1].modality = Modality::kinect;
    if (i % 3 == 0) take.summary.streams[2].modality = Modality::imu;
    out.push_back(take);
  }
  return out;
}

double share_of(const Split& split, const std::string& part, const std::vector<SplitTake>& takes,
                const std::string& of_class = "") {
  double own = 0.0, all = 0.0;
  for (const SplitPart& one : split.parts) {
    for (const TakeName& name : one.takes) {
      if (!name.action.starts_with(of_class)) continue;
      const auto take = std::find_if(takes.begin(), takes.end(),
                                     [&](const SplitTake& t) { return t.name == name; });
      all += static_cast<double>(take->summary.frames);
      if (one.name == part) own += static_cast<double>(take->summary.frames);
    }
  }
  return own / all;
}

std::size_t errors(const Findings& findings) {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [](const Finding& f) { return f.severity == Severity::error; }));
}

}  // namespace

TEST_CASE("whatever the seed, every take is in one part and the shares are those asked for") {
  const auto takes = many();
  for (std::int64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    const auto split = make_split(takes, catalogue(), {"take", 0.2, 0.1, seed, false});
    REQUIRE(split);
    REQUIRE(split->parts.size() == 3);
    CHECK(split->parts[0].takes.size() + split->parts[1].takes.size() +
              split->parts[2].takes.size() ==
          takes.size());
    CHECK(std::abs(share_of(*split, "test", takes) - 0.2) < 0.01);
    CHECK(std::abs(share_of(*split, "validation", takes) - 0.1) < 0.01);
    CHECK(errors(check_split(*split, takes, "s")) == 0);
  }
}

TEST_CASE("a split by people has no person in two parts") {
  const auto takes = many();
  for (std::int64_t seed = 0; seed < 50; ++seed) {
    const auto split = make_split(takes, catalogue(), {"subject", 0.25, 0.0, seed, false});
    REQUIRE(split);
    std::set<std::string> train, both;
    for (const TakeName& name : split->parts[0].takes) train.insert(name.subject);
    for (const TakeName& name : split->parts[1].takes) {
      if (train.contains(name.subject)) both.insert(name.subject);
    }
    CHECK(both.empty());
    // A person's takes stay together.
    CHECK(std::abs(share_of(*split, "test", takes) - 0.25) < 0.06);
    CHECK(check_split(*split, takes, "s").empty());
  }
}

TEST_CASE("a stratified split has the shares in each class") {
  const auto takes = many();
  const auto split = make_split(takes, catalogue(), {"take", 0.3, 0.0, 3, true});
  REQUIRE(split);
  for (const char* of : {"S1", "S2", "S3", "S4", "S5"}) {
    CAPTURE(of);
    CHECK(std::abs(share_of(*split, "test", takes, of) - 0.3) < 0.03);
  }
}

TEST_CASE("the same seed gives the same split, another one another, in whatever order takes come") {
  auto takes = many();
  const auto first = make_split(takes, catalogue(), {"take", 0.2, 0.0, 1, false});
  std::reverse(takes.begin(), takes.end());
  const auto again = make_split(takes, catalogue(), {"take", 0.2, 0.0, 1, false});
  const auto other = make_split(takes, catalogue(), {"take", 0.2, 0.0, 2, false});
  CHECK(first->parts[1].takes == again->parts[1].takes);
  CHECK(first->parts[1].takes != other->parts[1].takes);
}

TEST_CASE("the test has the people who are named, the training all others") {
  const auto takes = many();
  SplitOptions options;
  options.test_people = {"03", "11"};
  const auto split = make_split(takes, catalogue(), options);
  REQUIRE(split);
  REQUIRE(split->parts.size() == 2);
  CHECK(split->parts[0].name == "train");
  CHECK(split->parts[1].name == "test");
  CHECK(split->parts[0].takes.size() + split->parts[1].takes.size() == takes.size());
  std::map<std::string, std::set<std::string>> people;
  for (const SplitPart& part : split->parts) {
    for (const TakeName& name : part.takes) people[part.name].insert(name.subject);
  }
  CHECK(people["test"] == std::set<std::string>{"03", "11"});
  CHECK(people["train"].size() == 10);
  const std::string json = split_json(*split, takes);
  const auto again = parse_split_json(json, "s.json");
  REQUIRE(again);
  CHECK(split_json(*again, takes) == json);
  CHECK(again->options.test_people == options.test_people);
  options.test_people = {"03", "nobody"};
  CHECK(to_string(make_split(takes, catalogue(), options).error()) ==
        "expected a subject that has takes (known: 00, 01, 02, 03, 04, 05, 06, 07, ...), found "
        "\"nobody\"");
}

TEST_CASE("leave one out has a part for each person") {
  const auto split = make_split(many(), catalogue(), {"leave-one-out", 0.2, 0.0, 1, false});
  REQUIRE(split);
  CHECK(split->parts.size() == 12);
  for (const SplitPart& part : split->parts) {
    CHECK(std::all_of(part.takes.begin(), part.takes.end(),
                      [&](const TakeName& name) { return name.subject == part.name; }));
  }
}

TEST_CASE("the paper's two splits have the people, modalities and classes that it names") {
  const auto takes = many();
  const auto denoise = make_split(takes, catalogue(), {"hfut-denoise", 0.2, 0.0, 1, false});
  REQUIRE(denoise);
  std::set<std::string> people;
  for (const SplitPart& part : denoise->parts) {
    for (const TakeName& name : part.takes) people.insert(name.subject);
  }
  CHECK(people == std::set<std::string>{"00", "03", "06", "11"});
  const auto imu = make_split(takes, catalogue(), {"hfut-imu", 0.2, 0.0, 1, false});
  REQUIRE(imu);
  std::set<std::string> train, test;
  for (const TakeName& name : imu->parts[0].takes) train.insert(name.action.substr(0, 2));
  for (const TakeName& name : imu->parts[1].takes) test.insert(name.action.substr(0, 2));
  CHECK(train == std::set<std::string>{"S2", "S3", "S5"});
  CHECK(test == std::set<std::string>{"S1", "S4", "S6"});
  CHECK(imu->parts[0].takes.size() + imu->parts[1].takes.size() == 114);  // with nodes
}

TEST_CASE("a leak is found by the name and by the bytes") {
  auto takes = many();
  Split split = *make_split(takes, catalogue(), {"subject", 0.25, 0.0, 1, false});
  Split doubled = split;
  doubled.parts[0].takes.push_back(split.parts[1].takes.front());
  CHECK(errors(check_split(doubled, takes, "s")) >= 2);  // the take, and the person
  const auto find = [&](const TakeName& name) {
    return std::find_if(takes.begin(), takes.end(),
                        [&](const SplitTake& t) { return t.name == name; });
  };
  find(split.parts[0].takes.front())->summary.inputs.front().sha256 =
      find(split.parts[1].takes.front())->summary.inputs.front().sha256;
  const Findings by_bytes = check_split(split, takes, "s");
  REQUIRE(errors(by_bytes) == 1);
  CHECK(by_bytes.front().what.expected == "the same bytes in one part only");
  takes.erase(find(split.parts[0].takes.back()));
  CHECK(errors(check_split(split, takes, "s")) == 2);
}

TEST_CASE("takes that have a layout in common are no leak") {
  const auto takes = many();  // rig.toml is the same in all of them
  const Split split = *make_split(takes, catalogue(), {"subject", 0.25, 0.0, 1, false});
  CHECK(errors(check_split(split, takes, "s")) == 0);
}

TEST_CASE("leaks come before takes that were made again, which are one line") {
  auto takes = many();
  const Split made = *make_split(takes, catalogue(), {"subject", 0.25, 0.0, 1, false});
  Split read = *parse_split_json(split_json(made, takes), "s");
  for (SplitTake& take : takes) take.summary.sha256 += " again";
  read.parts[0].takes.push_back(read.parts[1].takes.front());
  const Findings found = check_split(read, takes, "s");
  CHECK(found.front().severity == Severity::error);
  CHECK(found.back().severity == Severity::warning);
  CHECK(found.back().what.found.find(std::to_string(takes.size()) + " made again: ") !=
        std::string::npos);
  CHECK(found.size() == errors(found) + 1);
}

TEST_CASE("a take that was made again since is a warning of its split") {
  auto takes = many();
  const Split made = *make_split(takes, catalogue(), {"subject", 0.25, 0.0, 1, false});
  const Split read = *parse_split_json(split_json(made, takes), "s");
  CHECK(check_split(read, takes, "s").empty());
  takes[5].summary.sha256 = "another";
  const Findings found = check_split(read, takes, "s");
  REQUIRE(found.size() == 1);
  CHECK(found[0].severity == Severity::warning);
}

TEST_CASE("a split reads back as it was written") {
  const auto takes = many();
  const Split split = *make_split(takes, catalogue(), {"take", 0.2, 0.1, 5, true});
  const std::string json = split_json(split, takes);
  const auto again = parse_split_json(json, "s.json");
  REQUIRE(again);
  CHECK(split_json(*again, takes) == json);
  for (const char* text : {"", "{}", "{\"schema\": \"kinalign.split/2\"}", "[]"}) {
    CHECK_FALSE(parse_split_json(text, "s.json"));
  }
}
