// SPDX-License-Identifier: Apache-2.0
// Reads any table that a layout declares (formats/table/layout.h, docs/formats/layouts.md).
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/formats/table/layout.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// A reader of points; the layout's kind must be points. `file` appears in messages. Uses the
/// options select, metres_per_unit, up, rate_hz and start_ns. Rows keep the file's stamps, also
/// repeated and falling ones. A row with a wrong number of cells fails. A last line without a line
/// end that can't be read is dropped, with a finding. Joints with empty or "nan" cells are missing.
std::unique_ptr<PointReader> make_point_table_reader(const TableLayout& layout,
                                                     const StreamOptions& options,
                                                     std::string_view file);

/// A reader of nodes; the layout's kind must be imu. If the layout names no nodes, there is one
/// node with the name `node`. If that is empty, its name is the file's without folder and
/// extension.
std::unique_ptr<ImuReader> make_imu_table_reader(const TableLayout& layout,
                                                 const StreamOptions& options,
                                                 std::string_view file, std::string_view node);

/// True if the beginning of a file (some 4 KiB) can be read with the layout.
bool matches(const TableLayout& layout, std::string_view head);

/// True if the line of column names fits the layout, whatever the rows hold.
bool knows_columns(const TableLayout& layout, std::string_view head);

}  // namespace kinalign
