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

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

namespace kinalign {

namespace {

/// Everything that a reader needs to know of its file. Each later pass makes a new reader from it,
/// so it is copied into the functions below.
struct Source {
  FileSystem* files;
  StreamOptions options;
  StreamFile file;
};

/// A format with a reader of its own in this program. `looks` sees the first bytes and the path. It
/// must be sure: the first format that recognises a file gets it.
struct Format {
  std::string_view name;
  bool (*looks)(std::string_view head, std::string_view path);
  Result<AnyReader> (*make)(const Source& source);
  std::string_view selects = {};  // the only key that `select` may have here
  /// The further files that the reader opens; nullptr: none.
  Result<std::vector<std::string>> (*further_files)(const Source& source) = nullptr;
  /// A first pass of its own; nullptr: the survey reads all rows.
  Result<ClipSurvey> (*survey)(const Source& source, const Progress& progress) = nullptr;
};

/// For a format that is recognised by its content, whatever the file's name is.
template <bool (*looks)(std::string_view head)>
bool by_content(std::string_view head, std::string_view) {
  return looks(head);
}

/// True for one of a pair of UI-PRMD files. Files of angles, of the Kinect or of the optical
/// system, also look like tables of points, which would be wrong; the reader refuses them.
bool is_ui_prmd(std::string_view head, std::string_view path) {
  if (named_as_ui_prmd_positions(path)) return looks_like_ui_prmd_kinect(head);
  return named_as_ui_prmd_angles(path) &&
         (looks_like_ui_prmd_kinect(head) ||
          matches(*parse_layout(*builtin_layout("ui_prmd_vicon"), "ui_prmd_vicon"), head));
}

Result<std::vector<std::string>> ui_prmd_files(const Source& source) {
  return std::vector{KA_TRY(ui_prmd_angles_of(*source.files, source.file.path))};
}

/// UI-PRMD keeps positions and angles of one repetition in two files; the reader needs both. The
/// file of positions is read as the stream, that of angles through `file`.
Result<AnyReader> make_ui_prmd(const Source& source) {
  const std::string angles = KA_TRY(ui_prmd_angles_of(*source.files, source.file.path));
  auto file = std::make_shared<InputFile>(KA_TRY(InputFile::open(*source.files, angles)));
  return AnyReader(make_ui_prmd_kinect_reader(source.options, source.file.path, angles,
                                              [file] { return file->next(); }));
}

/// True for a tracking system of BIDS-Motion, by its name; its sidecar files state the meaning of
/// its columns.
bool is_bids(std::string_view, std::string_view path) { return named_as_bids_motion(path); }

Result<std::vector<std::string>> bids_files(const Source& source) {
  // A system that can't be read is an error here, before its sidecar files are listed as inputs.
  KA_TRY(read_bids_system(*source.files, source.file.path));
  return bids_sidecar_paths(*source.files, source.file.path);
}

/// Reads points if the file has positions, else nodes. `select kind` decides if it is given.
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

/// Reads the body's segments, or the sensors if `select part` says so.
Result<AnyReader> make_mvnx(const Source& source) {
  const auto part = source.options.select.find("part");
  if (part == source.options.select.end() || part->second == "segments") {
    return AnyReader(make_mvnx_reader(source.options, source.file.path));
  }
  if (part->second == "sensors") {
    return AnyReader(make_mvnx_sensor_reader(source.options, source.file.path));
  }
  return Failure(
      Error{source.file.path, 0, "select part = segments or sensors", shown(part->second)});
}

// The order decides: formats that are known by content come before those that are known by name,
// and all of them before the layouts.
constexpr std::array<Format, 9> formats{{
    {"bvh", by_content<looks_like_bvh>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_bvh_reader(bvh_options(s.options), s.file.path));
     },
     "", nullptr,
     [](const Source& s, const Progress& progress) {
       return survey_bvh(*s.files, s.file.path, bvh_options(s.options), progress);
     }},
    {"trc", by_content<looks_like_trc>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_trc_reader(s.options, s.file.path));
     }},
    {"c3d", by_content<looks_like_c3d>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_c3d_reader(s.options, s.file.path));
     }},
    {"mvnx", by_content<looks_like_mvnx>, make_mvnx, "part"},
    {"xsens", by_content<looks_like_xsens_text>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_xsens_text_reader(s.options, s.file.path, s.file.node));
     }},
    {"sto", by_content<looks_like_opensim_sto>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_opensim_sto_reader(s.options, s.file.path));
     }},
    {"ntu", by_content<looks_like_ntu_skeleton>,
     [](const Source& s) -> Result<AnyReader> {
       return AnyReader(make_ntu_skeleton_reader(s.options, s.file.path));
     },
     "body"},
    {"ui_prmd_kinect", is_ui_prmd, make_ui_prmd, "", ui_prmd_files},
    {"bids", is_bids, make_bids, "kind", bids_files},
}};

