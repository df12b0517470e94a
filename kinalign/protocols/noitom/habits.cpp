// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/habits.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t remembered_steps = 16;
// Of these. Two losses that join two steps to one are rarer, unless a fifth of all is lost.
constexpr std::ptrdiff_t often = 4;
constexpr std::size_t remembered_frames = 8, enough_frames = 4;
// Pieces of one frame are sent back to back, and the fastest suits send a frame each 8 ms.
constexpr Duration short_spread = std::chrono::milliseconds(4);

template <class Value>
void remember(std::deque<Value>& lately, const Value& value, std::size_t most) {
  lately.push_back(value);
  if (lately.size() > most) lately.pop_front();
}

}  // namespace

void NoitomSteps::push(std::optional<NoitomStep> step) {
  remember(lately_, step, remembered_steps);
}

bool NoitomSteps::is_usual(const NoitomStep& step) const {
  return std::count(lately_.begin(), lately_.end(), step) >= often;
}

// Numbers with none between have no frame between, where there is one avatar. Of several the steps
// of the others are not here: the step is theirs where it is nearly always so.
bool NoitomSteps::is_whole(const NoitomStep& step) const {
  if (step.avatar == 0 && !changes_avatar()) {
    return step == NoitomStep() || (is_usual(step) && !is_sum(step));
  }
  const auto known = std::count_if(lately_.begin(), lately_.end(),
                                   [](const auto& one) { return one.has_value(); });
  return is_usual(step) && 4 * std::count(lately_.begin(), lately_.end(), step) >= 3 * known;
}

// Of two and more that came one behind another.
bool NoitomSteps::is_sum(const NoitomStep& step) const {
  for (std::size_t first = 0; first + 1 < lately_.size(); ++first) {
    std::uint32_t sum = 0;
    for (std::size_t k = first; k < lately_.size() && lately_[k]; ++k) {
      sum += lately_[k]->index;
      if (k > first && sum == step.index) return true;
    }
  }
  return false;
}

// As of a sender that leaves out each sixth number. A frame that is missing breaks the row, unless
// frames go missing as regularly.
bool NoitomSteps::repeat_with(const NoitomStep& step) const {
  if (lately_.size() < remembered_steps) return false;
  if (std::find(lately_.begin(), lately_.end(), std::nullopt) != lately_.end()) return false;
  auto row = lately_;
  row.push_back(step);
  const auto repeats_after = [&row](std::size_t count) {
    return std::equal(row.begin() + static_cast<std::ptrdiff_t>(count), row.end(), row.begin());
  };
  for (std::size_t count = 1; count <= remembered_steps / 2; ++count) {
    if (repeats_after(count)) return true;
  }
  return false;
}

bool NoitomSteps::changes_avatar() const {
  return std::any_of(lately_.begin(), lately_.end(),
                     [](const auto& one) { return one && one->avatar != 0; });
}

// An end that came behind a whole period may be another frame's: nothing is learnt of it.
void NoitomPace::push(Duration spread, Duration to_next) {
  const bool is_own =
      periods_.empty() || spread < *std::min_element(periods_.begin(), periods_.end());
  if (is_own) remember(spreads_, spread, remembered_frames);
  remember(periods_, to_next, remembered_frames);
}

// Half-way from the latest end of a frame to the earliest beginning of the next one.
bool NoitomPace::is_in_time(Duration spread) const {
  if (spread <= short_spread) return true;
  if (spreads_.size() < enough_frames) return false;
  const Duration latest = *std::max_element(spreads_.begin(), spreads_.end());
  const Duration earliest = *std::min_element(periods_.begin(), periods_.end());
  return spread < (latest + earliest) / 2;
}

// Where a network hands on several frames at once, an end is as near to an earlier header as to its
// own.
bool NoitomPace::tells_apart(Duration spread) const {
  const bool bunched =
      !periods_.empty() && 2 * spread >= *std::min_element(periods_.begin(), periods_.end());
  return !bunched && is_in_time(spread);
}

}  // namespace kinalign
