// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/release.h"

#include "kinalign/core/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <span>

namespace kinalign {

namespace {

/// A regular expression, and a description of the text that it finds.
struct Pattern {
  const char* what;
  std::regex text;
};

constexpr std::size_t address_patterns = 2;  // number of patterns for addresses; they come first

/// Patterns of texts that could identify a person. Addresses come first (address_patterns).
const std::array<Pattern, 4>& patterns() {
  static const std::array<Pattern, 4> all{{
      {"an e-mail address", std::regex("[^\\s@]+@[^\\s@]+\\.[a-zA-Z]{2,}")},
      {"a hardware address", std::regex("([0-9A-Fa-f]{2}[:-]){5}[0-9A-Fa-f]{2}")},
      {"a date", std::regex("(19|20)\\d\\d[-/.]?(0[1-9]|1[0-2])[-/.]?(0[1-9]|[12]\\d|3[01])|"
                            "\\b\\d{1,2}[./]\\d{1,2}[./](19|20)?\\d\\d\\b")},
      {"a telephone number", std::regex("\\+?\\d[\\d /()-]{7,}\\d")},
  }};
  return all;
}

/// True for an id with three letters or more and no digit: "maria", unlike "s03" and "07".
bool reads_like_a_name(const std::string& id) {
  const auto is = [](int (*kind)(int)) {
    return [kind](char c) { return kind(static_cast<unsigned char>(c)) != 0; };
  };
  return std::count_if(id.begin(), id.end(), is(std::isalpha)) >= 3 &&
         std::none_of(id.begin(), id.end(), is(std::isdigit));
}

/// True for a key whose value identifies one device or its owner. Most words are searched anywhere
/// in the key, in lower case. "sn" and "ip" must be the whole key, because they occur in other
/// words.
bool names_a_device(std::string key) {
  std::transform(key.begin(), key.end(), key.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 6> words{"serial",  "mac",   "imei",
                                                  "address", "owner", "host"};
  if (key == "sn" || key == "ip") return true;
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return key.find(word) != std::string::npos; });
}

/// Collects findings about texts. `where` names the place in dataset.toml. The message quotes the
/// found text, so that the user can find it.
class Look {
 public:
  explicit Look(const std::string& file) : file_(file) {}

  void add(Severity severity, const std::string& where, std::string found, std::string repair) {
    findings.push_back(
        {severity,
         Error{file_, 0, fmt::format("{} that can't identify a person", where), std::move(found)},
         "", std::move(repair)});
  }

  // Checks a text in which no date or number is expected.
  void text(const std::string& where, const std::string& value) {
    find_first_of(where, value, patterns());
  }

  /// Checks a text that may contain dates and long numbers, such as years, pages or an ISBN.
  void published_text(const std::string& where, const std::string& value) {
    find_first_of(where, value, std::span(patterns()).first(address_patterns));
  }

  /// Checks the id of an action, a class, a device or a rig. For example, "kinect" and "walk" are
  /// accepted, while "Maria" may be a name.
  void id(const char* table, const std::string& value) {
    text(fmt::format("the id of a {}", table), value);
    const auto letter = [&](std::size_t i) { return static_cast<unsigned char>(value[i]); };
    // A capital followed by a small letter looks like a proper name.
    const bool is_proper = value.size() > 1 && std::isupper(letter(0)) && std::islower(letter(1));
    if (!is_proper || !reads_like_a_name(value)) return;
    add(Severity::warning, fmt::format("the id of a {}", table),
        fmt::format("\"{}\"", shown(value)), "give another id, if this is a person's name");
  }

  Findings findings;

 private:
  // A text gets one finding at most, because the user must read the whole text anyway.
  void find_first_of(const std::string& where, const std::string& value,
                     std::span<const Pattern> kinds) {
    for (const Pattern& pattern : kinds) {
      std::smatch match;
      // The patterns are tried in order, so an address is found before a number in it.
      if (!std::regex_search(value, match, pattern.text)) continue;
      add(Severity::error, where, fmt::format("{}: \"{}\"", pattern.what, shown(match.str())),
          "remove it from dataset.toml");
      return;
    }
  }

