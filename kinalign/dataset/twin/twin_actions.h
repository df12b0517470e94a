// SPDX-License-Identifier: Apache-2.0
// The 34 actions of the template hfut-mmd, each with a name and its movements. The HFUT-MMD paper
// does not name its actions, so names and movements are ours.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/simulate/person/programme.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// An action with its movements. The movements repeat, so an action fits a take of any length.
struct TwinAction {
  std::string_view id, name;
  std::vector<Piece> pieces;  // in order; after the last one they begin again, until the take ends
};

/// All actions, in the order of their ids.
const std::vector<TwinAction>& twin_actions();

/// The actions of a class, such as "S2".
std::vector<const TwinAction*> twin_actions_of(std::string_view class_id);

/// The movements of a take: two seconds of T-pose, then the action's movements until `length_s` (at
/// least 7 s). The first movement and the length of each movement are drawn at random.
Programme twin_programme(const TwinAction& action, double length_s, std::uint64_t seed);

/// A dataset.toml: the template hfut-mmd with names of actions. Its description says that the data
/// are simulated, so that no one takes them for the data of the HFUT-MMD paper.
Result<std::string> twin_catalogue(const std::string& name);

}  // namespace kinalign
