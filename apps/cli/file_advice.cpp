// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/file_advice.h"

#include "kinalign/core/files.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace kinalign {

std::vector<std::string> file_advice(const Error& error) {
  // GNU ddrescue copies all readable sectors of a disk and skips the bad ones.
  if (error.kind == ErrorKind::unreadable_disk) {
    return {"ddrescue " + harmless(error.file) + " COPY/" + harmless(file_name(error.file)) +
            " copies all that the disk can read; use the copy, with copies of all other parts"};
  }
  if (error.kind != ErrorKind::directory) return {};
  std::vector<std::string> recordings;
  std::error_code fault;
  for (std::filesystem::directory_iterator file(error.file, fault), end; !fault && file != end;
       file.increment(fault)) {
    const std::string name = file->path().string();
    if (name.ends_with(".mcap")) recordings.push_back(name);
  }
  if (recordings.empty()) return {"name a file in this folder"};
  return {"name a file in this folder, such as " +
          harmless(*std::min_element(recordings.begin(), recordings.end()))};
}

}  // namespace kinalign
