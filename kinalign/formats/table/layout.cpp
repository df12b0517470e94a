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

// The fields of points come first, because of_points() depends on this order.
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

/// An option whose value is the name of one of the choices. The name is read as a text first, and
/// chosen() converts it afterwards.
template <class T>
Field choice(const char* key, const Choices<T>& choices, std::string& name) {
  Field field{key, "", &name};
  for (const auto& [known, value] : choices) field.choices.push_back(known);
  return field;
}
/// The choice of this name. read_options() has checked that the name is among the choices.
template <class T>
T chosen(const Choices<T>& choices, const std::string& name) {
  return std::find_if(choices.begin(), choices.end(),
                      [&](const auto& one) { return one.first == name; })
      ->second;
}

// The limits detect typing errors.
Field positive(const char* key, double& number) { return {key, "", &number, 1e-9, 1e9}; }
Field count(const char* key, std::int64_t& number) { return {key, "", &number, 0.0, 100'000.0}; }

/// Accepts a table without reading it. It is read when the kind of the layout is known.
Result<void> later(const Value&) { return {}; }

/// Reads the keys outside of tables. The functions below read [time], [joints] and the other
/// tables.
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
  // A name is needed for messages about the columns.
  if (!layout.name.empty()) return {};
  return at(top, "name, what the layout is called", "none");
}

/// Reads the table `time`. Without this table, the rows have the rate rate_hz.
Result<void> read_time(const Value& top, TableLayout& layout) {
  const Value* table = top.find({"time"});
  // Without the table `time`, the rows have the rate rate_hz.
  if (table == nullptr) return {};
  const Choices<std::int64_t> units{
      {"ns", 1}, {"us", 1000}, {"ms", 1'000'000}, {"s", 1'000'000'000}, {"ticks_100ns", 100}};
  const Choices<std::int64_t> epochs{{"unix", 0}, {"year_1", year_1_s}};
  std::string unit = "ns", epoch = "unix";
  // A whole number is the number of a column, and a text is its name.
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
  // The scale combines unit and epoch: stamp = number * unit + epoch.
  layout.time = TableTime{column, {chosen(units, unit), chosen(epochs, epoch)}};
  return {};
}

/// Adds a field if tables of this kind can have the field.
Result<void> add_field(const Value& fields, const std::string& name, const std::string& pattern,
                       TableLayout& layout) {
  const bool points = layout.kind == TableKind::points;
  for (const auto& [known, field] : field_names()) {
    // `skip` stands for a column that is not read. Tables of both kinds may have it.
    const bool fits = field == TableField::skip || of_points(field) == points;
    if (known != name || !fits) continue;
    layout.fields.push_back({field, pattern});
    return {};
  }
  return at(fields,
            points ? "fields x, y, z, state, skip" : "fields qw ... qz, ax ... az, gx ... gz, skip",
            shown(name));
}

/// Reads the fields. A table gives the names of the columns as patterns. A list gives the order of
/// the columns.
Result<void> read_fields(const Value& fields, TableLayout& layout) {
  layout.by_name = fields.is_table();
  std::map<std::string, std::string> patterns;
  std::vector<std::string> names;
  KA_TRY(set_option(layout.by_name ? Field{"fields", "", &patterns} : Field{"fields", "", &names},
                    fields));
  // Only one of the two lists has elements.
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
  // The field `skip` may occur often. Every other field has one column.
  for (const FieldColumn& one : layout.fields) {
    const auto same = [&](const FieldColumn& each) { return each.field == one.field; };
    if (one.field != skip && std::count_if(layout.fields.begin(), layout.fields.end(), same) > 1) {
      return at(fields, "each field once", "one twice");
    }
  }
  // Counts the complete quantities. At least one is needed.
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

/// Reads the table [joints] or [nodes].
Result<void> read_members(const Value& top, TableLayout& layout) {
  const std::string_view key = layout.kind == TableKind::points ? "joints" : "nodes";
  const Value* table = top.find({key});
  if (table == nullptr) return at(top, "a table [" + std::string(key) + "]", "none");
  // The names are optional for nodes, because a file may contain a single node.
  std::int64_t first_column = 1;
  KA_TRY(read_options(*table, {{"names", "", &layout.names}, count("first_column", first_column)},
                      {{"fields", later}}));
  layout.first_column = static_cast<std::size_t>(first_column);
  if (layout.names.empty() && (key == "joints" || table->find({"names"}) != nullptr)) {
    return at(*table, "names in [" + table->path + "]", "none");
  }
  const Value* fields = table->find({"fields"});
  // Without fields, the meaning of the columns is unknown.
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

/// Reads the table `axes`. Axes that mirror need mirrored = true, because mirroring is usually a
/// mistake.
Result<void> read_axes(const Value& top, TableLayout& layout) {
  const Value* table = top.find({"axes"});
  if (table == nullptr) return {};
  // The axes as numbers with signs, counted from 1, as in Axes.
  const Choices<int> signed_axes{{"x", 1}, {"y", 2}, {"z", 3}, {"-x", -1}, {"-y", -2}, {"-z", -3}};
  std::string x = "x", y = "y", z = "z";
  bool mirrored = false;
  KA_TRY(read_options(*table, {choice("x", signed_axes, x),
                               choice("y", signed_axes, y),
                               choice("z", signed_axes, z),
                               {"mirrored", "", &mirrored}}));
  // If an axis occurs twice, the determinant is 0, and both tests below refuse it.
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

/// Checks that the columns are given in a way that fits the file, and computes the number of cells
/// in a row.
Result<void> check_columns(const Value& top, TableLayout& layout) {
  // Columns can be found by name only if a line contains the names.
  if (layout.by_name && !layout.header) {
    return at(top, "a list of fields, because no line names the columns", "fields by name");
  }
  if (!layout.header && layout.time && layout.time->column.number == 0) {
    return at(*top.find({"time"}), "a column's number, because no line names the columns",
              shown(layout.time->column.name));
  }
  if (layout.by_name) return {};
  const std::size_t members = std::max<std::size_t>(layout.names.size(), 1);
  // The last column that the list of fields describes.
  const std::size_t last = layout.first_column + members * layout.fields.size() - 1;
  if (layout.first_column == 0 || (layout.columns != 0 && layout.columns < last)) {
    const Value* columns = top.find({"columns"});
    return at(
        columns != nullptr ? *columns : top,
        {"", 0, "at least " + std::to_string(last) + " columns", std::to_string(layout.columns)});
  }
  // Without a line of names, the width of a row follows from the layout.
  if (layout.columns == 0 && !layout.header) layout.columns = last;
  return {};
}

}  // namespace

Result<TableLayout> parse_layout(std::string_view toml, std::string_view name) {
  TableLayout layout;
  KA_TRY(read_toml(toml, name, [&](const Value& top) -> Result<void> {
    // The kind is read first, because the other tables depend on it.
    for (const auto step :
         {read_top, read_time, read_members, read_state, read_axes, check_columns}) {
      KA_TRY(step(top, layout));
    }
    return {};
  }));
  return layout;
}

}  // namespace kinalign
