// SPDX-License-Identifier: Apache-2.0
// Adds people, classes and actions to dataset.toml as text, so that the user's own text stays, with
// its comments and its order.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/catalogue.h"

#include <string>
#include <vector>

namespace kinalign {

/// Entries that a data set must have. Existing ones are skipped.
struct CatalogueNeeds {
  std::vector<std::string> subjects;
  std::vector<ActionClass> classes;  // the classes of `actions`
  std::vector<Action> actions;
};

/// The text with the missing entries at its end. Fails if the result could not be parsed, for
/// example if the people are in an inline table.
Result<std::string> grown_catalogue(const std::string& toml, const std::string& name,
                                    const CatalogueNeeds& needs);

}  // namespace kinalign
