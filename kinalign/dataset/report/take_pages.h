// SPDX-License-Identifier: Apache-2.0
// The pages of takes, in a folder for the data set's page: which pages exist and which have to be
// made. A file pages.json states, for each page, the hash of the take from which it was made.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/index.h"
#include "kinalign/dataset/take_name.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// One page to make. The paths can be opened as they are.
struct PageJob {
  TakeName name;
  std::string take, page;  // paths
  std::string inputs;      // folder of the take's raw files; empty: not known
  std::string sha256;      // SHA-256 of the take
};

/// Makes one page. Called from several threads at once.
using MakePage = std::function<Result<void>(const PageJob&)>;

/// The outcome; failed pages are made again by the next run.
struct PagesMade {
  std::uint64_t made = 0, up_to_date = 0, removed = 0;
  std::vector<Error> failed;
};

/// The pages in one folder, with their list pages.json, called the ledger. A page is up to date if
/// the ledger has the take's present hash and the page exists. Pages that another version of
/// kinalign made count as missing.
class TakePages {
 public:
  /// `folder`: the data set's folder. `place`: the folder of the pages, which may not exist yet.
  TakePages(FileSystem& files, std::string folder, std::string place, std::string software);

  /// "NAME.html" if this version has made the page from a take with this hash; else empty.
  std::string page_of(const std::string& name, const std::string& sha256) const;

  /// Makes the missing and old pages of `takes`, and removes pages of takes that the index lacks. A
  /// page that fails does not stop others. Fails if the user stops the run, or if a file with a
  /// page's name is not a page of kinalign.
  Result<PagesMade> make(const DatasetIndex& index, const std::vector<std::string>& takes,
                         std::size_t jobs, const MakePage& make_page, const Progress& progress);

 private:
  Result<std::vector<PageJob>> plan(const Catalogue& catalogue,
                                    const std::map<std::string, std::string>& hashes,
                                    const std::vector<std::string>& takes) const;
  std::uint64_t remove_old(const std::map<std::string, std::string>& known);
  Result<void> remember() const;
  std::string path_of_page(const std::string& name) const { return place_ + name + ".html"; }

  FileSystem& files_;
  std::string folder_, place_, software_;
  std::map<std::string, std::string> pages_;  // take's name -> SHA-256 of the take
};

/// True if the first 4096 bytes of the file contain `mark`, which shows that kinalign wrote the
/// file.
bool is_own_page(FileSystem& files, const std::string& path, std::string_view mark);

}  // namespace kinalign
