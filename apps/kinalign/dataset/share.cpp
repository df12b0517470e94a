// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/share.h"

#include "kinalign/core/numbers.h"

#include <array>
#include <optional>

namespace kinalign {

namespace {

/// The environment variables by which a starter, such as mpirun, numbers its processes: `rank` is
/// the number of this process, `size` the number of all processes.
struct Names {
  // `least` is the first number of a Slurm array, which is subtracted from `rank`; nullptr: 0
  const char *rank, *size, *least;
};
constexpr Names array{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"};
// The order is from the innermost starter to the outermost: srun may start mpirun, which starts the
// processes.
constexpr std::array<Names, 4> steps{{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
                                      {"PMI_RANK", "PMI_SIZE", nullptr},
                                      {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", nullptr},
                                      {"RANK", "WORLD_SIZE", nullptr}}};

using Variable = std::function<std::string(const std::string&)>;

/// Parses a whole decimal number of at least 0. Empty for any other text, even for a number with
/// text after it.
std::optional<std::int64_t> number(const std::string& text) {
  std::int64_t value = 0;
  return parse_integer(text, value) && value >= 0 ? std::optional(value) : std::nullopt;
}

// True if the starter has set both variables. A Slurm script that was started without srun has a
// number but no number of processes.
bool is_there(const Names& names, const Variable& variable) {
  return !variable(names.rank).empty() && !variable(names.size).empty();
}

/// The part of the build that falls to this process by the variables of one starter. If `shares` is
/// not empty, it replaces the number of processes.
Result<BuildShare> read(const Names& names, const Variable& variable, const std::string& shares,
                        std::int64_t offset) {
  const std::string rank_text = variable(names.rank);
  const std::string size_text = shares.empty() ? variable(names.size) : shares;
  const auto rank = number(rank_text), size = number(size_text);
  const auto least = names.least == nullptr ? 0 : number(variable(names.least)).value_or(0);
  // If the number can't be read or is not below the number of processes, the function fails below.
  const std::int64_t own = rank.value_or(-1) - least + offset;
  if (rank && size && own >= 0 && own < *size) {
    return BuildShare{static_cast<std::size_t>(own), static_cast<std::size_t>(*size)};
  }
  return Failure(
      Error{names.rank, 0,
            std::string("a number below ") + names.size +
                " (if the array is larger, set KINALIGN_SHARES to the number of all jobs)",
            rank_text + " of " + size_text});
}

}  // namespace

Result<BuildShare> step_share_of(const Variable& variable) {
  for (const Names& names : steps) {
    // An inner starter passes on the variables of the outer one, so the first starter found is the
    // right one.
    if (is_there(names, variable)) return read(names, variable, "", 0);
  }
  return BuildShare{};
}

Result<BuildShare> share_of(const Variable& variable, std::int64_t index_offset) {
  // Without variables the share is number 0 of 1. If a Slurm array has several tasks in each job,
  // task i of job j is number j * (tasks per job) + i.
  BuildShare outer;
  if (is_there(array, variable)) {
    outer = KA_TRY(read(array, variable, variable("KINALIGN_SHARES"), index_offset));
  }
  const BuildShare inner = KA_TRY(step_share_of(variable));
  return BuildShare{outer.rank * inner.size + inner.rank, outer.size * inner.size};
}

}  // namespace kinalign