  const std::string& file_;
};

/// Checks the devices. A serial number is an error, because it can be traced to a lab.
void look_at_devices(const std::vector<Described>& all, const char* table, Look& look) {
  for (const Described& one : all) {
    look.id(table, one.id);
    for (const auto& [key, value] : one.texts) {
      const std::string where = fmt::format("{}.{}.{}", table, one.id, key);
      if (names_a_device(key) && !value.empty()) {
        look.add(Severity::error, where, fmt::format("\"{}\"", shown(value)),
                 "remove it from dataset.toml: a serial number identifies a lab and a day");
      } else {
        look.text(where, value);
      }
    }
  }
}

/// A height or a weight that only one person has identifies that person.
void look_at_measures(const std::vector<Subject>& people, const char* what,
                      std::optional<double> Subject::*measure, Look& look) {
  for (const Subject& person : people) {
    // A measure that is not stated identifies no one.
    if (!(person.*measure)) continue;
    const auto same = std::count_if(people.begin(), people.end(), [&](const Subject& other) {
      return other.*measure == person.*measure;
    });
    // A value that two people share identifies neither of them.
    if (same > 1) continue;
    look.add(Severity::note, fmt::format("subject.{}.{}", person.id, what),
             fmt::format("{:g}, which no other person in this data set has", *(person.*measure)),
             "round this value, or leave it out");
  }
}

/// The new names of raw files, by their old names. The same old name always gets the same new name,
/// so that inputs, parameters and findings still agree. The ending is kept, because it states the
/// format.
class HiddenNames {
 public:
  const std::string& of(const std::string& name, const std::string& stream, std::size_t number) {
    const std::string_view file = file_name(name);
    const std::size_t dot = file.rfind('.');
    const std::string ending(dot == std::string_view::npos ? "" : file.substr(dot));
    std::string& to = names_[name];
    if (to.empty()) {
      to = number == 0 ? stream + ending : fmt::format("{}_{}{}", stream, number + 1, ending);
    }
    return to;
  }

  // Replaces file names that findings quote. At each position the longest name is tried first.
  // Otherwise a name "a.csv" would be replaced within "data/a.csv", and the folder would stay.
  void put_into(std::string& text) const {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
      const auto name = std::find_if(names_.begin(), names_.end(), [&](const auto& one) {
        return !one.first.empty() && text.compare(at, one.first.size(), one.first) == 0;
      });
      out += name == names_.end() ? text.substr(at, 1) : name->second;
      at += name == names_.end() ? 1 : name->first.size();
    }
    text = std::move(out);
  }

 private:
  struct LongerFirst {
    bool operator()(const std::string& a, const std::string& b) const {
      return a.size() != b.size() ? a.size() > b.size() : a < b;
    }
  };

  std::map<std::string, std::string, LongerFirst> names_;
};

}  // namespace

