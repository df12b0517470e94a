// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/catalogue_growth.h"

#include "kinalign/syntax/toml.h"

#include <set>

namespace kinalign {

Result<std::string> grown_catalogue(const std::string& toml, const std::string& name,
                                    const CatalogueNeeds& needs) {
  const Catalogue has = KA_TRY(read_catalogue(toml, name));
  // Actions come after the classes that they name, so the file reads from top to bottom.
  std::string more, actions;
  for (const std::string& id : needs.subjects) {
    // Existing entries stay as the user wrote them.
    if (find_subject(has, id) == nullptr) more += toml_head("subject", id);
  }
  std::set<std::string> classes;
  for (const Action& action : needs.actions) {
    if (find_action(has, action.id) != nullptr) continue;
    classes.insert(action.class_id);
    actions += toml_head("action", action.id) + "class = " + toml_string(action.class_id) +
               "\nname = " + toml_string(action.name) + "\n";
  }
  for (const ActionClass& one : needs.classes) {
    // If the user has described a class, that description is kept.
    if (!classes.contains(one.id) || find_id(has.classes, one.id) != nullptr) continue;
    more += toml_head("class", one.id) + "name = " + toml_string(one.name) + "\n";
  }
  more += actions;
  if (more.empty()) return toml;
  // The result is parsed before it is written, because tables at the end can conflict with an
  // inline table.
  const std::string grown = toml + (toml.empty() || toml.ends_with('\n') ? "" : "\n") + more;
  const auto read = read_catalogue(grown, name);
  if (read) return grown;
  return Failure(Error{name, 0, "a file to which [subject.ID] and [action.ID] can be appended",
                       to_string(read.error())});
}

}  // namespace kinalign
