// SPDX-License-Identifier: Apache-2.0
// The paper's tables of a data set, from its index.
#pragma once

#include "kinalign/dataset/index.h"
#include "kinalign/view/table.h"

#include <string>
#include <vector>

namespace kinalign {

/// Table 1: published data sets, and this one in the last row.
Result<Table> table_of_data_sets(const DatasetIndex& index);
/// Table 6: frames of each modality by sex and height, smallest first, with the people's ids.
Result<Table> table_by_subject(const DatasetIndex& index);
/// Table 7: frames of each modality by class.
Result<Table> table_by_class(const DatasetIndex& index);
/// How many takes and frames have which modalities together: pairs and triples.
Result<Table> table_by_modalities(const DatasetIndex& index);

}  // namespace kinalign