/// The search helps but proves nothing: it finds texts that look like a name, a date or an address.
/// The user must decide about warnings and notes.
Findings look_for_people(const Catalogue& catalogue, const std::string& file,
                         const std::set<std::string>& names) {
  Look look(file);
  // People come first, because their texts are the most likely to contain a name.
  for (const Subject& person : catalogue.subjects) {
    if (reads_like_a_name(person.id)) {
      look.add(Severity::error, "a subject's id", fmt::format("\"{}\"", shown(person.id)),
               "use a number as id: kinalign dataset rename");
    }
    look.text("a subject's id", person.id);
    look.text(fmt::format("subject.{}.consent", person.id), person.consent);
    if (!person.consent.empty()) {
      look.add(Severity::warning, fmt::format("subject.{}.consent", person.id),
               fmt::format("free text: \"{}\"", shown(person.consent)),
               "check this text before you publish it");
    }
  }
  look_at_measures(catalogue.subjects, "height_cm", &Subject::height_cm, look);
  look_at_measures(catalogue.subjects, "weight_kg", &Subject::weight_kg, look);
  look_at_devices(catalogue.devices, "device", look);
  look_at_devices(catalogue.rigs, "rig", look);
  for (const ActionClass& one : catalogue.classes) {
    look.id("class", one.id);
    look.text("class." + one.id + ".name", one.name);
  }
  for (const Action& one : catalogue.actions) {
    look.id("action", one.id);
    look.text("action." + one.id + ".name", one.name);
  }
  for (const std::string& name : names) look.text("a stream or node", name);
  look.text("name", catalogue.name);
  // Years, pages and numbers in licences and citations do not identify a person.
  look.published_text("licence", catalogue.licence);
  look.published_text("citation", catalogue.citation);
  look.text("description", catalogue.description);
  if (!catalogue.contact.empty()) {
    look.add(Severity::note, "contact", fmt::format("\"{}\"", shown(catalogue.contact)),
             "this text is published unchanged");
  }
  std::stable_sort(look.findings.begin(), look.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return look.findings;
}

/// Replaces file names in every place of a take that can have them: inputs, parameters and
/// findings.
void hide_names(TakeHeader& header, AlignmentReport& report) {
  HiddenNames names;
  for (TakeGroup& group : header.groups) {
    for (std::size_t i = 0; i < group.files.size(); ++i) {
      // All names are collected from the inputs first. They are then replaced in the texts below.
      group.files[i].name = names.of(group.files[i].name, group.name, i);
    }
  }
  for (StreamOptions& stream : header.parameters.streams) {
    for (std::size_t i = 0; i < stream.files.size(); ++i) {
      stream.files[i].path = names.of(stream.files[i].path, stream.name, i);
    }
    if (stream.own_layout()) stream.layout = names.of(stream.layout, stream.name + "_layout", 0);
    if (!stream.skeleton.empty()) {
      stream.skeleton = names.of(stream.skeleton, stream.name + "_skeleton", 0);
    }
    for (auto& [column, value] : stream.select) {
      // A number selects a row and identifies no one. Other texts might identify a person.
      if (value.find_first_not_of("0123456789") != std::string::npos) value.clear();
    }
  }
  // Marks are removed, because they are free text with times of day.
  report.marks.clear();
  for (Finding& finding : report.findings) {
    for (std::string* text : {&finding.what.file, &finding.what.expected, &finding.what.found,
                              &finding.meaning, &finding.repair}) {
      names.put_into(*text);
    }
  }
}

/// Moves the dates outside of the rows. ExportedTake moves the rows by the same time.
void move_dates(Duration moved, TakeHeader& header, AlignmentReport& report) {
  report.begin += moved;
  report.end += moved;
  for (StreamReport& stream : report.streams) {
    // The length of the stream is kept, because it is part of the quality.
    stream.survey.last = Time{stream.survey.last - stream.survey.first};
    stream.survey.first = Time{};
  }
  for (StreamOptions& stream : header.parameters.streams) {
    // The distance between clicks is kept, but their date is removed.
    const std::int64_t first = stream.start_ns.value_or(stream.end_ns.value_or(0));
    for (std::optional<std::int64_t>* stamp : {&stream.start_ns, &stream.end_ns}) {
      if (*stamp) **stamp -= first;
    }
  }
}

std::string released_catalogue(Catalogue catalogue, const std::set<std::string>& used) {
  std::erase_if(catalogue.subjects, [&](const Subject& one) { return !used.contains(one.id); });
  // Defaults for manifests are removed, because a released data set has no manifests.
  catalogue.align = {};
  return catalogue_toml(catalogue);
}

}  // namespace kinalign
