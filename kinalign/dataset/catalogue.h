// SPDX-License-Identifier: Apache-2.0
// The content of dataset.toml: the people, the actions, the devices, and the terms of use.
// Documented for users in docs/formats/dataset.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"
#include "kinalign/take/manifest.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A recorded person. The id is a pseudonym; the data set does not contain the person's name.
struct Subject {
  std::string id;          // letters and digits: "07"
  std::string sex;         // "f", "m" or "x"; empty: not stated
  std::string handedness;  // "right", "left" or "both"; empty: not stated
  std::string consent;     // extent of the consent, and the place of the form: "released, form 12"
  std::optional<double> height_cm, weight_kg;
  std::map<std::string, double> segments_m;  // lengths: "upper_arm_left" -> 0.31
};

/// Actions of one kind, as in table 7 of the HFUT-MMD paper: "S2", Baduanjin.
struct ActionClass {
  std::string id, name;
};

/// One action: what the person does. Its class groups actions of one kind.
struct Action {
  std::string id;        // letters and digits: "S2A03"
  std::string class_id;  // id of one of the classes
  std::string name;
};

/// A device or a rig, described by texts that the lab chooses: make, model, software.
struct Described {
  std::string id;
  std::map<std::string, std::string> texts;
};

/// All of dataset.toml. Any combination of values can be written; read_catalogue() checks what a
/// file says.
struct Catalogue {
  std::string name, licence, contact, description, citation;
  std::vector<Subject> subjects;
  std::vector<ActionClass> classes;
  std::vector<Action> actions;
  std::vector<Described> devices, rigs;
  AlignOptions align;  // defaults for the manifests of takes
};

/// Names, meanings and ranges of the keys of each structure, for reading and writing dataset.toml.
Fields describe(Catalogue& catalogue);  // the texts at the top
Fields describe(Subject& subject);
Fields describe(ActionClass& one);
Fields describe(Action& action);

/// The entry with that id; nullptr if there is none.
template <class One>
const One* find_id(const std::vector<One>& all, std::string_view id) {
  const auto found =
      std::find_if(all.begin(), all.end(), [id](const One& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}
const Subject* find_subject(const Catalogue& catalogue, std::string_view id);
const Action* find_action(const Catalogue& catalogue, std::string_view id);

/// Reads dataset.toml. `name` appears in messages. Fails, with the line, at an unknown key, a value
/// out of range, an id that a file name can't contain, and an action of an unknown class.
Result<Catalogue> read_catalogue(std::string_view toml, std::string_view name);

/// The TOML text of `catalogue`, with all values that differ from the defaults.
std::string catalogue_toml(const Catalogue& catalogue);

/// The text of a new dataset.toml. `template_name`: "empty", or "hfut-mmd" with the 12 people, 6
/// classes and 34 actions of the HFUT-MMD paper (README.md). The paper does not name the actions
/// and does not state their number in each class. Names are therefore ids, and the numbers are ours
/// (8, 8, 5, 5, 6, 2).
Result<std::string> catalogue_template(std::string_view template_name, const std::string& name);
/// The names that catalogue_template() knows.
std::vector<std::string> catalogue_template_names();
/// The first lines of both templates: name, licence and other texts, without people, classes and
/// actions.
std::string catalogue_head(const std::string& name, const std::string& licence,
                           const std::string& citation);

}  // namespace kinalign
