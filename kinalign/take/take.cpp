// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/row_arrays.h"

#include <type_traits>

namespace kinalign {

bool has_gravity(const ImuGroup& group, std::size_t node) {
  // Gravity is the same vector for all nodes, so subtracting the root's acceleration removes
  // gravity.
  const bool differs = !group.root_node.empty() && group.node_names[node] != group.root_node;
  return group.content.gravity && !differs;
}

void append_rows(TakeSlab& all, const TakeSlab& slab) {
  const auto join = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  join(all.stamps, slab.stamps);
  // The first slab sets the kinds of the groups.
  if (all.rows.empty()) {
    all.rows = slab.rows;
    return;
  }
  for (std::size_t g = 0; g < all.rows.size(); ++g) {
    std::visit(
        [&](auto& to) {
          const auto& from = std::get<std::remove_reference_t<decltype(to)>>(slab.rows[g]);
          for_each_column<std::remove_reference_t<decltype(to)>>(
              [&](const char*, auto of) { join(of(to), of(from)); });
          // for_each_column() visits only the stored arrays.
          join(to.distance.over_loss, from.distance.over_loss);
        },
        all.rows[g]);
  }
}

}  // namespace kinalign
