// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/layout.h"

#include "kinalign/syntax/toml.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace kinalign {

namespace {

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

// The order of TableField has points first; of_points() depends on it.
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

/// An option that names one of the choices.
/// The name is read as a text first, and turned into the value by chosen() afterwards.
template <class T>
Field choice(const char* key, const Choices<T>& choices, std::string& name) {
  Field field{key, "", &name};
  for (const auto& [known, value] : choices) field.choices.push_back(known);
  return field;
}
/// read_options() has checked the name, so it is among the choices.
template <class T>
T chosen(const Choices<T>& choices, const std::string& name) {
  return std::find_if(choices.begin(), choices.end(),
                      [&](const auto& one) { return one.first == name; })
      ->second;
}

// The limits are meant against typing errors.
Field positive(const char* key, double& number) { return {key, "", &number, 1e-9, 1e9}; }
Field count(const char* key, std::int64_t& number) { return {key, "", &number, 0.0, 100'000.0}; }

/// Accepts a table that is read later, when the kind of the layout is known.
Result<void> later(const Value&) { return {}; }

/// Reads the keys that are not in a table.
/// [time], [joints] and other tables are read by the functions below.
Result<void> read_top(const Value& top, TableLayout& layout) {
  const Choices<TableKind> kinds{{"points", TableKind::points}, {"imu", TableKind::imu}};
  const Choices<char> delimiters{
      {"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"blank", runs_of_blanks}};
  const Choices<Axes> ups{{"y", y_up}, {"z", z_up}};
  const Choices<double> accelerations{{"m/s2", 1.0}, {"g", 9.80665}};
  const Choices<double> angular_velocities{{"rad/s", 1.0}, {"deg/s", std::numbers::pi / 180.0}};
  std::string kind = "points", delimiter = "comma", up = "y", acceleration = "m/s2",
              angular_velocity = "rad/s";
  std::int64_t skip_lines = 0, columns = 0;
  const Fields fields{
      {"name", "", &layout.name},
      choice("kind", kinds, kind),
      choice("delimiter", delimiters, delimiter),
      {"comment", "", &layout.comment},
      {"header", "", &layout.header},
      count("skip_lines", skip_lines),
      count("columns", columns),
      positive("rate_hz", layout.rate_hz),
      choice("up", ups, up),
      positive("metres_per_unit", layout.metres_per_unit),
      choice("acceleration_unit", accelerations, acceleration),
      choice("angular_velocity_unit", angular_velocities, angular_velocity),
      {"gravity", "", &layout.gravity},
      {.name = "missing_point", .meaning = "", .value = &layout.missing_point, .count = 3},
      {"select", "", &layout.select},
      {"body", "", &layout.body}};
  KA_TRY(read_options(
      top, fields,
      {{"time", later}, {"joints", later}, {"nodes", later}, {"state", later}, {"axes", later}}));
  layout.kind = chosen(kinds, kind);
  layout.delimiter = chosen(delimiters, delimiter);
  layout.axes = chosen(ups, up);
  layout.acceleration_unit = chosen(accelerations, acceleration);
  layout.angular_velocity_unit = chosen(angular_velocities, angular_velocity);
  layout.skip_lines = static_cast<std::size_t>(skip_lines);
  layout.columns = static_cast<std::size_t>(columns);
  // The name appears in messages about the columns.
  if (!layout.name.empty()) return {};
  return at(top, "name, what the layout is called", "none");
}

/// Reads the table `time`; without it, rows come at rate_hz.
Result<void> read_time(const Value& top, TableLayout& layout) {
  const Value* table = top.find({"time"});
  // Rows then come at rate_hz.
  if (table == nullptr) return {};
  const Choices<std::int64_t> units{
      {"ns", 1}, {"us", 1000}, {"ms", 1'000'000}, {"s", 1'000'000'000}, {"ticks_100ns", 100}};
  const Choices<std::int64_t> epochs{{"unix", 0}, {"year_1", year_1_s}};
  std::string unit = "ns", epoch = "unix";
  // A whole number is a column's number, a text its name.
  ColumnChoice column;
  const auto read_column = [&](const Value& value) -> Result<void> {
    if (value.kind != Value::Kind::whole) return set_option({"column", "", &column.name}, value);
    std::int64_t number = 0;
    KA_TRY(set_option({"column", "", &number, 1.0, 100'000.0}, value));
    column.number = static_cast<std::size_t>(number);
    return {};
  };
  KA_TRY(read_options(*table, {choice("unit", units, unit), choice("epoch", epochs, epoch)},
                      {{"column", read_column}}));
  if (column.name.empty() && column.number == 0) {
    return at(*table, "column in [time], a name or a number from 1", "none");
  }
  // The scale joins unit and epoch: stamp = number * unit + epoch.
  layout.time = TableTime{column, {chosen(units, unit), chosen(epochs, epoch)}};
  return {};
}

/// Adds a field, if tables of that kind can have it.
Result<void> add_field(const Value& fields, const std::string& name, const std::string& pattern,
                       TableLayout& layout) {
  const bool points = layout.kind == TableKind::points;
  for (const auto& [known, field] : field_names()) {
    // skip is a place holder for columns that are not read, in tables of both kinds.
    const bool fits = field == TableField::skip || of_points(field) == points;
    if (known != name || !fits) continue;
    layout.fields.push_back({field, pattern});
    return {};
  }
  return at(fields,
            points ? "fields x, y, z, state, skip" : "fields qw ... qz, ax ... az, gx ... gz, skip",
            shown(name));
}

/// Reads the fields: a table of patterns, or a list in the order of the columns.
/// A list gives the order of the columns; a table gives their names.
Result<void> read_fields(const Value& fields, TableLayout& layout) {
  layout.by_name = fields.is_table();
  std::map<std::string, std::string> patterns;
  std::vector<std::string> names;
  KA_TRY(set_option(layout.by_name ? Field{"fields", "", &patterns} : Field{"fields", "", &names},
                    fields));
  // One of the two is empty.
  for (const auto& [name, pattern] : patterns) KA_TRY(add_field(fields, name, pattern, layout));
  for (const std::string& name : names) KA_TRY(add_field(fields, name, "", layout));
  return {};
}

bool has_field(const TableLayout& layout, TableField field) {
  return std::any_of(layout.fields.begin(), layout.fields.end(),
                     [&](const FieldColumn& each) { return each.field == field; });
}

/// Checks that each quantity has all its components or none, and that no component occurs twice.
Result<void> check_fields(const Value& fields, const TableLayout& layout) {
  using enum TableField;
  // A field may be skipped often, but has one column otherwise.
  for (const FieldColumn& one : layout.fields) {
    const auto same = [&](const FieldColumn& each) { return each.field == one.field; };
    if (one.field != skip && std::count_if(layout.fields.begin(), layout.fields.end(), same) > 1) {
      return at(fields, "each field once", "one twice");
    }
  }
  // Whole quantities; at least one is needed.
  std::size_t whole = 0;
  const std::vector<std::vector<TableField>> groups{
      {x, y, z}, {qw, qx, qy, qz}, {ax, ay, az}, {gx, gy, gz}};
  for (const auto& group : groups) {
    const auto there = std::count_if(group.begin(), group.end(),
                                     [&](TableField each) { return has_field(layout, each); });
    if (there != 0 && there != static_cast<std::ptrdiff_t>(group.size())) {
      return at(fields, "all components of a quantity",
                std::to_string(there) + " of " + std::to_string(group.size()));
    }
    whole += there != 0 ? 1 : 0;
  }
  if (whole > 0) return {};
  return at(fields, "x, y and z, or a quantity of an IMU", "none");
}

/// Reads the table of the joints or nodes.
Result<void> read_members(const Value& top, TableLayout& layout) {
  const std::string_view key = layout.kind == TableKind::points ? "joints" : "nodes";
  const Value* table = top.find({key});
  if (table == nullptr) return at(top, "a table [" + std::string(key) + "]", "none");
  // The names are optional for nodes: a file may be one node's.
  std::int64_t first_column = 1;
  KA_TRY(read_options(*table, {{"names", "", &layout.names}, count("first_column", first_column)},
                      {{"fields", later}}));
  layout.first_column = static_cast<std::size_t>(first_column);
  if (layout.names.empty() && (key == "joints" || table->find({"names"}) != nullptr)) {
    return at(*table, "names in [" + table->path + "]", "none");
  }
  const Value* fields = table->find({"fields"});
  // Without fields nothing is known about the columns.
  if (fields == nullptr) return at(*table, "fields in [" + table->path + "]", "none");
  KA_TRY(read_fields(*fields, layout));
  return check_fields(*fields, layout);
}

Result<void> read_state(const Value& top, TableLayout& layout) {
  const Value* table = top.find({"state"});
  if (table == nullptr) return {};
  return read_options(*table, {{"missing", "", &layout.state.missing},
                               {"inferred", "", &layout.state.inferred},
                               {"tracked", "", &layout.state.tracked}});
}

/// Reads the table `axes`. Axes that mirror need mirrored = true, so that nobody mirrors by
/// mistake.
Result<void> read_axes(const Value& top, TableLayout& layout) {
  const Value* table = top.find({"axes"});
  if (table == nullptr) return {};
  // Signed numbers of axes, counted from 1, as in Axes.
  const Choices<int> signed_axes{{"x", 1}, {"y", 2}, {"z", 3}, {"-x", -1}, {"-y", -2}, {"-z", -3}};
  std::string x = "x", y = "y", z = "z";
  bool mirrored = false;
  KA_TRY(read_options(*table, {choice("x", signed_axes, x),
                               choice("y", signed_axes, y),
                               choice("z", signed_axes, z),
                               {"mirrored", "", &mirrored}}));
  // An axis that stands twice gives a determinant of 0, which both tests below refuse.
  layout.axes = {chosen(signed_axes, x), chosen(signed_axes, y), chosen(signed_axes, z)};
  if (mirrored && layout.kind == TableKind::imu) {
    return at(*table->find({"mirrored"}),
              {"", 0, "right-handed axes for nodes, because an orientation has no mirror image",
               "mirrored = true"});
  }
  if (determinant(layout.axes) == (mirrored ? -1 : 1)) return {};
  return at(*table, mirrored ? "axes that mirror" : "right-handed axes",
            determinant(layout.axes) == 0 ? "one axis twice"
            : mirrored                    ? "right-handed axes"
                                          : "a mirror image without mirrored = true");
}

/// Checks that columns are given in a form that the file allows, and computes the width of a row.
Result<void> check_columns(const Value& top, TableLayout& layout) {
  // Names can only be found in a line of names.
  if (layout.by_name && !layout.header) {
    return at(top, "a list of fields, because no line names the columns", "fields by name");
  }
  if (!layout.header && layout.time && layout.time->column.number == 0) {
    return at(*top.find({"time"}), "a column's number, because no line names the columns",
              shown(layout.time->column.name));
  }
  if (layout.by_name) return {};
  const std::size_t members = std::max<std::size_t>(layout.names.size(), 1);
  // The last column that a list of fields describes.
  const std::size_t last = layout.first_column + members * layout.fields.size() - 1;
  if (layout.first_column == 0 || (layout.columns != 0 && layout.columns < last)) {
    const Value* columns = top.find({"columns"});
    return at(
        columns != nullptr ? *columns : top,
        {"", 0, "at least " + std::to_string(last) + " columns", std::to_string(layout.columns)});
  }
  // The width of a row: without a line of names, only the layout can tell it.
  if (layout.columns == 0 && !layout.header) layout.columns = last;
  return {};
}

}  // namespace

Result<TableLayout> parse_layout(std::string_view toml, std::string_view name) {
  TableLayout layout;
  KA_TRY(read_toml(toml, name, [&](const Value& top) -> Result<void> {
    // The kind is read first, because later steps depend on it.
    for (const auto step :
         {read_top, read_time, read_members, read_state, read_axes, check_columns}) {
      KA_TRY(step(top, layout));
    }
    return {};
  }));
  return layout;
}

}  // namespace kinalign
