// SPDX-License-Identifier: Apache-2.0
// Which share of a build is this process's, by what a cluster's starter says in the environment.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/build.h"

#include <cstdint>
#include <functional>
#include <string>

namespace kinalign {

/// The first that is there: a Slurm array (SLURM_ARRAY_TASK_ID less SLURM_ARRAY_TASK_MIN plus
/// `index_offset`, of SLURM_ARRAY_TASK_COUNT), srun (SLURM_PROCID of SLURM_STEP_NUM_TASKS, which a
/// batch script alone has not), Open MPI (OMPI_COMM_WORLD_RANK, _SIZE), MPICH (PMI_RANK, PMI_SIZE),
/// RANK of WORLD_SIZE; else all of it. KINALIGN_SHARES wins as the number of all shares. Fails
/// where the numbers do not go together.
Result<BuildShare> share_of(const std::function<std::string(const std::string&)>& variable,
                            std::int64_t index_offset);

}  // namespace kinalign
