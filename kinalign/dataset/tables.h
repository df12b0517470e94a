// SPDX-License-Identifier: Apache-2.0
// The tables of the HFUT-MMD paper (README.md) for a data set, from its index.
#pragma once

#include "kinalign/dataset/index.h"
#include "kinalign/view/table.h"

#include <string>
#include <vector>

namespace kinalign {

/// Table 1: published data sets, with this one in the last row.
Result<Table> table_of_data_sets(const DatasetIndex& index);
/// Table 6: frames of each modality by sex and height, the smallest people first, with their ids.
Result<Table> table_by_subject(const DatasetIndex& index);
/// Table 7: frames of each modality by class.
Result<Table> table_by_class(const DatasetIndex& index);
/// The numbers of takes and frames for each combination of modalities that were recorded together.
Result<Table> table_by_modalities(const DatasetIndex& index);

}  // namespace kinalign
