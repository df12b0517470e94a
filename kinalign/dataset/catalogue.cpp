// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/catalogue.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/syntax/toml.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

// Limits of people's measures, so that a value in a wrong unit (metres for centimetres) is refused.
constexpr double least_m = 1e-6, most_m = 3.0, most_cm = 300.0, most_kg = 500.0;

/// Ids become parts of file names, so only letters and digits are allowed.
Result<void> check_id(const Value& entry) {
  if (is_label(entry.key)) return {};
  return at(entry, Error{"", 0, "an id of letters and digits, for file names", shown(entry.key)});
}

/// Reads the tables of one kind, [subject.ID], [class.ID] or [action.ID], into a list.
template <class One>
Result<void> read_each(const Value& tables, std::vector<One>& out) {
  for (const Value& one : KA_TRY(entries_of(tables))) {
    KA_TRY(check_id(one));
    // The entry is added first, because its options are read into it.
    One& made = out.emplace_back();
    made.id = one.key;
    KA_TRY(read_options(one, describe(made)));
  }
  return {};
}

/// Reads the tables [device.ID] or [rig.ID], which may have any keys.
Result<void> read_each(const Value& tables, std::vector<Described>& out) {
  for (const Value& one : KA_TRY(entries_of(tables))) {
    Described& made = out.emplace_back();
    made.id = one.key;
    KA_TRY(set_option({"", "", &made.texts}, one));
  }
  return {};
}

/// Fails if an action names a class that is not defined. It is called at the end, because a class
/// may be defined after the actions that name it.
Result<void> check_classes(const Value& top, const Catalogue& catalogue) {
  // Class ids may be defined anywhere in the file.
  std::vector<std::string> known;
  for (const ActionClass& one : catalogue.classes) known.push_back(one.id);
  for (const Action& action : catalogue.actions) {
    if (std::find(known.begin(), known.end(), action.class_id) != known.end()) continue;
    // The error has the line of the action's table.
    return at(*top.find({"action", action.id}),
              action.class_id.empty()
                  ? Error{"", 0, "class in [action." + action.id + "]", "none"}
                  : unknown_name(action.class_id, "a class of this file", known));
  }
  return {};
}

/// A number as in the ids of the templates: "07" for 7.
std::string two_digits(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

constexpr std::string_view head_of_template =
    R"(# A data set of kinalign: docs/formats/dataset.md lists every key.
name = {0}
licence = {1}       # terms under which others may use it: "CC BY 4.0"
contact = ""       # whom to ask
description = ""
citation = {2}

# [align]          defaults for the manifests of takes, as in a recording.toml

# People by pseudonyms. This folder never contains their names.
)";

constexpr std::string_view empty_template = R"(
# [subject.01]
# sex = "f"        # f, m, x
# height_cm = 165
# weight_kg = 60
# handedness = "right"
# consent = ""

# [class.S1]
# name = "walking"

# [action.S1A01]
# class = "S1"
# name = "a straight walk"
)";

/// A row of table 6 in the HFUT-MMD paper (README.md), as single people.
struct Person {
  std::string_view id, sex;
  int height_cm;
};
/// From table 6 of the HFUT-MMD paper.
constexpr Person people[] = {{"00", "m", 175}, {"01", "m", 180}, {"02", "m", 180},
                             {"03", "m", 175}, {"04", "m", 170}, {"05", "f", 165},
                             {"06", "m", 175}, {"07", "f", 170}, {"08", "m", 180},
                             {"09", "f", 155}, {"10", "f", 160}, {"11", "m", 175}};
/// A class of the HFUT-MMD paper, with our number of actions.
struct ClassShare {
  std::string_view id, name;
  int actions;  // our numbers: Baduanjin has eight pieces, Wuqinxi five animals
};
/// From table 7 of the HFUT-MMD paper.
constexpr ClassShare classes[] = {{"S1", "radio calisthenics", 8},
                                  {"S2", "Baduanjin", 8},
                                  {"S3", "sports", 5},
                                  {"S4", "Wuqinxi", 5},
                                  {"S5", "daily activities", 6},
                                  {"S6", "dance", 2}};

