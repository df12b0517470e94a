// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/file_names.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// "subject action run" of each name.
std::vector<std::string> said(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const FileSays& one : read_file_names(names)) {
    out.push_back(one.subject + " " + one.action + " " + std::to_string(one.run));
  }
  return out;
}

using Said = std::vector<std::string>;

}  // namespace

TEST_CASE("CMU's names are a subject and a trial, whatever their folder") {
  CHECK(said({"01_02.bvh", "all/127_03.bvh"}) == Said{"01  2", "127  3"});
}

TEST_CASE("a number at the end of a name is a run") {
  CHECK(said({"walk.bvh", "walk_02.bvh", "walk3.bvh", "a-b-7.bvh", "12.bvh"}) ==
        Said{" walk 0", " walk 2", " walk 3", " a-b 7", "  12"});
  CHECK(said({"walk_20231224153000.bvh"}) == Said{" walk_20231224153000 0"});
}

TEST_CASE("Perception Neuron's character is no run") {
  CHECK(said({"down_1Char00.bvh", "Charlie.bvh", "Char00.bvh"}) ==
        Said{" down 1", " Charlie 0", " Char 0"});
}

TEST_CASE("a folder per person names the subjects, also below folders that all files share") {
  CHECK(said({"anna/walk.bvh", "bert/day/walk_2.bvh"}) == Said{"anna walk 0", "bert walk 2"});
  CHECK(said({"set/a/anna/walk.bvh", "set/a/bert/walk.bvh"}) == Said{"anna walk 0", "bert walk 0"});
  CHECK(said({"set/anna/walk.bvh", "set/anna/run.bvh"}) == Said{"anna walk 0", "anna run 0"});
}

TEST_CASE("folders are not people if files lie next to them") {
  CHECK(said({"walk.bvh", "odd/run.bvh"}) == Said{" walk 0", " run 0"});
}
