// SPDX-License-Identifier: Apache-2.0
// Reads any table that a layout declares (formats/table/layout.h, docs/formats/layouts.md).
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/formats/table/layout.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Makes a reader of points. The kind of the layout must be points. `file` appears in messages. The
/// reader uses the options select, metres_per_unit, up, rate_hz and start_ns. Rows keep the file's
/// stamps, even if stamps repeat or fall. A row with a wrong number of cells is an error. If the
/// last line has no line end and can't be read, it is dropped with a finding. Joints with empty or
/// "nan" cells are missing.
std::unique_ptr<PointReader> make_point_table_reader(const TableLayout& layout,
                                                     const StreamOptions& options,
                                                     std::string_view file);

/// Makes a reader of inertial nodes. The kind of the layout must be imu. If the layout names no
/// nodes, there is a single node with the name `node`. If `node` is empty, too, its name is the
/// file's name without folder and extension.
std::unique_ptr<ImuReader> make_imu_table_reader(const TableLayout& layout,
                                                 const StreamOptions& options,
                                                 std::string_view file, std::string_view node);

/// True if the beginning of a file (about 4 KiB) can be read with the layout.
bool matches(const TableLayout& layout, std::string_view head);

/// True if the line of column names fits the layout. The rows do not matter.
bool knows_columns(const TableLayout& layout, std::string_view head);

}  // namespace kinalign
