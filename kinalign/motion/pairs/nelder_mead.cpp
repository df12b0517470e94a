// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pairs/nelder_mead.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kinalign {

namespace {

constexpr double tolerance = 1e-4;
// The first simplex changes each number by this share of it, or a number that is 0 by first_step.
constexpr double first_share = 0.05, first_step = 0.00025;
constexpr std::size_t calls_a_number = 200;

/// A place and its cost. The cost is stored, because each call of the cost function visits all
/// frames.
struct Corner {
  std::vector<double> at;
  double cost = 0.0;
};

/// n + 1 corners for n numbers, sorted by cost: the best first, the worst last.
class Simplex {
 public:
  Simplex(const CostFunction& cost, const std::vector<double>& start) : cost_(cost) {
    add(start);
    for (std::size_t k = 0; k < start.size(); ++k) {
      std::vector<double> at = start;
      at[k] = at[k] != 0.0 ? (1.0 + first_share) * at[k] : first_step;
      add(std::move(at));
    }
    // The first corner is `start`; each other corner differs from it in one number.
    sort();
  }

  std::size_t calls() const { return calls_; }
  const std::vector<double>& best() const { return corners_.front().at; }

  bool is_small() const {
    double size = 0.0, rise = 0.0;
    for (const Corner& corner : corners_) {
      rise = std::max(rise, std::abs(corner.cost - corners_.front().cost));
      for (std::size_t k = 0; k < corner.at.size(); ++k) {
        size = std::max(size, std::abs(corner.at[k] - best()[k]));
      }
    }
    // The corners must be close to each other and have about the same cost, as in SciPy.
    return size <= tolerance && rise <= tolerance;
  }

  /// One step of Nelder and Mead: replaces the worst corner by its reflection, expansion or
  /// contraction, or shrinks all corners towards the best.
  void step() {
    const std::vector<double> middle = middle_of_others();
    Corner& worst = corners_.back();
    Corner reflected = corner(middle, 1.0);
    // The reflected corner is better than the best one, so a longer step is tried, too.
    if (reflected.cost < corners_.front().cost) {
      Corner expanded = corner(middle, 2.0);
      worst = expanded.cost < reflected.cost ? std::move(expanded) : std::move(reflected);
    } else if (reflected.cost < corners_[corners_.size() - 2].cost) {
      worst = std::move(reflected);
    } else {
      // The reflected corner is not better than the second worst. A contraction is tried on the
      // better side of the middle.
      const bool outside = reflected.cost < worst.cost;
      Corner contracted = corner(middle, outside ? 0.5 : -0.5);
      const bool better =
          outside ? contracted.cost <= reflected.cost : contracted.cost < worst.cost;
      if (better) {
        worst = std::move(contracted);
      } else {
        shrink();
      }
    }
    sort();
  }

 private:
  Corner at(std::vector<double> place) {
    ++calls_;
    const double cost = cost_(place);
    return {std::move(place), cost};
  }
  void add(std::vector<double> place) { corners_.push_back(at(std::move(place))); }

  /// The mean of all corners except the worst.
  std::vector<double> middle_of_others() const {
    std::vector<double> middle(best().size());
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
      for (std::size_t k = 0; k < middle.size(); ++k) middle[k] += corners_[i].at[k];
    }
    for (double& value : middle) value /= static_cast<double>(middle.size());
    return middle;
  }

  /// The place on the line from the worst corner through `middle`, beyond it by `share` of their
  /// distance.
  Corner corner(const std::vector<double>& middle, double share) {
    std::vector<double> place(middle.size());
    for (std::size_t k = 0; k < place.size(); ++k) {
      place[k] = (1.0 + share) * middle[k] - share * corners_.back().at[k];
    }
    return at(std::move(place));
  }

  void shrink() {
    // The best corner stays. All others must be computed again.
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      std::vector<double> place = corners_[i].at;
      for (std::size_t k = 0; k < place.size(); ++k) {
        place[k] = best()[k] + 0.5 * (place[k] - best()[k]);
      }
      corners_[i] = at(std::move(place));
    }
  }

  /// Stable, so that equal costs keep their order and the result does not depend on the library.
  void sort() {
    std::stable_sort(corners_.begin(), corners_.end(),
                     [](const Corner& a, const Corner& b) { return a.cost < b.cost; });
  }

  const CostFunction& cost_;
  std::vector<Corner> corners_;
  std::size_t calls_ = 0;
};

}  // namespace

std::vector<double> minimise(const CostFunction& cost, const std::vector<double>& start) {
  const std::size_t most = calls_a_number * start.size();
  Simplex simplex(cost, start);
  // SciPy has the same limit for steps and for calls of the cost function.
  for (std::size_t steps = 1; steps < most && simplex.calls() < most; ++steps) {
    if (simplex.is_small()) break;
    simplex.step();
  }
  return simplex.best();
}

}  // namespace kinalign