/// The people, classes and actions of the HFUT-MMD paper as TOML. The paper does not name actions.
std::string hfut_template() {
  std::string text;
  for (const Person& person : people) {
    text += "\n[subject." + std::string(person.id) + "]\nsex = \"" + std::string(person.sex) +
            "\"\nheight_cm = " + std::to_string(person.height_cm) + "\n";
  }
  for (const ClassShare& one : classes) {
    text += "\n[class." + std::string(one.id) + "]\nname = \"" + std::string(one.name) + "\"\n";
    for (int k = 1; k <= one.actions; ++k) {
      text += "\n[action." + std::string(one.id) + "A" + two_digits(k) + "]\nclass = \"" +
              std::string(one.id) + "\"\nname = \"\"\n";
    }
  }
  return text;
}

}  // namespace

Fields describe(Catalogue& c) {
  return {{"name", "name of the data set", &c.name},
          {"licence", "terms under which others may use it", &c.licence},
          {"contact", "whom to ask", &c.contact},
          {"description", "what the data set is for", &c.description},
          {"citation", "how to cite the data set", &c.citation}};
}

Fields describe(Subject& s) {
  return {
      {"sex", "f, m or x", &s.sex, 0.0, 0.0, {"", "f", "m", "x"}},
      {"handedness", "right, left or both", &s.handedness, 0.0, 0.0, {"", "right", "left", "both"}},
      {"consent", "what the person agreed to", &s.consent},
      {"height_cm", "body height", &s.height_cm, 20.0, most_cm},
      {"weight_kg", "body weight", &s.weight_kg, 1.0, most_kg},
      {"segments_m", "lengths of the body's segments", &s.segments_m, least_m, most_m}};
}

Fields describe(ActionClass& c) { return {{"name", "what the class is called", &c.name}}; }
Fields describe(Action& a) {
  return {{"class", "the class that it belongs to", &a.class_id},
          {"name", "what the action is called", &a.name}};
}

const Subject* find_subject(const Catalogue& catalogue, std::string_view id) {
  return find_id(catalogue.subjects, id);
}

const Action* find_action(const Catalogue& catalogue, std::string_view id) {
  return find_id(catalogue.actions, id);
}

Result<Catalogue> read_catalogue(std::string_view toml, std::string_view name) {
  Catalogue out;
  // For each table, a function reads its entries into one list.
  const auto each = [](auto& all) {
    return [&all](const Value& tables) { return read_each(tables, all); };
  };
  KA_TRY(read_toml(toml, name, [&](const Value& top) -> Result<void> {
    KA_TRY(read_options(
        top, describe(out),
        {{"align", [&](const Value& v) { return read_options(v, describe(out.align)); }},
         {"subject", each(out.subjects)},
         {"class", each(out.classes)},
         {"action", each(out.actions)},
         {"device", each(out.devices)},
         {"rig", each(out.rigs)}}));
    // The lines of the file are known only while it is being read.
    return check_classes(top, out);
  }));
  return out;
}

std::string catalogue_toml(const Catalogue& catalogue) {
  std::string text = toml_options(catalogue);
  // Options with default values are not written.
  const std::string align = toml_options(catalogue.align);
  if (!align.empty()) text += "\n[align]\n" + align;
  const auto put = [&](const std::string& kind, const auto& all) {
    for (const auto& one : all) text += toml_head(kind, one.id) + toml_options(one);
  };
  // The lab may choose any keys for devices and rigs.
  const auto put_texts = [&](const std::string& kind, const std::vector<Described>& all) {
    for (const Described& one : all) {
      text += toml_head(kind, one.id);
      for (const auto& [key, value] : one.texts) {
        text += toml_key(key) + " = " + toml_string(value) + "\n";
      }
    }
  };
  put("subject", catalogue.subjects);
  put("class", catalogue.classes);
  put("action", catalogue.actions);
  put_texts("device", catalogue.devices);
  put_texts("rig", catalogue.rigs);
  return text;
}

std::vector<std::string> catalogue_template_names() { return {"empty", "hfut-mmd"}; }

Result<std::string> catalogue_template(std::string_view template_name, const std::string& name) {
  if (template_name != "empty" && template_name != "hfut-mmd") {
    return Failure(unknown_name(template_name, "a template", catalogue_template_names()));
  }
  // Both templates begin with the same lines.
  const std::string head = catalogue_head(name, "", "");
  return head + (template_name == "empty" ? std::string(empty_template) : hfut_template());
}

std::string catalogue_head(const std::string& name, const std::string& licence,
                           const std::string& citation) {
  return fmt::format(head_of_template, toml_string(name), toml_string(licence),
                     toml_string(citation));
}

}  // namespace kinalign
