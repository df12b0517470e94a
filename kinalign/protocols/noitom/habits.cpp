// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/habits.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t remembered_steps = 16;
// A step occurs often if so many remembered steps equal it. Two losses rarely join two steps to the
// same sum so often, unless a fifth of all datagrams is lost.
constexpr std::ptrdiff_t often = 4;
constexpr std::size_t remembered_frames = 8, enough_frames = 4;
// A sender sends the pieces of one frame without pause, and the fastest suits send a frame every 8
// ms.
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

// With one avatar, consecutive numbers have no frame between them. With several avatars, the steps
// of the others are not in this list; a step is then accepted if nearly all known steps equal it.
bool NoitomSteps::is_whole(const NoitomStep& step) const {
  if (step.avatar == 0 && !changes_avatar()) {
    return step == NoitomStep() || (is_usual(step) && !is_sum(step));
  }
  const auto known = std::count_if(lately_.begin(), lately_.end(),
                                   [](const auto& one) { return one.has_value(); });
  return is_usual(step) && 4 * std::count(lately_.begin(), lately_.end(), step) >= 3 * known;
}

// True if two or more consecutive steps add up to this one.
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

// For example a sender that leaves out every sixth number. A missing frame breaks the pattern,
// unless frames are lost in the same rhythm.
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

// A last piece that arrived after a whole period may belong to another frame, so its delay is not
// learnt.
void NoitomPace::push(Duration spread, Duration to_next) {
  const bool is_own =
      periods_.empty() || spread < *std::min_element(periods_.begin(), periods_.end());
  if (is_own) remember(spreads_, spread, remembered_frames);
  remember(periods_, to_next, remembered_frames);
}

// The limit lies half-way from the latest end of a frame to the earliest start of the next one.
bool NoitomPace::is_in_time(Duration spread) const {
  if (spread <= short_spread) return true;
  if (spreads_.size() < enough_frames) return false;
  const Duration latest = *std::max_element(spreads_.begin(), spreads_.end());
  const Duration earliest = *std::min_element(periods_.begin(), periods_.end());
  return spread < (latest + earliest) / 2;
}

// If the network delivers several frames at once, a last piece is as near to an earlier header as
// to its own.
bool NoitomPace::tells_apart(Duration spread) const {
  const bool bunched =
      !periods_.empty() && 2 * spread >= *std::min_element(periods_.begin(), periods_.end());
  return !bunched && is_in_time(spread);
}

}  // namespace kinalign
