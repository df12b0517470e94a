// SPDX-License-Identifier: Apache-2.0
// A corpus as an importer reads it: its takes with the corpus's own names, and the facts about it.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/import/source_files.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A take. Subject and action are the corpus's own words; ids.h makes ids from them.
struct CorpusTake {
  std::string subject, action;
  std::uint32_t run = 0;  // 0: the corpus does not number repetitions
  Manifest manifest;      // its paths can be opened without a folder before them
  std::string from;       // the take's name in the corpus, for messages
};

/// A stream of one raw file. If `layout` is empty, the file's content decides how it is read.
inline StreamOptions stream_of(const std::string& name, const std::string& path,
                               const std::string& layout = "") {
  StreamOptions out;
  out.name = name;
  out.files.push_back({path, ""});
  out.layout = layout;
  return out;
}

/// A part of the corpus that is not imported. Parts with the same reason are reported together.
struct LeftOut {
  std::string what, why;  // "m03_s03_e01", "without Vicon"
};

/// All facts that an importer finds. The licence and the citation go into a new dataset.toml, the
/// takes become manifests.
struct Corpus {
  std::string name, licence{}, citation{};
  std::vector<ActionClass> classes{};
  std::vector<Action> actions{};  // ids are words of the corpus; takes may have further actions
  std::string class_id{};         // class of those actions that `actions` lacks
  std::vector<CorpusTake> takes{};
  std::vector<LeftOut> left_out{};
};

/// The input of an importer.
struct ImportInput {
  FileSystem& files;
  const std::vector<SourceFile>& sources;  // sorted by name
  std::string raw_folder;       // the data set's sourcedata: packed corpora are unpacked there
  std::string subject, action;  // for files that do not state them; empty: not given
  const Progress& progress;
  std::size_t jobs = 1;  // threads to use
};

/// A kind of corpus.
struct CorpusKind {
  std::string_view name;      // for --from: "ui-prmd"
  std::string_view known_by;  // for messages: "m01_s01_e01_positions.txt, s01.npz"
  bool general = false;       // true: any folder of such files; a specific corpus has priority
  /// True if the file belongs to this kind. One such file is enough to recognise the corpus.
  bool (*is_own)(FileSystem& files, const SourceFile& file) = nullptr;
  Result<Corpus> (*list)(const ImportInput& input) = nullptr;
  bool unit_is_open = false;  // the files may have another unit and up axis than their format
};

}  // namespace kinalign
