// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/listing.h"

#include <filesystem>

namespace kinalign {

Result<BidsListing> list_bids_folder(FileSystem& files, const std::string& folder) {
  namespace fs = std::filesystem;
  BidsListing listing;
  std::error_code failed;
  // Links to folders are not followed by default, so a loop of links can't occur.
  for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    if (at->is_regular_file(failed)) {
      listing.paths.insert(at->path().lexically_relative(folder).generic_string());
    }
  }
  if (failed) return Failure(Error{folder, 0, "a folder that can be read", failed.message()});
  // `folder` is copied, because the listing lives longer than the call.
  listing.read = [&files, folder](const std::string& path, const FileSink& use) -> Result<void> {
    InputFile file = KA_TRY(InputFile::open(files, folder + "/" + path));
    for (auto piece = KA_TRY(file.next()); !piece.empty(); piece = KA_TRY(file.next())) {
      KA_TRY(use(piece));
    }
    return {};
  };
  return listing;
}

}  // namespace kinalign
