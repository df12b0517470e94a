// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/share.h"

#include <doctest/doctest.h>

#include <map>

using namespace kinalign;

namespace {

using Environment = std::map<std::string, std::string>;

Result<BuildShare> share(const Environment& environment, std::int64_t offset = 0) {
  return share_of(
      [&](const std::string& name) {
        const auto found = environment.find(name);
        return found == environment.end() ? std::string() : found->second;
      },
      offset);
}

void check(const Environment& environment, std::size_t rank, std::size_t size,
           std::int64_t offset = 0) {
  const auto found = share(environment, offset);
  REQUIRE(found);
  CHECK(found->rank == rank);
  CHECK(found->size == size);
}

}  // namespace

TEST_CASE("a build outside a cluster makes all takes") {
  check({}, 0, 1);
  check({{"SLURM_NTASKS", "8"}, {"SLURM_PROCID", "0"}}, 0, 1);  // a batch script, not srun
}

TEST_CASE("each starter of a cluster says which share a process has") {
  check({{"SLURM_PROCID", "3"}, {"SLURM_STEP_NUM_TASKS", "8"}}, 3, 8);
  check({{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "2"}}, 1, 2);
  check({{"PMI_RANK", "1"}, {"PMI_SIZE", "4"}}, 1, 4);
  check({{"RANK", "0"}, {"WORLD_SIZE", "2"}}, 0, 2);
  check({{"SLURM_ARRAY_TASK_ID", "7"},
         {"SLURM_ARRAY_TASK_COUNT", "4"},
         {"SLURM_ARRAY_TASK_MIN", "5"}},
        2, 4);
}

TEST_CASE("arrays whose numbers are limited are put together by an offset") {
  const Environment second{{"SLURM_ARRAY_TASK_ID", "0"},
                           {"SLURM_ARRAY_TASK_COUNT", "1000"},
                           {"SLURM_ARRAY_TASK_MIN", "0"},
                           {"KINALIGN_SHARES", "2000"}};
  check(second, 1000, 2000, 1000);
}

TEST_CASE("tasks of a step within an array divide the share of their job") {
  const Environment job{{"SLURM_ARRAY_TASK_ID", "3"},
                        {"SLURM_ARRAY_TASK_COUNT", "4"},
                        {"SLURM_ARRAY_TASK_MIN", "1"},
                        {"SLURM_PROCID", "1"},
                        {"SLURM_STEP_NUM_TASKS", "2"}};
  check(job, 5, 8);
  // mpirun's numbers take precedence over those of the SLURM step that started it.
  Environment within = job;
  within["OMPI_COMM_WORLD_RANK"] = "2";
  within["OMPI_COMM_WORLD_SIZE"] = "3";
  check(within, 8, 12);
}

TEST_CASE("numbers that do not go together are refused") {
  CHECK_FALSE(share({{"RANK", "2"}, {"WORLD_SIZE", "2"}}));
  CHECK_FALSE(share({{"RANK", "x"}, {"WORLD_SIZE", "2"}}));
  CHECK_FALSE(share(
      {{"SLURM_ARRAY_TASK_ID", "0"}, {"SLURM_ARRAY_TASK_COUNT", "2"}, {"KINALIGN_SHARES", "x"}}));
}
