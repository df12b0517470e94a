// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/csv_write.h"

#include "kinalign/core/text_out.h"
#include "kinalign/formats/take/take_layout.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// A text as a CSV cell (RFC 4180). If it contains a comma, a quote or a line end, it is quoted.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

/// The head line of the CSV, with one name for each number of a row. A column with a single number
/// per row has only its own name.
std::string head_of(const TakeGroup& group, Precision precision) {
  std::string out = "time_ns";
  for (const TakeColumn& column : columns_of(group, precision)) {
    for (const std::string& label : labels_of(column, group)) {
      out += "," + quoted(column.name + (label == "row" ? "" : "." + label));
    }
  }
  return out;
}

/// The numbers of one row of an array, in the shortest form that can be read back exactly.
template <class Value>
void put_row(const std::vector<Value>& values, std::size_t row, std::size_t rows,
             Precision precision, std::string& text) {
  // If the stream has no values for an array, its width is 0 and nothing is added.
  const std::size_t width = values.size() / rows;
  for (std::size_t k = row * width; k < (row + 1) * width; ++k) {
    text += ',';
    // Flags, states and times are whole numbers, also those of one byte.
    if constexpr (!std::is_same_v<Value, double>) {
      fmt::format_to(std::back_inserter(text), "{}", static_cast<std::int64_t>(values[k]));
    } else if (precision == Precision::full) {
      fmt::format_to(std::back_inserter(text), "{}", values[k]);
    } else {
      fmt::format_to(std::back_inserter(text), "{}", static_cast<float>(values[k]));
    }
  }
}

/// Writes the rows of one group as lines.
Result<void> put_slab(const TakeSlab& slab, std::size_t group, Precision precision, TextOut& out) {
  std::string text;
  for (std::size_t row = 0; row < slab.stamps.size(); ++row) {
    // A line is built in memory and written as a whole.
    text = std::to_string(slab.stamps[row].time_since_epoch().count());
    const auto use = [&](std::string_view, const auto& values) -> Result<void> {
      put_row(values, row, slab.stamps.size(), precision, text);
      return {};
    };
    KA_TRY(std::visit([&](const auto& rows) { return for_each_row_array(rows, use); },
                      slab.rows[group]));
    out.text(text);
    KA_TRY(out.end_line());
  }
  return {};
}

}  // namespace

/// Only one slab is in memory at a time. The file gets its final name when it is complete.
Result<void> write_stream_csv(ExportedTake& take, std::size_t group, FileSystem& files,
                              const std::string& path) {
  // Numbers that the take stores as floats have no more digits than a float.
  const Precision precision = precision_of(take.header());
  TextOut out = KA_TRY(TextOut::create(files, path, Overwrite::no));
  out.text(head_of(take.header().groups[group], precision));
  KA_TRY(out.end_line());
  KA_TRY(take.rows([&](const TakeSlab& slab) { return put_slab(slab, group, precision, out); }));
  return out.commit();
}

/// The facts of all streams as JSON, with the unit of each array.
std::string streams_json(const TakeHeader& header) {
  Json out{{"subject", header.subject}, {"action", header.action}, {"frames", header.frames}};
  for (const TakeGroup& group : header.groups) {
    // The same facts as in a take's file, with the units of the arrays added.
    Json stream = Json::parse(stream_json(group));
    for (const TakeColumn& column : columns_of(group, precision_of(header))) {
      Json& array = stream["arrays"][column.name] = Json::object();
      for (const auto& [key, text] : column.facts) array[key] = text;
    }
    out["streams"].push_back(std::move(stream));
  }
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<void> write_streams_json(ExportedTake& take, FileSystem& files, const std::string& path) {
  return write_whole(files, path, streams_json(take.header()), Overwrite::no);
}

}  // namespace kinalign
