// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/manifest_toml.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/io/option_values.h"

#include <toml++/toml.h>

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

using Texts = std::map<std::string, std::string>;

/// A key and its value.
struct Entry {
  std::string key;
  const toml::node* value;
};

/// In the order of the file; toml++ sorts by key.
std::vector<Entry> in_file_order(const toml::table& table) {
  std::vector<Entry> out;
  for (const auto& [key, value] : table) out.push_back({std::string(key.str()), &value});
  std::stable_sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) {
    const auto& at = a.value->source().begin;
    const auto& bt = b.value->source().begin;
    return at.line != bt.line ? at.line < bt.line : at.column < bt.column;
  });
  return out;
}

std::string type_of(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  if (node.is_string()) return "a text";
  if (node.is_number()) return "a number";
  if (node.is_boolean()) return "true or false";
  return "a date or time";
}

class ManifestReader {
 public:
  explicit ManifestReader(std::string_view name) : name_(name) {}

  Result<Manifest> read(const toml::table& top, const AlignOptions& unsaid) {
    Manifest out;
    out.align = unsaid;
    for (const Entry& entry : in_file_order(top)) {
      if (entry.key == "subject") {
        out.subject = KA_TRY(text(entry));
      } else if (entry.key == "action") {
        out.action = KA_TRY(text(entry));
      } else if (entry.key == "align") {
        KA_TRY(read_align(entry, out.align));
      } else if (entry.key == "stream") {
        KA_TRY(read_streams(entry, out));
      } else if (entry.key == "space") {
        KA_TRY(read_spaces(entry, out));
      } else {
        return unknown(entry, "a known key", {"subject", "action", "align", "stream", "space"});
      }
    }
    KA_TRY(check_names(top, out));
    return out;
  }

 private:
  static std::int64_t line(const toml::node& node) {
    return static_cast<std::int64_t>(node.source().begin.line);
  }
  Failure at(const toml::node& node, Error error) const {
    error.file = name_;
    error.line = line(node);
    return Failure(std::move(error));
  }
  Failure wrong(const Entry& entry, const std::string& wanted) const {
    return at(*entry.value, Error{"", 0, entry.key + " as " + wanted, type_of(*entry.value)});
  }
  Failure unknown(const Entry& entry, const std::string& what,
                  const std::vector<std::string>& known) const {
    return at(*entry.value, unknown_name(entry.key, what, known));
  }

  Result<std::string> text(const Entry& entry) const {
    const auto* value = entry.value->as_string();
    if (value == nullptr) return wrong(entry, "a text");
    return value->get();
  }

  Result<std::reference_wrapper<const toml::table>> table(const Entry& entry) const {
    const auto* value = entry.value->as_table();
    if (value == nullptr) return wrong(entry, "a table");
    return std::cref(*value);
  }

  /// Pairs of texts: { SpineBase = "Hips" }.
  Result<Texts> texts(const Entry& entry) const {
    Texts out;
    for (const Entry& one : in_file_order(KA_TRY(table(entry)))) out[one.key] = KA_TRY(text(one));
    return out;
  }

  /// Column = value, a text or a whole number.
  Result<Texts> selection(const Entry& entry) const {
    Texts out;
    for (const Entry& one : in_file_order(KA_TRY(table(entry)))) {
      const auto* whole = one.value->as_integer();
      out[one.key] = whole != nullptr ? std::to_string(whole->get()) : KA_TRY(text(one));
    }
    return out;
  }

  Result<std::vector<double>> numbers(const Entry& entry, std::size_t count) const {
    const std::string wanted = "a list of " + std::to_string(count) + " numbers";
    const auto* array = entry.value->as_array();
    if (array == nullptr) return wrong(entry, wanted);
    std::vector<double> out;
    for (const toml::node& one : *array) {
      const auto number = one.value<double>();
      if (!one.is_number() || !number || !(*number >= -1e9 && *number <= 1e9)) {
        return at(one, Error{"", 0, entry.key + " as " + wanted, type_of(one)});
      }
      out.push_back(*number);
    }
    if (out.size() == count) return out;
    return at(*entry.value,
              Error{"", 0, entry.key + " as " + wanted, std::to_string(out.size()) + " numbers"});
  }

  Result<std::vector<double>> rotation(const Entry& entry) const {
    auto out = KA_TRY(numbers(entry, 4));
    auto checked = check_rotation(entry.key, out);
    if (!checked) return at(*entry.value, std::move(checked).error());
    return out;
  }

  /// Of nodes: { waist = [1, 0, 0, 0] }.
  Result<std::map<std::string, std::vector<double>>> rotations(const Entry& entry) const {
    std::map<std::string, std::vector<double>> out;
    for (const Entry& node : in_file_order(KA_TRY(table(entry)))) {
      out[node.key] = KA_TRY(rotation(node));
    }
    return out;
  }

  static std::optional<OptionValue> option_value(const toml::node& node) {
    if (const auto* truth = node.as_boolean()) return truth->get();
    if (const auto* whole = node.as_integer()) return whole->get();
    if (const auto* number = node.as_floating_point()) return number->get();
    if (const auto* text = node.as_string()) return text->get();
    const auto* array = node.as_array();
    if (array == nullptr) return std::nullopt;
    std::vector<std::string> out;
    for (const toml::node& one : *array) {
      const auto* text = one.as_string();
      if (text == nullptr) return std::nullopt;
      out.push_back(text->get());
    }
    return out;
  }

