// SPDX-License-Identifier: Apache-2.0
#include "kinalign/sources/formats.h"

#include "kinalign/core/file_version.h"
#include "kinalign/formats/bids/system.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/c3d/c3d.h"
#include "kinalign/formats/imu/opensim_sto.h"
#include "kinalign/formats/imu/xsens_text.h"
#include "kinalign/formats/mvnx/mvnx.h"
#include "kinalign/formats/points/ntu_skeleton.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/points/ui_prmd_files.h"
#include "kinalign/formats/points/ui_prmd_kinect.h"
#include "kinalign/formats/table/layout.h"
#include "kinalign/formats/table/table_reader.h"
#include "kinalign/formats/unknown_file.h"
#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/recording/format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

namespace kinalign {

namespace {

/// The file and the options of a stream. The functions below copy it, because each later pass makes
/// a new reader from it.
struct Source {
  FileSystem* files;
  StreamOptions options;
  StreamFile file;
};

/// A format that has its own reader in this program. `looks` gets the first bytes and the path. The
/// first format that recognises a file is used, so `looks` must be certain.
struct Format {
  std::string_view name;
  bool (*looks)(std::string_view head, std::string_view path);
  Result<AnyReader> (*make)(const Source& source);
  std::string_view selects = {};  // the only key of `select` that this format knows
  /// Returns the further files that the reader opens; nullptr: there are none.
  Result<std::vector<std::string>> (*further_files)(const Source& source) = nullptr;
  /// The format's own first pass; nullptr: the first pass reads all rows.
  Result<ClipSurvey> (*survey)(const Source& source, const Progress& progress) = nullptr;
};

/// Recognises a format by the first bytes alone; the file's name does not matter.
template <bool (*looks)(std::string_view head)>
bool by_content(std::string_view head, std::string_view) {
  return looks(head);
}

/// Makes a reader that needs only the options and the file's name.
template <auto make>
Result<AnyReader> make_reader(const Source& source) {
  return AnyReader(make(source.options, source.file.path));
}

/// Returns whether the file is one of a pair of UI-PRMD files. Files of angles also look like
/// tables of points, which would be wrong. They are therefore recognised here, and the reader
/// refuses them.
bool is_ui_prmd(std::string_view head, std::string_view path) {
  if (named_as_ui_prmd_positions(path)) return looks_like_ui_prmd_kinect(head);
  return named_as_ui_prmd_angles(path) &&
         (looks_like_ui_prmd_kinect(head) ||
          matches(*parse_layout(*builtin_layout("ui_prmd_vicon"), "ui_prmd_vicon"), head));
}

Result<std::vector<std::string>> ui_prmd_files(const Source& source) {
  return std::vector{KA_TRY(ui_prmd_angles_of(*source.files, source.file.path))};
}

/// UI-PRMD stores the positions and the angles of one repetition in two files, and the reader needs
/// both. The file of positions is read as the stream, the file of angles through `file`.
Result<AnyReader> make_ui_prmd(const Source& source) {
  const std::string angles = KA_TRY(ui_prmd_angles_of(*source.files, source.file.path));
  auto file = std::make_shared<InputFile>(KA_TRY(InputFile::open(*source.files, angles)));
  return AnyReader(make_ui_prmd_kinect_reader(source.options, source.file.path, angles,
                                              [file] { return file->next(); }));
}

/// Returns whether the file is a tracking system of BIDS-Motion, by its name. Its sidecar files
/// state the meaning of its columns.
bool is_bids(std::string_view, std::string_view path) { return named_as_bids_motion(path); }

Result<std::vector<std::string>> bids_files(const Source& source) {
  // If the system can't be read, the error is returned before sidecar files are listed.
  KA_TRY(read_bids_system(*source.files, source.file.path));
  return bids_sidecar_paths(*source.files, source.file.path);
}

/// Reads points if the file has positions, otherwise nodes. `select kind` overrides this choice.
Result<AnyReader> make_bids(const Source& source) {
  const BidsSystem system = KA_TRY(read_bids_system(*source.files, source.file.path));
  const auto kind = source.options.select.find("kind");
  const bool chosen = kind != source.options.select.end();
  if (chosen && kind->second != "points" && kind->second != "nodes") {
    return Failure(
        Error{source.file.path, 0, "select kind = points or nodes", shown(kind->second)});
  }
  if (chosen ? kind->second == "points" : has_positions(system)) {
    return AnyReader(KA_TRY(make_bids_point_reader(system, source.options, source.file.path)));
  }
  return AnyReader(KA_TRY(make_bids_node_reader(system, source.options, source.file.path)));
}

/// Reads the segments of the body, or the sensors if `select part` is "sensors".
Result<AnyReader> make_mvnx(const Source& source) {
  const auto part = source.options.select.find("part");
  if (part == source.options.select.end() || part->second == "segments") {
    return make_reader<make_mvnx_reader>(source);
  }
  if (part->second == "sensors") {
    return make_reader<make_mvnx_sensor_reader>(source);
  }
  return Failure(
      Error{source.file.path, 0, "select part = segments or sensors", shown(part->second)});
}

// The order matters: first formats that are recognised by content, then formats that are recognised
// by name. Layouts are checked after all formats.
constexpr std::array<Format, 9> formats{{
    {"bvh", by_content<looks_like_bvh>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_bvh_reader(bvh_options(s.options), s.file.path));
     },
     "", nullptr,
     [](const Source& s, const Progress& progress) {
       return survey_bvh(*s.files, s.file.path, bvh_options(s.options), progress);
     }},
    {"trc", by_content<looks_like_trc>, make_reader<make_trc_reader>},
    {"c3d", by_content<looks_like_c3d>, make_reader<make_c3d_reader>},
    {"mvnx", by_content<looks_like_mvnx>, make_mvnx, "part"},
    {"xsens", by_content<looks_like_xsens_text>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_xsens_text_reader(s.options, s.file.path, s.file.node));
     }},
    {"sto", by_content<looks_like_opensim_sto>, make_reader<make_opensim_sto_reader>},
    {"ntu", by_content<looks_like_ntu_skeleton>, make_reader<make_ntu_skeleton_reader>, "body"},
    {"ui_prmd_kinect", is_ui_prmd, make_ui_prmd, "", ui_prmd_files},
    {"bids", is_bids, make_bids, "kind", bids_files},
}};

