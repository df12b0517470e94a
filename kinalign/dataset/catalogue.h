// SPDX-License-Identifier: Apache-2.0
// The content of dataset.toml: who was recorded, doing what, with which devices, and on what terms
// others may use it. Documented for users in docs/formats/dataset.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"
#include "kinalign/take/manifest.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A person who was recorded. The id is a pseudonym; who it is stands nowhere in the data set.
struct Subject {
  std::string id;          // letters and digits: "07"
  std::string sex;         // "f", "m" or "x"; empty: not said
  std::string handedness;  // "right", "left" or "both"; empty: not said
  std::string consent;     // to what, and where the paper lies: "released, form 12"
  std::optional<double> height_cm, weight_kg;
  std::map<std::string, double> segments_m;  // lengths: "upper_arm_left" -> 0.31
};

/// Actions of one kind (paper, table 7): "S2", Baduanjin.
struct ActionClass {
  std::string id, name;
};

struct Action {
  std::string id;        // letters and digits: "S2A03"
  std::string class_id;  // of one of the classes
  std::string name;
};

/// A device or a rig, described by texts of the lab's choice: make, model, software.
struct Described {
  std::string id;
  std::map<std::string, std::string> texts;
};

struct Catalogue {
  std::string name, licence, contact, description, citation;
  std::vector<Subject> subjects;
  std::vector<ActionClass> classes;
  std::vector<Action> actions;
  std::vector<Described> devices, rigs;
  AlignOptions align;  // what manifests of takes leave open
};

Fields describe(Catalogue& catalogue);  // its texts
Fields describe(Subject& subject);

/// nullptr where there is none of that id.
const Subject* find_subject(const Catalogue& catalogue, std::string_view id);
const Action* find_action(const Catalogue& catalogue, std::string_view id);

/// Reads dataset.toml. `name` appears in messages. An unknown key, a value out of range, an id that
/// could stand in no file name, and an action of no known class are refused with their line.
Result<Catalogue> read_catalogue(std::string_view toml, std::string_view name);

/// The text of a new dataset.toml. `template_name`: "empty", or "hfut-mmd" with the paper's 12
/// people, 6 classes and 34 actions. The paper names no action and does not say how many each class
/// has: ids are neutral, and the shares are ours (8, 8, 5, 5, 6, 2).
Result<std::string> catalogue_template(std::string_view template_name, const std::string& name);
std::vector<std::string> catalogue_template_names();
/// The beginning of both: the texts, without people, classes and actions.
std::string catalogue_head(const std::string& name, const std::string& licence,
                           const std::string& citation);

}  // namespace kinalign
