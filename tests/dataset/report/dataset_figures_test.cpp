// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/dataset_figures.h"

#include "tests/dataset/report/summarised_set.h"

using namespace kinalign;

TEST_CASE("the worst takes come first, and a page that can't have all of them has the worst") {
  SummarisedSet set;
  set.put({"01", "A", 1}, SummarisedSet::summary(0, 0, 0.02));
  set.put({"01", "A", 2}, SummarisedSet::summary(0, 0, 0.05));
  set.put({"01", "A", 3}, SummarisedSet::summary(0, 2, 0.01));
  set.put({"02", "A", 1}, SummarisedSet::summary(1, 0, 0.01));
  set.put({"02", "A", 2}, SummarisedSet::summary(0, 3, 0.01));
  set.folder.write(path_of({"02", "A", 3}, TakeFile::manifest), "");
  const DatasetIndex index = set.open();
  const auto page = dataset_figures(index, set.folder.path(), 4);
  REQUIRE(page);
  std::vector<std::string> names;
  for (const DatasetTake& take : page->worst) names.push_back(take.name);
  CHECK(names == std::vector<std::string>{"sub-02_task-A_run-01", "sub-02_task-A_run-02",
                                          "sub-01_task-A_run-03", "sub-01_task-A_run-02"});
  CHECK(page->takes == 5);
  CHECK(page->people == 2);
  CHECK(page->mocap_frames == 3000);
  CHECK(page->seconds == doctest::Approx(50.0));
  CHECK(page->bad == 1);
  CHECK(page->usable == 2);
  CHECK(page->good == 2);
  CHECK(page->not_built == 1);
  CHECK(page->worst[0].class_id == "S1");
  CHECK(page->worst[3].residual_cm == doctest::Approx(5.0));
  CHECK(page->tables.size() == 3);
}
