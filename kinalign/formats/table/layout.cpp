// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/layout.h"

#include "kinalign/formats/table/layout_keys.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace kinalign {

namespace {

template <class T>
using Choices = std::vector<std::pair<std::string_view, T>>;

const Choices<TableField>& field_names() {
  static const Choices<TableField> names{
      {"x", TableField::x},   {"y", TableField::y},         {"z", TableField::z},
      {"qw", TableField::qw}, {"qx", TableField::qx},       {"qy", TableField::qy},
      {"qz", TableField::qz}, {"ax", TableField::ax},       {"ay", TableField::ay},
      {"az", TableField::az}, {"gx", TableField::gx},       {"gy", TableField::gy},
      {"gz", TableField::gz}, {"state", TableField::state}, {"skip", TableField::skip}};
  return names;
}

bool of_points(TableField field) { return field <= TableField::state; }

/// The choice that the key's text names; `otherwise` without the key. The error lists all choices.
template <class T>
Result<T> chosen(const LayoutKeys& keys, std::string_view key, const Choices<T>& choices,
                 T otherwise) {
  if (!keys.has(key)) return otherwise;
  const std::string text = KA_TRY(keys.text(key));
  std::string expected;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    expected += (expected.empty() ? "" : ", ") + std::string(name);
  }
  return Failure(keys.error(key, std::string(key) + " = one of " + expected, shown(text)));
}

