// SPDX-License-Identifier: Apache-2.0
// The 34 actions of the template hfut-mmd, each with a name and its movements. The paper names no
// action; names and movements are ours.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/simulate/person/programme.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// An action with its movements. They repeat, so an action fits a take of any length.
struct TwinAction {
  std::string_view id, name;
  std::vector<Piece> pieces;  // in order, again from the first until the take ends
};

/// In the order of their ids.
const std::vector<TwinAction>& twin_actions();

/// The actions of a class, such as "S2".
std::vector<const TwinAction*> twin_actions_of(std::string_view class_id);

/// Two seconds of T-pose, then the action's movements from a drawn one on, each for a drawn time,
/// until `length_s` (at least 7 s) is reached.
Programme twin_programme(const TwinAction& action, double length_s, std::uint64_t seed);

/// A dataset.toml: the template hfut-mmd with the names of actions. Its description says that it is
/// simulated, so that nobody takes it for the paper's data.
Result<std::string> twin_catalogue(const std::string& name);

}  // namespace kinalign
