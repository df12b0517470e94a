// SPDX-License-Identifier: Apache-2.0
// The known kinds of corpora. A new kind needs its own file, a line here and a line in corpora.cpp.
#pragma once

#include "kinalign/dataset/import/corpus.h"

#include <string>
#include <vector>

namespace kinalign {

CorpusKind bids_corpus();
CorpusKind cmu_corpus();
CorpusKind keraal_corpus();
CorpusKind kinect_multitrack_corpus();
CorpusKind ntu_corpus();
CorpusKind ui_prmd_corpus();
CorpusKind ui_prmd_joints_corpus();
std::vector<CorpusKind> motion_file_corpora();  // bvh, c3d, mvnx, trc

/// All kinds, the specific ones first.
std::vector<CorpusKind> corpus_kinds();
std::vector<std::string> corpus_kind_names();

/// The kind with that name. If the name is empty, the kind to which the files belong. Fails if
/// there is none, or several; the error lists the known kinds.
Result<CorpusKind> find_corpus(FileSystem& files, const std::vector<SourceFile>& sources,
                               const std::string& wanted, const std::string& source);

}  // namespace kinalign
