// SPDX-License-Identifier: Apache-2.0
// Finds which part of a build this process makes, from the environment variables of a cluster.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/build.h"

#include <cstdint>
#include <functional>
#include <string>

namespace kinalign {

/// The share of the build that falls to this process. The jobs of a Slurm array divide the build
/// first: this job is number SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN + `index_offset`. The
/// number of jobs is KINALIGN_SHARES if set, else SLURM_ARRAY_TASK_COUNT. Then the tasks within a
/// job divide its share, see step_share_of(). Without any variable this process makes the whole
/// build. Fails if the numbers contradict each other.
Result<BuildShare> share_of(const std::function<std::string(const std::string&)>& variable,
                            std::int64_t index_offset);

/// The share that falls to this process among the tasks of one job, without regard to a Slurm
/// array. The first variables that are set count: OMPI_COMM_WORLD_RANK and _SIZE (Open MPI),
/// PMI_RANK and PMI_SIZE (MPICH), SLURM_PROCID and SLURM_STEP_NUM_TASKS (srun), RANK and
/// WORLD_SIZE. A process started by hand has share 0 of 1, the whole work. `train` calls it for its
/// processes.
Result<BuildShare> step_share_of(const std::function<std::string(const std::string&)>& variable);

}  // namespace kinalign
