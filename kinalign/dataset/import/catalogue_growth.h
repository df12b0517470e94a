// SPDX-License-Identifier: Apache-2.0
// People, classes and actions are added to dataset.toml as text, so that what its user wrote, with
// comments and order, stays as it is.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/catalogue.h"

#include <string>
#include <vector>

namespace kinalign {

/// Entries that a data set has to have; those that are there already are passed over.
struct CatalogueNeeds {
  std::vector<std::string> subjects;
  std::vector<ActionClass> classes;  // those of `actions`
  std::vector<Action> actions;
};

/// The text with what it lacks at its end. Fails where it could not be read then, as where the
/// people stand in an inline table.
Result<std::string> grown_catalogue(const std::string& toml, const std::string& name,
                                    const CatalogueNeeds& needs);

}  // namespace kinalign
