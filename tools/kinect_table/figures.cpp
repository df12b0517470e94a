// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/figures.h"

#include "tools/kinect_table/marks.h"
#include "tools/kinect_table/residuals.h"

namespace kinalign {

Figures figures(const std::vector<Repetition>& pieces) {
  Figures out;
  put_marks(pieces, out);
  put_residuals(pieces, out);
  put_white(pieces, out);
  return out;
}

}  // namespace kinalign
