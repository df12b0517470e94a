// SPDX-License-Identifier: Apache-2.0
// Rows do not depend on the pieces in which a file is read, and a file that was read can be written
// and read again with the same states.
#include "fuzz/pieces.h"

#include "kinalign/formats/c3d/c3d.h"

#include <string>

using namespace kinalign;

namespace {

bool same_when_written(const PointHeader& header, const PointFrames& rows) {
  std::string bytes;
  auto writer = C3dWriter::begin({header.joint_names, 100.0, rows.size()},
                                 [&bytes](std::string_view more) -> Result<void> {
                                   bytes += more;
                                   return {};
                                 });
  if (!writer) return true;  // a name or the names are too long
  PointFrames even = rows;
  for (std::size_t t = 0; t < even.size(); ++t) {
    even.stamps[t] = utc_time(10'000'000 * static_cast<std::int64_t>(t));
  }
  if (!writer->append(even) || !writer->finish()) return false;
  const auto read = read_all(make_c3d_reader({}, "again"), bytes);
  return read.error.empty() && read.rows.state == rows.state;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  (void)looks_like_c3d(text);
  check_pieces([] { return make_c3d_reader({}, "f"); }, text);
  const auto read = read_all(make_c3d_reader({}, "f"), text);
  if (read.error.empty() && !same_when_written(read.header, read.rows)) std::abort();
  return 0;
}
