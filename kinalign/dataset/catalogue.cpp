// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/catalogue.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/documents/option_values.h"
#include "kinalign/documents/toml_entries.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

namespace kinalign {

namespace {

constexpr double most_cm = 300.0, most_kg = 500.0, most_m = 3.0;

class CatalogueReader {
 public:
  explicit CatalogueReader(std::string_view name) : file_(name) {}

  Result<Catalogue> read(const toml::table& top) const {
    Catalogue out;
    const Fields texts = describe(out);
    for (const TomlEntry& entry : in_file_order(top)) {
      const auto table = tables().find(entry.key);
      if (entry.key == "align") {
        KA_TRY(read_align(entry, out.align));
      } else if (table != tables().end()) {
        for (const TomlEntry& one : in_file_order(KA_TRY(file_.table(entry)))) {
          KA_TRY((this->*table->second)(one, out));
        }
      } else if (find_field(texts, entry.key) != nullptr) {
        KA_TRY(file_.option(entry, texts, "", {}));
      } else {
        return file_.unknown(entry, "a key of dataset.toml",
                             {"name", "licence", "contact", "description", "citation", "align",
                              "subject", "class", "action", "device", "rig"});
      }
    }
    KA_TRY(check_classes(top, out));
    return out;
  }

 private:
  /// Reads one of the tables [subject.ID], [class.ID], ...
  using ReadOne = Result<void> (CatalogueReader::*)(const TomlEntry& one, Catalogue& out) const;
  static const std::map<std::string, ReadOne, std::less<>>& tables() {
    static const std::map<std::string, ReadOne, std::less<>> all{
        {"subject", &CatalogueReader::read_subject},
        {"class", &CatalogueReader::read_class},
        {"action", &CatalogueReader::read_action},
        {"device", &CatalogueReader::read_device},
        {"rig", &CatalogueReader::read_rig}};
    return all;
  }

  Result<void> read_device(const TomlEntry& device, Catalogue& out) const {
    return read_texts(device, out.devices);
  }
  Result<void> read_rig(const TomlEntry& rig, Catalogue& out) const {
    return read_texts(rig, out.rigs);
  }

  Result<void> check_id(const TomlEntry& entry) const {
    if (is_label(entry.key)) return {};
    return file_.at(*entry.value,
                    Error{"", 0, "an id of letters and digits, for file names", shown(entry.key)});
  }

  Result<void> read_align(const TomlEntry& align, AlignOptions& out) const {
    const Fields fields = describe(out);
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(align)))) {
      KA_TRY(file_.option(entry, fields, "align", {}));
    }
    return {};
  }

  Result<void> read_subject(const TomlEntry& subject, Catalogue& out) const {
    KA_TRY(check_id(subject));
    Subject& made = out.subjects.emplace_back();
    made.id = subject.key;
    const Fields fields = describe(made);
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(subject)))) {
      if (entry.key == "segments_m") {
        KA_TRY(read_segments(entry, made.segments_m));
      } else {
        KA_TRY(file_.option(entry, fields, "subject." + subject.key, {"segments_m"}));
      }
    }
    return {};
  }

  Result<void> read_segments(const TomlEntry& segments, std::map<std::string, double>& out) const {
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(segments)))) {
      const auto length = entry.value->value<double>();
      if (!length || !(*length > 0.0 && *length < most_m)) {
        return file_.wrong(entry, "a segment's length in metres");
      }
      out[entry.key] = *length;
    }
    return {};
  }

  Result<void> read_class(const TomlEntry& one, Catalogue& out) const {
    KA_TRY(check_id(one));
    ActionClass& made = out.classes.emplace_back();
    made.id = one.key;
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(one)))) {
      if (entry.key != "name") return file_.unknown(entry, "a key of [class.ID]", {"name"});
      made.name = KA_TRY(file_.text(entry));
    }
    return {};
  }

  Result<void> read_action(const TomlEntry& one, Catalogue& out) const {
    KA_TRY(check_id(one));
    Action& made = out.actions.emplace_back();
    made.id = one.key;
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(one)))) {
      if (entry.key == "name") {
        made.name = KA_TRY(file_.text(entry));
      } else if (entry.key == "class") {
        made.class_id = KA_TRY(file_.text(entry));
      } else {
        return file_.unknown(entry, "a key of [action.ID]", {"class", "name"});
      }
    }
    return {};
  }

  Result<void> read_texts(const TomlEntry& one, std::vector<Described>& out) const {
    out.push_back({one.key, KA_TRY(file_.texts(one))});
    return {};
  }

  /// Classes are checked at the end, since they may be defined after the actions that name them.
  Result<void> check_classes(const toml::table& top, const Catalogue& catalogue) const {
    std::vector<std::string> known;
    for (const ActionClass& one : catalogue.classes) known.push_back(one.id);
    for (const Action& action : catalogue.actions) {
      if (std::find(known.begin(), known.end(), action.class_id) != known.end()) continue;
      return file_.at(*top["action"][action.id].node(),
                      action.class_id.empty()
                          ? Error{"", 0, "class in [action." + action.id + "]", "none"}
                          : unknown_name(action.class_id, "a class of this file", known));
    }
    return {};
  }

  TomlFile file_;
};