/// The kind of the layout decides whether rows become points or nodes.
Result<AnyReader> make_table_reader(const TableLayout& layout, const Source& source) {
  if (layout.kind == TableKind::points) {
    return AnyReader(make_point_table_reader(layout, source.options, source.file.path));
  }
  return AnyReader(
      make_imu_table_reader(layout, source.options, source.file.path, source.file.node));
}

/// A layout reads one file and opens no other file.
FoundFormat table_format(TableLayout layout, const Source& source) {
  std::string name = layout.name;
  return {std::move(name),
          [layout = std::move(layout), source] { return make_table_reader(layout, source); },
          {},
          {}};
}

/// Refuses a key of `select` that the format does not know, because it would be ignored.
Result<void> check_selection(const Format& format, const Source& source) {
  for (const auto& [name, value] : source.options.select) {
    if (name == format.selects) continue;
    const std::string known(format.selects);
    return Failure(Error{source.file.path, 0,
                         known.empty()
                             ? "no select for a file of format " + std::string(format.name)
                             : "select by " + known,
                         shown(name) + " = " + shown(value)});
  }
  return {};
}

/// Makes later passes fail if one of the further files has changed. Only the main file is hashed
/// while it is read, so the version (size and times) of the other files is compared.
FoundFormat watched(FoundFormat found) {
  std::vector<std::optional<FileVersion>> versions;
  for (const std::string& path : found.further_files) versions.push_back(version_of(path));
  found.make = [make = std::move(found.make), paths = found.further_files,
                versions]() -> Result<AnyReader> {
    for (std::size_t i = 0; i < paths.size(); ++i) KA_TRY(unchanged(paths[i], versions[i]));
    return make();
  };
  return found;
}