/// The kind of a layout says whether its rows are points or nodes.
Result<AnyReader> make_table_reader(const TableLayout& layout, const Source& source) {
  if (layout.kind == TableKind::points) {
    return AnyReader(make_point_table_reader(layout, source.options, source.file.path));
  }
  return AnyReader(
      make_imu_table_reader(layout, source.options, source.file.path, source.file.node));
}

/// A declared layout reads one file and opens no other.
FoundFormat table_format(TableLayout layout, const Source& source) {
  std::string name = layout.name;
  return {std::move(name),
          [layout = std::move(layout), source] { return make_table_reader(layout, source); },
          {},
          {}};
}

/// Refuses a selection that the format does not know: it would be ignored without notice.
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

/// Makes each later pass fail if one of the further files has changed. Only the main file is hashed
/// while it is read, so the others are compared by their versions.
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

/// The format with its reader, its own survey and its further files, if it has any.
Result<FoundFormat> program_format(const Format& format, const Source& source) {
  KA_TRY(check_selection(format, source));
  // `format` is a row of the constant table, so a reference to it stays valid.
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

/// The reader of a file: a format, a layout, or neither.
struct Recognized {
  const Format* format = nullptr;
  std::optional<TableLayout> layout{};
};

/// A layout that knows the columns but not the rows is used too: its reader reports the wrong row.
Result<Recognized> recognize(std::string_view head, std::string_view path) {
  for (const Format& format : formats) {
    if (format.looks(head, path)) return Recognized{&format};
  }
  // A file of an export whose first row is broken still has the columns of its layout.
  std::optional<TableLayout> named;  // the first layout that knows the columns, if not the rows
  for (const std::string_view name : builtin_layout_names()) {
    TableLayout layout = KA_TRY(parse_layout(*builtin_layout(name), name));
    if (matches(layout, head)) return Recognized{nullptr, std::move(layout)};
    if (!named && knows_columns(layout, head)) named = std::move(layout);
  }
  return Recognized{nullptr, std::move(named)};  // its reader reports the wrong row
}

/// The names for an error, in the order in which formats are tried.
std::string known_formats() {
  std::string text;
  for (const std::string_view name : format_names()) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

/// The format of the option `layout`: a format's name, a built-in layout's, or a layout file.
Result<FoundFormat> named_format(const Source& source) {
  const std::string& wanted = source.options.layout;
  const auto* known = std::find_if(formats.begin(), formats.end(),
                                   [&](const Format& f) { return f.name == wanted; });
  if (known != formats.end()) return program_format(*known, source);
  if (const auto text = builtin_layout(wanted)) {
    return table_format(KA_TRY(parse_layout(*text, wanted)), source);
  }
  if (!source.options.own_layout()) {
    return Failure(Error{source.file.path, 0,
                         "a layout's path (*.toml) or one of " + known_formats(),
                         "'" + shown(wanted) + "'"});
  }
  // Far more than any layout needs; a file of data that was named by mistake is not read whole.
  constexpr std::size_t longest_layout = std::size_t{1} << 20;
  const auto version = version_of(wanted);
  const std::string text = KA_TRY(read_whole(*source.files, wanted, longest_layout));
  FoundFormat out = table_format(KA_TRY(parse_layout(text, wanted)), source);
  out.further_files.push_back(wanted);
  // The file may have changed between its version and its text. The take would then name a layout
  // that was not used.
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

/// The user's choice comes before recognition, so that a file with an unusual beginning can be
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
  std::array<char, 10> start{};  // the length of the longest signature
  const std::string_view signature(start.data(), KA_TRY(file.read_at(0, start)));
  if (looks_like_recording(signature)) return FileKind::recording;
  if (looks_like_xdf(signature)) return FileKind::xdf;
  if (looks_like_hdf5(signature)) return FileKind::take;
  if (looks_like_model(signature)) return FileKind::model;
  // A manifest is text without a signature, and a layout could take it for a table.
  if (path.ends_with(".toml")) return FileKind::manifest;
  const Recognized known = KA_TRY(recognize(KA_TRY(file.next()), path));
  return known.format != nullptr || known.layout ? FileKind::stream : FileKind::unknown;
}

}  // namespace kinalign
