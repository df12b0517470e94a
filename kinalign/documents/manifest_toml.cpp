// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/manifest_toml.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/documents/option_values.h"
#include "kinalign/documents/toml_entries.h"

#include <toml++/toml.h>

#include <algorithm>

namespace kinalign {

namespace {

class ManifestReader {
 public:
  explicit ManifestReader(std::string_view name) : file_(name) {}

  Result<Manifest> read(const toml::table& top, const AlignOptions& unsaid) {
    Manifest out;
    out.align = unsaid;
    KA_TRY(check_purpose(top));
    for (const TomlEntry& entry : in_file_order(top)) {
      if (entry.key == "subject") {
        out.subject = KA_TRY(file_.text(entry));
      } else if (entry.key == "action") {
        out.action = KA_TRY(file_.text(entry));
      } else if (entry.key == "align") {
        KA_TRY(read_align(entry, out.align));
      } else if (entry.key == "stream") {
        KA_TRY(read_streams(entry, out));
      } else if (entry.key == "space") {
        KA_TRY(read_spaces(entry, out));
      } else {
        return file_.unknown(entry, "a known key",
                             {"subject", "action", "align", "stream", "space"});
      }
    }
    KA_TRY(check_names(top, out));
    return out;
  }

 private:
  /// Refuses a lab.toml, which is easily confused with a manifest: both name streams.
  Result<void> check_purpose(const toml::table& top) const {
    const toml::node* devices = top.get("device");
    if (devices == nullptr) return {};
    return file_.at(*devices, Error{"", 0, "a manifest, recording.toml, with [stream.NAME]",
                                    "[device], of a lab.toml: kinalign record takes it as "
                                    "--config"});
  }

  /// Reads column = value; a value is a text or a whole number.
  Result<Texts> selection(const TomlEntry& entry) const {
    Texts out;
    for (const TomlEntry& one : in_file_order(KA_TRY(file_.table(entry)))) {
      const auto* whole = one.value->as_integer();
      out[one.key] = whole != nullptr ? std::to_string(whole->get()) : KA_TRY(file_.text(one));
    }
    return out;
  }

  Result<std::vector<double>> numbers(const TomlEntry& entry, std::size_t count) const {
    const std::string wanted = "a list of " + std::to_string(count) + " numbers";
    const auto* array = entry.value->as_array();
    if (array == nullptr) return file_.wrong(entry, wanted);
    std::vector<double> out;
    for (const toml::node& one : *array) {
      const auto number = one.value<double>();
      if (!one.is_number() || !number || !(*number >= -1e9 && *number <= 1e9)) {
        return file_.at(one, Error{"", 0, entry.key + " as " + wanted, type_of(one)});
      }
      out.push_back(*number);
    }
    if (out.size() == count) return out;
    return file_.at(*entry.value, Error{"", 0, entry.key + " as " + wanted,
                                        std::to_string(out.size()) + " numbers"});
  }

  Result<std::vector<double>> rotation(const TomlEntry& entry) const {
    auto out = KA_TRY(numbers(entry, 4));
    auto checked = check_rotation(entry.key, out);
    if (!checked) return file_.at(*entry.value, std::move(checked).error());
    return out;
  }

  /// Reads rotations of nodes: { waist = [1, 0, 0, 0] }.
  Result<std::map<std::string, std::vector<double>>> rotations(const TomlEntry& entry) const {
    std::map<std::string, std::vector<double>> out;
    for (const TomlEntry& node : in_file_order(KA_TRY(file_.table(entry)))) {
      out[node.key] = KA_TRY(rotation(node));
    }
    return out;
  }