/// Reads the keys about lines and cells.
Result<void> read_shape(const LayoutKeys& keys, TableLayout& layout) {
  layout.kind = KA_TRY(chosen<TableKind>(
      keys, "kind", {{"points", TableKind::points}, {"imu", TableKind::imu}}, TableKind::points));
  layout.delimiter = KA_TRY(chosen<char>(
      keys, "delimiter",
      {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blank", runs_of_blanks}}, ','));
  layout.comment = KA_TRY(keys.text("comment", ""));
  layout.header = KA_TRY(keys.truth("header", true));
  layout.skip_lines = KA_TRY(keys.count("skip_lines", 0));
  layout.columns = KA_TRY(keys.count("columns", 0));
  layout.rate_hz = KA_TRY(keys.positive("rate_hz", 0.0));
  return {};
}

Result<ColumnChoice> column_choice(const LayoutKeys& keys, std::string_view key) {
  if (keys.is_text(key)) return ColumnChoice{KA_TRY(keys.text(key)), 0};
  ColumnChoice choice{"", KA_TRY(keys.count(key, 0))};
  if (choice.number == 0) {
    return Failure(keys.error(key, "the column's name, or its number from 1", "no such thing"));
  }
  return choice;
}

/// Reads the table `time`; without it, rows come at rate_hz.
Result<void> read_time(const LayoutKeys& top, TableLayout& layout) {
  if (!top.has("time")) return {};
  const LayoutKeys keys = KA_TRY(top.table("time", {"column", "unit", "epoch"}));
  TableTime time;
  time.column = KA_TRY(column_choice(keys, "column"));
  time.scale.unit_ns = KA_TRY(chosen<std::int64_t>(
      keys, "unit",
      {{"ns", 1}, {"us", 1000}, {"ms", 1'000'000}, {"s", 1'000'000'000}, {"ticks_100ns", 100}}, 1));
  time.scale.epoch_s =
      KA_TRY(chosen<std::int64_t>(keys, "epoch", {{"unix", 0}, {"year_1", year_1_s}}, 0));
  layout.time = time;
  return {};
}

/// The field of that name, if tables of that kind can have it.
Result<TableField> field_of(const LayoutKeys& keys, std::string_view name, TableKind kind) {
  for (const auto& [known, field] : field_names()) {
    const bool fits = field == TableField::skip || of_points(field) == (kind == TableKind::points);
    if (known == name && fits) return field;
  }
  return Failure(keys.error("fields",
                            kind == TableKind::points
                                ? "fields x, y, z, state, skip"
                                : "fields qw ... qz, ax ... az, gx ... gz, skip",
                            shown(name)));
}

Result<void> read_fields_in_order(const LayoutKeys& keys, TableLayout& layout) {
  for (const std::string& name : KA_TRY(keys.texts("fields"))) {
    layout.fields.push_back({KA_TRY(field_of(keys, name, layout.kind)), ""});
  }
  layout.first_column = KA_TRY(keys.count("first_column", 1));
  return {};
}

Result<void> read_fields_by_name(const LayoutKeys& keys, TableLayout& layout) {
  const LayoutKeys named = KA_TRY(keys.table("fields", {}));
  for (const std::string& name : named.keys()) {
    const TableField field = KA_TRY(field_of(keys, name, layout.kind));
    layout.fields.push_back({field, KA_TRY(named.text(name))});
  }
  return {};
}

Result<void> read_members(const LayoutKeys& top, TableLayout& layout) {
  const bool points = layout.kind == TableKind::points;
  const std::string_view key = points ? "joints" : "nodes";
  const LayoutKeys keys = KA_TRY(top.table(key, {"names", "fields", "first_column"}));
  if (points || keys.has("names")) layout.names = KA_TRY(keys.texts("names"));
  layout.by_name = keys.is_table("fields");
  return layout.by_name ? read_fields_by_name(keys, layout) : read_fields_in_order(keys, layout);
}

Result<void> read_state(const LayoutKeys& top, TableLayout& layout) {
  if (!top.has("state")) return {};
  const LayoutKeys keys = KA_TRY(top.table("state", {"missing", "inferred", "tracked"}));
  layout.state.missing = KA_TRY(keys.numbers("missing"));
  layout.state.inferred = KA_TRY(keys.numbers("inferred"));
  layout.state.tracked = KA_TRY(keys.numbers("tracked"));
  return {};
}

/// Reads `up` or the table `axes`. Axes that mirror need mirrored = true, so that nobody mirrors by
/// mistake.
Result<void> read_axes(const LayoutKeys& top, TableLayout& layout) {
  layout.axes = KA_TRY(chosen<Axes>(top, "up", {{"y", y_up}, {"z", z_up}}, y_up));
  if (!top.has("axes")) return {};
  const LayoutKeys keys = KA_TRY(top.table("axes", {"x", "y", "z", "mirrored"}));
  const Choices<int> signed_axes{{"x", 1}, {"y", 2}, {"z", 3}, {"-x", -1}, {"-y", -2}, {"-z", -3}};
  layout.axes = {KA_TRY(chosen(keys, "x", signed_axes, 1)),
                 KA_TRY(chosen(keys, "y", signed_axes, 2)),
                 KA_TRY(chosen(keys, "z", signed_axes, 3))};
  const bool mirrored = KA_TRY(keys.truth("mirrored", false));
  if (mirrored && layout.kind == TableKind::imu) {
    return Failure(keys.error("mirrored",
                              "axes of nodes that keep right-handed: an orientation has "
                              "no mirror image",
                              "mirrored = true"));
  }
  if (determinant(layout.axes) == (mirrored ? -1 : 1)) return {};
  return Failure(top.error("axes", mirrored ? "axes that mirror" : "axes that keep right-handed",
                           determinant(layout.axes) == 0 ? "an axis that stands twice"
                           : mirrored                    ? "axes that keep right-handed"
                                      : "a mirror image without mirrored = true"));
}

/// Reads the units and the values of a joint that was not seen.
Result<void> read_units(const LayoutKeys& keys, TableLayout& layout) {
  constexpr double g = 9.80665;
  layout.metres_per_unit = KA_TRY(keys.positive("metres_per_unit", 1.0));
  layout.acceleration_unit =
      KA_TRY(chosen(keys, "acceleration_unit", Choices<double>{{"m/s2", 1.0}, {"g", g}}, 1.0));
  layout.angular_velocity_unit =
      KA_TRY(chosen(keys, "angular_velocity_unit",
                    Choices<double>{{"rad/s", 1.0}, {"deg/s", std::numbers::pi / 180.0}}, 1.0));
  layout.gravity = KA_TRY(keys.truth("gravity", true));
  if (!keys.has("missing_point")) return {};
  layout.missing_point = KA_TRY(keys.numbers("missing_point"));
  if (layout.missing_point.size() == 3) return {};
  return Failure(
      keys.error("missing_point", "three numbers", std::to_string(layout.missing_point.size())));
}

Result<void> read_selection(const LayoutKeys& top, TableLayout& layout) {
  layout.body = KA_TRY(top.text("body", ""));
  if (!top.has("select")) return {};
  const LayoutKeys keys = KA_TRY(top.table("select", {}));
  for (const std::string& column : keys.keys()) layout.select[column] = KA_TRY(keys.text(column));
  return {};
}

bool has_field(const TableLayout& layout, TableField field) {
  return std::any_of(layout.fields.begin(), layout.fields.end(),
                     [&](const FieldColumn& each) { return each.field == field; });
}

/// Checks that each quantity has all its components or none, and that no component occurs twice.
Result<void> check_fields(const LayoutKeys& keys, TableLayout& layout) {
  using enum TableField;
  for (const FieldColumn& one : layout.fields) {
    const auto same = [&](const FieldColumn& each) { return each.field == one.field; };
    if (one.field != skip && std::count_if(layout.fields.begin(), layout.fields.end(), same) > 1) {
      return Failure(keys.error("fields", "each field once", "one twice"));
    }
  }
  std::size_t whole = 0;
  const std::vector<std::vector<TableField>> groups{
      {x, y, z}, {qw, qx, qy, qz}, {ax, ay, az}, {gx, gy, gz}};
  for (const auto& group : groups) {
    const auto there = std::count_if(group.begin(), group.end(),
                                     [&](TableField each) { return has_field(layout, each); });
    if (there != 0 && there != static_cast<std::ptrdiff_t>(group.size())) {
      return Failure(keys.error("fields", "all components of a quantity",
                                std::to_string(there) + " of " + std::to_string(group.size())));
    }
    whole += there != 0 ? 1 : 0;
  }
  if (whole > 0) return {};
  return Failure(keys.error("fields", "x, y and z, or a quantity of an IMU", "none"));
}

/// Checks that columns are given in a form that the file allows, and computes the width of a row.
Result<void> check_columns(const LayoutKeys& keys, TableLayout& layout) {
  if (layout.by_name && !layout.header) {
    return Failure(
        keys.error("fields", "fields in order where no line names the columns", "fields by name"));
  }
  if (!layout.header && layout.time && layout.time->column.number == 0) {
    return Failure(keys.error("time", "a column's number where no line names the columns",
                              shown(layout.time->column.name)));
  }
  if (!layout.by_name) {
    const std::size_t members = std::max<std::size_t>(layout.names.size(), 1);
    const std::size_t last = layout.first_column + members * layout.fields.size() - 1;
    if (layout.first_column == 0 || (layout.columns != 0 && layout.columns < last)) {
      return Failure(keys.error("columns", "at least " + std::to_string(last) + " columns",
                                std::to_string(layout.columns)));
    }
    if (layout.columns == 0 && !layout.header) layout.columns = last;
  }
  return {};
}

Result<TableLayout> read_layout(const LayoutKeys& keys) {
  TableLayout layout;
  layout.name = KA_TRY(keys.text("name"));
  for (const auto step : {read_shape, read_time, read_members, read_state, read_axes, read_units,
                          read_selection, check_fields, check_columns}) {
    KA_TRY(step(keys, layout));
  }
  return layout;
}

}  // namespace

Result<TableLayout> parse_layout(std::string_view toml, std::string_view name) {
  const LayoutKeys keys = KA_TRY(LayoutKeys::parse(toml, name,
                                                   {"name",
                                                    "kind",
                                                    "delimiter",
                                                    "comment",
                                                    "header",
                                                    "skip_lines",
                                                    "columns",
                                                    "rate_hz",
                                                    "time",
                                                    "joints",
                                                    "nodes",
                                                    "state",
                                                    "up",
                                                    "axes",
                                                    "metres_per_unit",
                                                    "acceleration_unit",
                                                    "angular_velocity_unit",
                                                    "gravity",
                                                    "missing_point",
                                                    "select",
                                                    "body"}));
  return read_layout(keys);
}

}  // namespace kinalign
