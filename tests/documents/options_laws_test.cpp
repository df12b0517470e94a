// SPDX-License-Identifier: Apache-2.0
// Every option in TOML and in JSON: both accept the same values, and refuse the others in the same
// words.
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/documents/parameters_json.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

using namespace kinalign;

namespace {

/// An option in its table, [align], [stream.s] or [space.s], with a value as TOML and JSON write
/// it.
struct Said {
  std::string table, option, value;
};

/// "" if the value is accepted, else "expected ..., found ...".
template <class Parsed>
std::string fault_of(const Parsed& parsed) {
  if (parsed) return "";
  return "expected " + parsed.error().expected + ", found " + parsed.error().found;
}

std::string by_toml(const Said& said) {
  const std::string file = said.table == "stream.s" ? "" : "[stream.s]\nfile = \"f\"\n";
  const std::string own = said.table == "stream.s" ? "file = \"f\"\n" : "";
  return fault_of(read_manifest(
      file + "[" + said.table + "]\n" + own + said.option + " = " + said.value + "\n", "r.toml"));
}

std::string by_json(const Said& said) {
  const std::string object = "{\"" + said.option + "\": " + said.value + "}";
  const std::string inner = said.table == "align"      ? "\"align\": " + object
                            : said.table == "stream.s" ? "\"streams\": [" + object + "]"
                                                       : "\"spaces\": {\"s\": " + object + "}";
  std::string fault =
      fault_of(parse_parameters_json("{\"schema\": \"kinalign.parameters/1\", " + inner + "}"));
  for (const std::string path : {"align.", "streams[0].", "spaces.s."}) {
    if (fault.starts_with("expected " + path)) fault.erase(9, path.size());
  }
  return fault;
}

/// The message that both readers give; it must be the same, but for the path that JSON has in place
/// of a line.
std::string both(const Said& said) {
  const std::string toml = by_toml(said);
  CHECK(by_json(said) == toml);
  return toml;
}

struct Table {
  std::string name;
  Fields fields;
};

bool is_table(const Field& field) {
  return std::visit(
      [](auto* value) {
        using Type = std::remove_pointer_t<decltype(value)>;
        return std::is_same_v<Type, std::vector<double>> ||
               std::is_same_v<Type, std::map<std::string, std::string>> ||
               std::is_same_v<Type, std::map<std::string, std::vector<double>>>;
      },
      field.value);
}

/// All described options except tables and lists of numbers, and except those that name a stream,
/// because the stream would have to exist.
class AllOptions {
 public:
  std::vector<Table> tables() {
    std::vector<Table> out{{"align", describe(align_)},
                           {"stream.s", describe(stream_)},
                           {"space.s", describe(space_)}};
    for (Table& table : out) {
      std::erase_if(table.fields, [](const Field& field) {
        return field.name == "reference" || field.name == "onto" || field.name == "layout" ||
               is_table(field);
      });
    }
    return out;
  }

 private:
  AlignOptions align_;
  StreamOptions stream_;
  SpaceOptions space_;
};

bool is_whole(const Field& field) {
  return std::holds_alternative<std::int64_t*>(field.value) ||
         std::holds_alternative<std::optional<std::int64_t>*>(field.value);
}
bool is_number(const Field& field) {
  return is_whole(field) || std::holds_alternative<double*>(field.value) ||
         std::holds_alternative<std::optional<double>*>(field.value);
}

std::string number(const Field& field, double value) {
  return is_whole(field) ? fmt::format("{}", static_cast<std::int64_t>(value))
                         : fmt::format("{:.17e}", value);
}

}  // namespace

TEST_CASE("a number is taken from its least to its most, and refused just beyond") {
  constexpr double more = std::numeric_limits<double>::infinity();
  AllOptions all;
  for (const Table& table : all.tables()) {
    for (const Field& field : table.fields) {
      if (!is_number(field)) continue;
      CAPTURE(field.name);
      const auto said = [&](double value) {
        return both({table.name, field.name, number(field, value)});
      };
      CHECK(said(field.least) == "");
      CHECK(said(field.most) == "");
      const std::string expected =
          fmt::format("expected {} as a {}number from {} to {}, found ", field.name,
                      is_whole(field) ? "whole " : "", field.least, field.most);
      CHECK(said(std::nextafter(field.least, -more)).starts_with(expected));
      CHECK(said(std::nextafter(field.most, more)).starts_with(expected));
      CHECK(both({table.name, field.name, "\"3\""}) == expected + "\"3\"");
      CHECK(both({table.name, field.name, "true"}) == expected + "true");
      CHECK(both({table.name, field.name, "[\"3\"]"}) == expected + "a list");
      if (is_whole(field)) CHECK(both({table.name, field.name, "0.5"}) == expected + "0.5");
    }
  }
}