std::string two_digits(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

constexpr std::string_view head_of_template =
    R"(# A data set of kinalign: docs/formats/dataset.md lists every key.
name = {0}
licence = {1}       # on what terms others may use it: "CC BY 4.0"
contact = ""       # whom they may ask
description = ""
citation = {2}

# [align]          what the manifests of takes leave open, as in a recording.toml

# People by a pseudonym. Who they are stands nowhere in this folder.
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

struct Person {
  std::string_view id, sex;
  int height_cm;
};
/// From table 6 of the paper.
constexpr Person people[] = {{"00", "m", 175}, {"01", "m", 180}, {"02", "m", 180},
                             {"03", "m", 175}, {"04", "m", 170}, {"05", "f", 165},
                             {"06", "m", 175}, {"07", "f", 170}, {"08", "m", 180},
                             {"09", "f", 155}, {"10", "f", 160}, {"11", "m", 175}};
struct ClassShare {
  std::string_view id, name;
  int actions;  // ours: Baduanjin has eight pieces, Wuqinxi five animals
};
/// From table 7 of the paper.
constexpr ClassShare classes[] = {{"S1", "radio calisthenics", 8},
                                  {"S2", "Baduanjin", 8},
                                  {"S3", "sports", 5},
                                  {"S4", "Wuqinxi", 5},
                                  {"S5", "daily activities", 6},
                                  {"S6", "dance", 2}};

/// The paper's people, classes and actions as TOML. The actions have no names in the paper.
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

template <class One>
const One* find_id(const std::vector<One>& all, std::string_view id) {
  const auto found =
      std::find_if(all.begin(), all.end(), [id](const One& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

Fields describe(Catalogue& c) {
  return {{"name", "what the data set is called", &c.name},
          {"licence", "on what terms others may use it", &c.licence},
          {"contact", "whom they may ask", &c.contact},
          {"description", "what it is for", &c.description},
          {"citation", "how it is cited", &c.citation}};
}

Fields describe(Subject& s) {
  return {
      {"sex", "f, m or x", &s.sex, 0.0, 0.0, {"", "f", "m", "x"}},
      {"handedness", "right, left or both", &s.handedness, 0.0, 0.0, {"", "right", "left", "both"}},
      {"consent", "to what the person agreed", &s.consent},
      {"height_cm", "body height", &s.height_cm, 20.0, most_cm},
      {"weight_kg", "body weight", &s.weight_kg, 1.0, most_kg}};
}

const Subject* find_subject(const Catalogue& catalogue, std::string_view id) {
  return find_id(catalogue.subjects, id);
}

const Action* find_action(const Catalogue& catalogue, std::string_view id) {
  return find_id(catalogue.actions, id);
}

Result<Catalogue> read_catalogue(std::string_view toml, std::string_view name) {
  Catalogue catalogue;
  KA_TRY(TomlFile(name).parse(toml, [&](const toml::table& top) -> Result<void> {
    catalogue = KA_TRY(CatalogueReader(name).read(top));
    return {};
  }));
  return catalogue;
}

std::vector<std::string> catalogue_template_names() { return {"empty", "hfut-mmd"}; }

Result<std::string> catalogue_template(std::string_view template_name, const std::string& name) {
  if (template_name != "empty" && template_name != "hfut-mmd") {
    return Failure(unknown_name(template_name, "a template", catalogue_template_names()));
  }
  const std::string head = catalogue_head(name, "", "");
  return head + (template_name == "empty" ? std::string(empty_template) : hfut_template());
}

std::string catalogue_head(const std::string& name, const std::string& licence,
                           const std::string& citation) {
  return fmt::format(head_of_template, toml_string(name), toml_string(licence),
                     toml_string(citation));
}

}  // namespace kinalign