  /// A described option; `beside` are the keys of that table that are none.
  Result<void> read_option(const Entry& entry, const Fields& fields, const std::string& table_name,
                           std::vector<std::string> beside) const {
    const Field* field = find_field(fields, entry.key);
    if (field == nullptr) {
      for (const Field& known : fields) beside.push_back(known.name);
      return unknown(entry, "a key of [" + table_name + "]", beside);
    }
    const auto value = option_value(*entry.value);
    if (!value) return wrong(entry, "a single value");
    auto done = assign(*field, *value);
    return done ? Result<void>() : at(*entry.value, std::move(done).error());
  }

  Result<void> read_align(const Entry& align, AlignOptions& out) const {
    const Fields fields = describe(out);
    for (const Entry& entry : in_file_order(KA_TRY(table(align)))) {
      KA_TRY(read_option(entry, fields, "align", {}));
    }
    return {};
  }

  /// files = { waist = "w.csv" } or files = ["a.csv", "b.csv"].
  Result<void> read_files(const Entry& entry, std::vector<StreamFile>& out) const {
    if (const auto* list = entry.value->as_array()) {
      for (const toml::node& one : *list) {
        out.push_back({KA_TRY(text(Entry{entry.key, &one})), ""});
      }
      return {};
    }
    if (!entry.value->is_table()) return wrong(entry, "a list of files or a table of nodes' files");
    for (const Entry& one : in_file_order(KA_TRY(table(entry)))) {
      out.push_back({KA_TRY(text(one)), one.key});
    }
    return {};
  }

  Result<void> read_stream(const Entry& stream, Manifest& manifest) const {
    StreamOptions& out = manifest.streams.emplace_back();
    out.name = stream.key;
    const Fields fields = describe(out);
    for (const Entry& entry : in_file_order(KA_TRY(table(stream)))) {
      out.lines[entry.key] = line(*entry.value);
      if (entry.key == "file") {
        out.files.push_back({KA_TRY(text(entry)), ""});
      } else if (entry.key == "files") {
        KA_TRY(read_files(entry, out.files));
      } else if (entry.key == "select") {
        out.select = KA_TRY(selection(entry));
      } else if (entry.key == "mounting") {
        out.mounting = KA_TRY(rotations(entry));
      } else {
        KA_TRY(read_option(entry, fields, "stream." + stream.key,
                           {"file", "files", "select", "mounting"}));
      }
    }
    if (!out.files.empty()) return {};
    return at(*stream.value, Error{"", 0, "file or files in [stream." + stream.key + "]", "none"});
  }

  Result<void> read_streams(const Entry& streams, Manifest& out) const {
    for (const Entry& stream : in_file_order(KA_TRY(table(streams))))
      KA_TRY(read_stream(stream, out));
    return {};
  }

  Result<void> read_space(const Entry& space, SpaceOptions& out) const {
    const Fields fields = describe(out);
    for (const Entry& entry : in_file_order(KA_TRY(table(space)))) {
      out.lines[entry.key] = line(*entry.value);
      if (entry.key == "rotation") {
        out.rotation = KA_TRY(rotation(entry));
      } else if (entry.key == "translation") {
        out.translation = KA_TRY(numbers(entry, 3));
      } else if (entry.key == "joints") {
        out.joints = KA_TRY(texts(entry));
      } else {
        KA_TRY(read_option(entry, fields, "space." + space.key,
                           {"rotation", "translation", "joints"}));
      }
    }
    return {};
  }

  Result<void> read_spaces(const Entry& spaces, Manifest& out) const {
    for (const Entry& space : in_file_order(KA_TRY(table(spaces)))) {
      KA_TRY(read_space(space, out.spaces[space.key]));
    }
    return {};
  }

  /// Streams that are spoken of are there.
  Result<void> check_names(const toml::table& top, const Manifest& manifest) const {
    std::vector<std::string> known;
    for (const StreamOptions& stream : manifest.streams) known.push_back(stream.name);
    const auto check = [&](const std::string& stream, const toml::node* where) -> Result<void> {
      if (stream.empty() || where == nullptr) return {};  // not of this file
      if (std::find(known.begin(), known.end(), stream) != known.end()) return {};
      return at(*where, unknown_name(stream, "a stream of this file", known));
    };
    KA_TRY(check(manifest.align.reference, top["align"]["reference"].node()));
    for (const auto& [name, space] : manifest.spaces) {
      KA_TRY(check(name, top["space"][name].node()));
      KA_TRY(check(space.onto, top["space"][name]["onto"].node()));
    }
    return {};
  }

  std::string name_;
};

}  // namespace

Result<Manifest> read_manifest(std::string_view toml, std::string_view name,
                               const AlignOptions& unsaid) {
  try {
    return ManifestReader(name).read(toml::parse(toml, name), unsaid);
  } catch (const toml::parse_error& error) {
    const auto line = static_cast<std::int64_t>(error.source().begin.line);
    return Failure(Error{std::string(name), line, "TOML",
                         "a fault in it: " + std::string(error.description())});
  }
}

}  // namespace kinalign
