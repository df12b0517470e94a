// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/formats.h"

#include "kinalign/io/bvh.h"
#include "kinalign/io/layout.h"
#include "kinalign/io/ntu_skeleton.h"
#include "kinalign/io/opensim_sto.h"
#include "kinalign/io/table_reader.h"
#include "kinalign/io/trc.h"
#include "kinalign/io/ui_prmd_kinect.h"
#include "kinalign/io/xsens_text.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

namespace kinalign {

namespace {

struct Source {
  FileSystem* files;
  StreamOptions options;
  StreamFile file;
};

/// A format that a program of ours reads.
struct Format {
  std::string_view name;
  bool (*looks)(std::string_view head);
  Result<AnyReader> (*make)(const Source& source);
};

/// The file of angles that belongs to a file of offsets: "Positions" is "Angles" in its path.
std::string angles_of(std::string path) {
  for (const auto& [from, to] : {std::pair{"positions", "angles"}, {"Positions", "Angles"}}) {
    for (auto at = path.find(from); at != std::string::npos; at = path.find(from)) {
      path.replace(at, std::string_view(from).size(), to);
    }
  }
  return path;
}

Result<AnyReader> make_ui_prmd(const Source& source) {
  const std::string angles = angles_of(source.file.path);
  auto file = std::make_shared<InputFile>(KA_TRY(InputFile::open(*source.files, angles)));
  return AnyReader(make_ui_prmd_kinect_reader(source.options, source.file.path, angles,
                                              [file] { return file->next(); }));
}

constexpr std::array<Format, 6> formats{{
    {"bvh", looks_like_bvh,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_bvh_reader(bvh_options(s.options), s.file.path));
     }},
    {"trc", looks_like_trc,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_trc_reader(s.options, s.file.path));
     }},
    {"xsens", looks_like_xsens_text,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_xsens_text_reader(s.options, s.file.path, s.file.node));
     }},
    {"sto", looks_like_opensim_sto,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_opensim_sto_reader(s.options, s.file.path));
     }},
    {"ntu", looks_like_ntu_skeleton,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_ntu_skeleton_reader(s.options, s.file.path));
     }},
    {"ui_prmd_kinect", looks_like_ui_prmd_kinect, make_ui_prmd},
}};

Result<AnyReader> make_table_reader(const TableLayout& layout, const Source& source) {
  if (layout.kind == TableKind::points) {
    return AnyReader(make_point_table_reader(layout, source.options, source.file.path));
  }
  return AnyReader(
      make_imu_table_reader(layout, source.options, source.file.path, source.file.node));
}

FoundFormat table_format(TableLayout layout, const Source& source) {
  std::string name = layout.name;
  return {std::move(name),
          [layout = std::move(layout), source] { return make_table_reader(layout, source); },
          {}};
}

FoundFormat program_format(const Format& format, const Source& source) {
  FoundFormat out{std::string(format.name), [&format, source] { return format.make(source); }, {}};
  if (format.make == make_ui_prmd) out.further_files.push_back(angles_of(source.file.path));
  return out;
}

std::string known_formats() {
  std::string text;
  for (const std::string_view name : format_names()) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

Result<FoundFormat> named_format(const Source& source) {
  const std::string& wanted = source.options.layout;
  const auto* known = std::find_if(formats.begin(), formats.end(),
                                   [&](const Format& f) { return f.name == wanted; });
  if (known != formats.end()) return program_format(*known, source);
  if (const auto text = builtin_layout(wanted)) {
    return table_format(KA_TRY(parse_layout(*text, wanted)), source);
  }
  if (!wanted.ends_with(".toml")) {
    return Failure(Error{source.file.path, 0,
                         "a layout's path (*.toml) or one of " + known_formats(),
                         "'" + shown(wanted) + "'"});
  }
  constexpr std::size_t longest_layout = std::size_t{1} << 20;
  const std::string text = KA_TRY(read_whole(*source.files, wanted, longest_layout));
  FoundFormat out = table_format(KA_TRY(parse_layout(text, wanted)), source);
  out.further_files.push_back(wanted);
  return out;
}

}  // namespace

std::vector<std::string_view> format_names() {
  std::vector<std::string_view> names(std::size(formats));
  std::transform(std::begin(formats), std::end(formats), names.begin(),
                 [](const Format& format) { return format.name; });
  const auto layouts = builtin_layout_names();
  names.insert(names.end(), layouts.begin(), layouts.end());
  return names;
}

Result<FoundFormat> find_format(FileSystem& files, const StreamOptions& options,
                                const StreamFile& file, std::string_view head) {
  const Source source{&files, options, file};
  if (!options.layout.empty()) return named_format(source);
  for (const Format& format : formats) {
    if (format.looks(head)) return program_format(format, source);
  }
  std::optional<TableLayout> named;  // the first one that knows the columns, if not the rows
  for (const std::string_view name : builtin_layout_names()) {
    const TableLayout layout = KA_TRY(parse_layout(*builtin_layout(name), name));
    if (matches(layout, head)) return table_format(layout, source);
    if (!named && knows_columns(layout, head)) named = layout;
  }
  if (named) return table_format(*named, source);  // its reader says which row is wrong
  return Failure(
      Error{file.path, 1, "a file that begins as one of " + known_formats(),
            head.empty() ? "an empty file" : "'" + shown(head.substr(0, head.find('\n'))) + "'"});
}

}  // namespace kinalign