  Result<void> read_align(const TomlEntry& align, AlignOptions& out) const {
    const Fields fields = describe(out);
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(align)))) {
      KA_TRY(file_.option(entry, fields, "align", {}));
    }
    return {};
  }

  /// Reads files = { waist = "w.csv" } or files = ["a.csv", "b.csv"].
  Result<void> read_files(const TomlEntry& entry, std::vector<StreamFile>& out) const {
    if (const auto* list = entry.value->as_array()) {
      for (const toml::node& one : *list) {
        out.push_back({KA_TRY(file_.text(TomlEntry{entry.key, &one})), ""});
      }
      return {};
    }
    if (!entry.value->is_table())
      return file_.wrong(entry, "a list of files or a table of nodes' files");
    for (const TomlEntry& one : in_file_order(KA_TRY(file_.table(entry)))) {
      out.push_back({KA_TRY(file_.text(one)), one.key});
    }
    return {};
  }

  Result<void> read_stream(const TomlEntry& stream, Manifest& manifest) const {
    StreamOptions& out = manifest.streams.emplace_back();
    out.name = stream.key;
    const Fields fields = describe(out);
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(stream)))) {
      out.lines[entry.key] = line_of(*entry.value);
      if (entry.key == "file") {
        out.files.push_back({KA_TRY(file_.text(entry)), ""});
      } else if (entry.key == "files") {
        KA_TRY(read_files(entry, out.files));
      } else if (entry.key == "select") {
        out.select = KA_TRY(selection(entry));
      } else if (entry.key == "mounting") {
        out.mounting = KA_TRY(rotations(entry));
      } else {
        KA_TRY(file_.option(entry, fields, "stream." + stream.key,
                            {"file", "files", "select", "mounting"}));
      }
    }
    if (!out.files.empty()) return {};
    return file_.at(*stream.value,
                    Error{"", 0, "file or files in [stream." + stream.key + "]", "none"});
  }

  Result<void> read_streams(const TomlEntry& streams, Manifest& out) const {
    for (const TomlEntry& stream : in_file_order(KA_TRY(file_.table(streams))))
      KA_TRY(read_stream(stream, out));
    return {};
  }

  Result<void> read_space(const TomlEntry& space, SpaceOptions& out) const {
    const Fields fields = describe(out);
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(space)))) {
      out.lines[entry.key] = line_of(*entry.value);
      if (entry.key == "rotation") {
        out.rotation = KA_TRY(rotation(entry));
      } else if (entry.key == "translation") {
        out.translation = KA_TRY(numbers(entry, 3));
      } else if (entry.key == "joints") {
        out.joints = KA_TRY(file_.texts(entry));
      } else {
        KA_TRY(file_.option(entry, fields, "space." + space.key,
                            {"rotation", "translation", "joints"}));
      }
    }
    return {};
  }

  Result<void> read_spaces(const TomlEntry& spaces, Manifest& out) const {
    for (const TomlEntry& space : in_file_order(KA_TRY(file_.table(spaces)))) {
      KA_TRY(read_space(space, out.spaces[space.key]));
    }
    return {};
  }

  /// Fails if the file refers to a stream that does not exist.
  Result<void> check_names(const toml::table& top, const Manifest& manifest) const {
    std::vector<std::string> known;
    for (const StreamOptions& stream : manifest.streams) known.push_back(stream.name);
    const auto check = [&](const std::string& stream, const toml::node* where) -> Result<void> {
      if (stream.empty() || where == nullptr) return {};  // not stated in this file
      if (std::find(known.begin(), known.end(), stream) != known.end()) return {};
      return file_.at(*where, unknown_name(stream, "a stream of this file", known));
    };
    KA_TRY(check(manifest.align.reference, top["align"]["reference"].node()));
    for (const auto& [name, space] : manifest.spaces) {
      KA_TRY(check(name, top["space"][name].node()));
      KA_TRY(check(space.onto, top["space"][name]["onto"].node()));
    }
    return {};
  }

  TomlFile file_;
};

}  // namespace

Result<Manifest> read_manifest(std::string_view toml, std::string_view name,
                               const AlignOptions& unsaid) {
  Manifest manifest;
  KA_TRY(TomlFile(name).parse(toml, [&](const toml::table& top) -> Result<void> {
    manifest = KA_TRY(ManifestReader(name).read(top, unsaid));
    return {};
  }));
  return manifest;
}

}  // namespace kinalign
