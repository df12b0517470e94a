// SPDX-License-Identifier: Apache-2.0
// Reads any table that a layout declares (formats/table/layout.h, docs/formats/layouts.md).
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/formats/table/layout.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// A reader of points; the layout's kind must be points. `file` appears in messages. Of `options`
/// select, metres_per_unit, up, rate_hz and start_ns are used.
/// Rows keep the file's stamps, repeated and backward ones too. A row of the wrong shape fails, a
/// last line without a line end is dropped with a finding; empty and "nan" cells are missing
/// joints.
std::unique_ptr<PointReader> make_point_table_reader(const TableLayout& layout,
                                                     const StreamOptions& options,
                                                     std::string_view file);

/// A reader of nodes; the layout's kind must be imu. Where the layout names no nodes, there is one,
/// called `node` or, where that is empty, as the file without folder and ending.
std::unique_ptr<ImuReader> make_imu_table_reader(const TableLayout& layout,
                                                 const StreamOptions& options,
                                                 std::string_view file, std::string_view node);

/// The beginning of a file (some 4 KiB) looks as the layout says.
bool matches(const TableLayout& layout, std::string_view head);

/// Its line of names does, whatever the rows below it hold.
bool knows_columns(const TableLayout& layout, std::string_view head);

}  // namespace kinalign
