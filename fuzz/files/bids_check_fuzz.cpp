// SPDX-License-Identifier: Apache-2.0
// A data set as text: each line "=== PATH" begins a file. Whatever is in it, the check ends, and
// says the same of it again.
#include "fuzz/pieces.h"

#include "kinalign/formats/bids/check.h"

#include <map>
#include <string>

using namespace kinalign;

namespace {

std::map<std::string, std::string> files_of(std::string_view text) {
  std::map<std::string, std::string> out;
  std::string* file = nullptr;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.starts_with("=== ")) {
      file = &out[std::string(line.substr(4))];
    } else if (file != nullptr) {
      *file += std::string(line) + "\n";
    }
  }
  return out;
}

std::string said(const std::map<std::string, std::string>& files, std::size_t piece) {
  BidsListing listing;
  for (const auto& [path, text] : files) listing.paths.insert(path);
  listing.read = [&](const std::string& path, const FileSink& use) -> Result<void> {
    const std::string_view text = files.at(path);
    for (std::size_t at = 0; at < text.size(); at += piece) KA_TRY(use(text.substr(at, piece)));
    return {};
  };
  std::string all;
  for (const Finding& finding : check_bids(listing)) all += to_string(finding.what) + "\n";
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = files_of(text_of(data, size));
  if (said(files, 1'000'000) != said(files, 1 + size % 61)) std::abort();
  return 0;
}
