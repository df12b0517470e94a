// SPDX-License-Identifier: Apache-2.0
// The kinds of corpora that are known. A new one: its file, a line here, a line in corpora.cpp.
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

std::vector<CorpusKind> corpus_kinds();
std::vector<std::string> corpus_kind_names();

/// The kind of that name or, where it is empty, the one that the files are of. Fails where there is
/// none, or several, with those that are known.
Result<CorpusKind> find_corpus(FileSystem& files, const std::vector<SourceFile>& sources,
                               const std::string& wanted, const std::string& source);

}  // namespace kinalign