TEST_CASE("a choice is one of its words, and the words are named where it is none") {
  AllOptions all;
  for (const Table& table : all.tables()) {
    for (const Field& field : table.fields) {
      if (field.choices.empty()) continue;
      CAPTURE(field.name);
      std::string words;
      for (const std::string& choice : field.choices) {
        words += (words.empty() ? "" : ", ") + (choice.empty() ? "\"\"" : choice);
        CHECK(both({table.name, field.name, "\"" + choice + "\""}) == "");
      }
      const std::string expected = "expected " + field.name + " as one of " + words + ", found ";
      CHECK(both({table.name, field.name, "\"Spline\""}) == expected + "\"Spline\"");
      CHECK(both({table.name, field.name, "1"}) == expected + "1");
      CHECK(both({table.name, field.name, "false"}) == expected + "false");
    }
  }
}

TEST_CASE("a text is a text, and yes is true or false") {
  AllOptions all;
  for (const Table& table : all.tables()) {
    for (const Field& field : table.fields) {
      CAPTURE(field.name);
      if (std::holds_alternative<bool*>(field.value)) {
        CHECK(both({table.name, field.name, "true"}) == "");
        CHECK(both({table.name, field.name, "\"yes\""}) ==
              "expected " + field.name + " as true or false, found \"yes\"");
        CHECK(both({table.name, field.name, "0"}) ==
              "expected " + field.name + " as true or false, found 0");
      } else if (!is_number(field) && field.choices.empty()) {
        CHECK(both({table.name, field.name, "\"Hips\""}) == "");
        CHECK(both({table.name, field.name, "2.5"}) ==
              "expected " + field.name + " as a text, found 2.5");
      }
    }
  }
}

TEST_CASE("each key of a manifest has a row in its page, with its choices") {
  std::ifstream file(std::string(KINALIGN_SOURCE_DIR) + "/docs/formats/recording_toml.md");
  std::vector<std::string> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| `")) rows.push_back(line);
  }
  Manifest manifest;
  StreamOptions stream;
  SpaceOptions space;
  for (const Fields& fields :
       {describe(manifest), describe(manifest.align), describe(stream), describe(space)}) {
    for (const Field& field : fields) {
      CAPTURE(field.name);
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const std::string& one) {
        return one.substr(0, one.find('|', 1)).find("`" + field.name + "`") != std::string::npos;
      });
      REQUIRE(row != rows.end());
      for (const std::string& choice : field.choices) {
        if (!choice.empty()) CHECK(row->find("`" + choice + "`") != std::string::npos);
      }
    }
  }
}

TEST_CASE("what TOML says of every option comes back from the parameters that a take remembers") {
  AllOptions all;
  for (const Table& table : all.tables()) {
    for (const Field& field : table.fields) {
      if (!is_number(field)) continue;
      CAPTURE(field.name);
      const double value = field.least + (field.most - field.least) / 3.0;
      const std::string own = table.name == "stream.s" ? "file = \"f\"\n" : "";
      const std::string file = own.empty() ? "[stream.s]\nfile = \"f\"\n" : "";
      const auto manifest = read_manifest(
          file + "[" + table.name + "]\n" + own + field.name + " = " + number(field, value) + "\n",
          "r.toml");
      REQUIRE(manifest);
      const std::string json = parameters_json(*manifest);
      const auto back = parse_parameters_json(json);
      REQUIRE(back);
      CHECK(parameters_json(*back) == json);
      CHECK(parameters_json(*back) !=
            parameters_json(*read_manifest("[stream.s]\nfile = \"f\"\n", "r.toml")));
    }
  }
}
