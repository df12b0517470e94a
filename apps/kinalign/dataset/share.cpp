// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/share.h"

#include <array>
#include <charconv>
#include <optional>

namespace kinalign {

namespace {

struct Names {
  const char *rank, *size, *least;  // `least`: taken off the rank; nullptr: nothing
};
constexpr std::array<Names, 5> starters{
    {{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
     {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", nullptr},
     {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", nullptr},
     {"PMI_RANK", "PMI_SIZE", nullptr},
     {"RANK", "WORLD_SIZE", nullptr}}};

std::optional<std::int64_t> number(const std::string& text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [behind, fault] = std::from_chars(text.data(), end, value);
  const bool good = fault == std::errc{} && behind == end && value >= 0;
  return good ? std::optional(value) : std::nullopt;
}

}  // namespace

Result<BuildShare> share_of(const std::function<std::string(const std::string&)>& variable,
                            std::int64_t index_offset) {
  for (const Names& names : starters) {
    const std::string rank_text = variable(names.rank), size_text = variable(names.size);
    if (rank_text.empty() || size_text.empty()) continue;
    const auto rank = number(rank_text);
    const std::string shares = variable("KINALIGN_SHARES");
    const auto size = number(shares.empty() ? size_text : shares);
    const auto least = names.least == nullptr ? 0 : number(variable(names.least)).value_or(0);
    const std::int64_t offset = names.least == nullptr ? 0 : index_offset;
    const std::int64_t own = rank.value_or(-1) - least + offset;
    if (rank && size && own >= 0 && own < *size) {
      return BuildShare{static_cast<std::size_t>(own), static_cast<std::size_t>(*size)};
    }
    return Failure(Error{names.rank, 0,
                         std::string("a number below ") + names.size +
                             " (of a larger array KINALIGN_SHARES says how many there are in all)",
                         rank_text + " of " + (shares.empty() ? size_text : shares)});
  }
  return BuildShare{};
}

}  // namespace kinalign
