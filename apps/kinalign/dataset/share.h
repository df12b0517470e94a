// SPDX-License-Identifier: Apache-2.0
// The share of a build that this process makes, by the environment variables of a cluster.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/build.h"

#include <cstdint>
#include <functional>
#include <string>

namespace kinalign {

/// The tasks of a step are those of the first of these that is set: Open MPI (OMPI_COMM_WORLD_RANK,
/// _SIZE), MPICH (PMI_RANK, PMI_SIZE), srun (SLURM_PROCID of SLURM_STEP_NUM_TASKS, which a batch
/// script alone does not have), RANK of WORLD_SIZE. The jobs of a Slurm array are
/// SLURM_ARRAY_TASK_ID minus SLURM_ARRAY_TASK_MIN plus `index_offset`, of SLURM_ARRAY_TASK_COUNT
/// or, if set, KINALIGN_SHARES. If both are set, each job's share is divided among its tasks; if
/// none is set, this process makes the whole build. Fails if the numbers contradict each other.
Result<BuildShare> share_of(const std::function<std::string(const std::string&)>& variable,
                            std::int64_t index_offset);

/// The share of this task among the tasks of its step, without regard to an array.
/// A process that is started by hand has the share 0 of 1, which is the whole work. `train` uses it
/// for its processes.
Result<BuildShare> step_share_of(const std::function<std::string(const std::string&)>& variable);

}  // namespace kinalign