/// Returns the format with its reader, its own first pass and its further files.
Result<FoundFormat> program_format(const Format& format, const Source& source) {
  KA_TRY(check_selection(format, source));
  // `format` is an element of a constant array, so the reference stays valid.
  FoundFormat out{
      std::string(format.name), [&format, source] { return format.make(source); }, {}, {}};
  if (format.survey != nullptr) {
    out.survey = [&format, source](const Progress& progress) {
      return format.survey(source, progress);
    };
  }
  if (format.further_files == nullptr) return out;
  out.further_files = KA_TRY(format.further_files(source));
  return watched(std::move(out));
}

/// The format or the layout that recognises a file. Both may be absent.
struct Recognized {
  const Format* format = nullptr;
  std::optional<TableLayout> layout{};
};

/// If the columns agree with a layout but the rows do not, the layout is used. Its reader then
/// reports the wrong row.
Result<Recognized> recognize(std::string_view head, std::string_view path) {
  for (const Format& format : formats) {
    if (format.looks(head, path)) return Recognized{&format};
  }
  // If the first row of a file is damaged, its columns still agree with a layout.
  std::optional<TableLayout> named;  // the first layout whose columns agree, but not its rows
  for (const std::string_view name : builtin_layout_names()) {
    TableLayout layout = KA_TRY(parse_layout(*builtin_layout(name), name));
    if (matches(layout, head)) return Recognized{nullptr, std::move(layout)};
    if (!named && knows_columns(layout, head)) named = std::move(layout);
  }
  return Recognized{nullptr, std::move(named)};  // the layout's reader reports the wrong row
}

/// Returns the format that the option `layout` names: a format, a built-in layout, or a layout
/// file.
Result<FoundFormat> named_format(const Source& source) {
  const std::string& wanted = source.options.layout;
  const auto* known = std::find_if(formats.begin(), formats.end(),
                                   [&](const Format& f) { return f.name == wanted; });
  if (known != formats.end()) return program_format(*known, source);
  if (const auto text = builtin_layout(wanted)) {
    return table_format(KA_TRY(parse_layout(*text, wanted)), source);
  }
  if (!source.options.own_layout()) {
    return Failure(
        Error{source.file.path, 0,
              fmt::format("a layout's path (*.toml) or one of {}", fmt::join(format_names(), ", ")),
              "'" + shown(wanted) + "'"});
  }
  // Far longer than any layout. If a data file is named by mistake, only this much is read.
  constexpr std::size_t longest_layout = std::size_t{1} << 20;
  const auto version = version_of(wanted);
  const std::string text = KA_TRY(read_whole(*source.files, wanted, longest_layout));
  FoundFormat out = table_format(KA_TRY(parse_layout(text, wanted)), source);
  out.further_files.push_back(wanted);
  // If the file changed between these two calls, the take would name a layout that was not used.
  KA_TRY(unchanged(wanted, version));
  return watched(std::move(out));
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

/// The user's choice has priority over recognition, so that a file with an unusual beginning can be
/// read.
Result<FoundFormat> find_format(FileSystem& files, const StreamOptions& options,
                                const StreamFile& file, std::string_view head) {
  const Source source{&files, options, file};
  if (!options.layout.empty()) return named_format(source);
  Recognized known = KA_TRY(recognize(head, file.path));
  if (known.format != nullptr) return program_format(*known.format, source);
  if (known.layout) return table_format(*std::move(known.layout), source);
  return Failure(unknown_file(file.path, head));
}

Result<FileKind> kind_of_file(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  std::array<char, 10> start{};  // the longest signature has 10 bytes
  const std::string_view signature(start.data(), KA_TRY(file.read_at(0, start)));
  if (looks_like_recording(signature)) return FileKind::recording;
  if (looks_like_xdf(signature)) return FileKind::xdf;
  if (looks_like_hdf5(signature)) return FileKind::take;
  if (looks_like_model(signature)) return FileKind::model;
  // A manifest is text without a signature, and a layout could recognise it as a table.
  if (path.ends_with(".toml")) return FileKind::manifest;
  const Recognized known = KA_TRY(recognize(KA_TRY(file.next()), path));
  return known.format != nullptr || known.layout ? FileKind::stream : FileKind::unknown;
}

}  // namespace kinalign
