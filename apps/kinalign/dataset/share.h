// SPDX-License-Identifier: Apache-2.0
// Which share of a build is this process's, by what a cluster's starter says in the environment.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/build.h"

#include <cstdint>
#include <functional>
#include <string>

namespace kinalign {

/// Tasks of a step: the first that is there of Open MPI (OMPI_COMM_WORLD_RANK, _SIZE), MPICH
/// (PMI_RANK, PMI_SIZE), srun (SLURM_PROCID of SLURM_STEP_NUM_TASKS, which a batch script alone has
/// not) and RANK of WORLD_SIZE. Jobs of a Slurm array: SLURM_ARRAY_TASK_ID less
/// SLURM_ARRAY_TASK_MIN plus `index_offset`, of SLURM_ARRAY_TASK_COUNT or, where it is set,
/// KINALIGN_SHARES. Where both are there, each job's share is divided among its tasks; where none
/// is, it is all of the build. Fails where the numbers do not go together.
Result<BuildShare> share_of(const std::function<std::string(const std::string&)>& variable,
                            std::int64_t index_offset);

/// The share of this task among those of its step alone, whatever array the job is in.
Result<BuildShare> step_share_of(const std::function<std::string(const std::string&)>& variable);

}  // namespace kinalign
