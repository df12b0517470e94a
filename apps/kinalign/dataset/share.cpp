// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/share.h"

#include "kinalign/core/numbers.h"

#include <array>
#include <optional>

namespace kinalign {

namespace {

/// The environment variables of one kind of starter. Both rank and size must be set.
struct Names {
  const char *rank, *size, *least;  // `least`: the first rank of an array, subtracted from the
                                    // rank; nullptr: 0
};
constexpr Names array{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"};
// The innermost starter first: mpirun inside a step of srun starts the tasks itself.
constexpr std::array<Names, 4> steps{{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
                                      {"PMI_RANK", "PMI_SIZE", nullptr},
                                      {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", nullptr},
                                      {"RANK", "WORLD_SIZE", nullptr}}};

using Variable = std::function<std::string(const std::string&)>;

/// A whole decimal number of at least 0. Anything else, also a number with text after it, is
/// absent.
std::optional<std::int64_t> number(const std::string& text) {
  std::int64_t value = 0;
  return parse_integer(text, value) && value >= 0 ? std::optional(value) : std::nullopt;
}

// A rank without a size says nothing about the share. A Slurm batch script alone has such a rank.
bool is_there(const Names& names, const Variable& variable) {
  return !variable(names.rank).empty() && !variable(names.size).empty();
}

/// The share by these variables. `shares`: replaces the size; empty: the size counts.
Result<BuildShare> read(const Names& names, const Variable& variable, const std::string& shares,
                        std::int64_t offset) {
  const std::string rank_text = variable(names.rank);
  const std::string size_text = shares.empty() ? variable(names.size) : shares;
  const auto rank = number(rank_text), size = number(size_text);
  const auto least = names.least == nullptr ? 0 : number(variable(names.least)).value_or(0);
  // A rank that can't be read, or lies outside of the size, is refused below.
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
    // The first starter that is present wins, since an inner one passes on the variables of the
    // outer one.
    if (is_there(names, variable)) return read(names, variable, "", 0);
  }
  return BuildShare{};
}

Result<BuildShare> share_of(const Variable& variable, std::int64_t index_offset) {
  // The default share is 0 of 1. Both divisions are multiplied: task i of job j is number j * tasks
  // + i.
  BuildShare outer;
  if (is_there(array, variable)) {
    outer = KA_TRY(read(array, variable, variable("KINALIGN_SHARES"), index_offset));
  }
  const BuildShare inner = KA_TRY(step_share_of(variable));
  return BuildShare{outer.rank * inner.size + inner.rank, outer.size * inner.size};
}

}  // namespace kinalign
