// SPDX-License-Identifier: Apache-2.0
// Adds recordings, manifests and takes to a data set. Raw files stay in place or are copied below
// sourcedata/.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace kinalign {

/// One file to add, with the options of the user.
struct AddRequest {
  std::string path;             // a recording, a recording.toml or a take
  std::string subject, action;  // empty: those that the file states
  bool copy = false;            // copy raw files to sourcedata/sub-03/NAME/
  std::uint32_t run = 0;        // wanted run of a manifest, if free; 0: the next free one
};

/// The name of the added take. If the same take exists already, its name.
struct Added {
  TakeName name;
  bool was_there = false;  // the same manifest or take was added before
};

/// Adds takes to one data set. The existing takes of a subject and an action are read once, so
/// adding many takes costs little more than writing their manifests.
class TakeAdder {
 public:
  /// All three arguments must outlive this object.
  TakeAdder(FileSystem& files, const std::string& folder, const Catalogue& catalogue)
      : files_(files), folder_(folder), catalogue_(catalogue) {}

  /// Gives the take the next run of its subject and action and writes its manifest, or copies the
  /// take. Fails if the file is of another kind, or if dataset.toml lacks the subject or the
  /// action. Paths of files below the data set's folder become relative, others absolute.
  Result<Added> add(const AddRequest& request, const Progress& progress);
  /// Adds a take by a manifest that is not in a file. `base` ("" or ending in '/') is the folder to
  /// which its paths are relative; `request.path` names the manifest in messages.
  Result<Added> add(const Manifest& manifest, const std::string& base, const AddRequest& request);

 private:
  /// The existing takes of a subject and an action.
  struct Known {
    std::set<std::uint32_t> runs;
    /// The takes by their manifest's text, without the take's own name in it.
    std::multimap<std::string, TakeName> by_text;
  };
  Result<Known> read_known(const std::string& subject, const std::string& action) const;
  Result<Known*> known(const std::string& subject, const std::string& action);
  Result<std::optional<TakeName>> find_same(const Known& known, const Manifest& manifest,
                                            const std::string& text, bool copy) const;
  Result<Added> add_recording(const AddRequest& request, const Progress& progress);
  Result<Added> add_take(const AddRequest& request);

  FileSystem& files_;
  const std::string& folder_;
  const Catalogue& catalogue_;
  // An entry is filled when the first take of that person and action is added.
  std::map<std::pair<std::string, std::string>, Known> known_;  // by subject and action
};

}  // namespace kinalign
