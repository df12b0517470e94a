// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/take_pages.h"

#include "kinalign/core/parallel.h"
#include "kinalign/dataset/build.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/take_inputs.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <mutex>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "kinalign.dataset_pages/1";
constexpr std::string_view ledger_name = "pages.json";
constexpr std::size_t longest_ledger = std::size_t{64} << 20;
constexpr std::size_t head_bytes = 4096;
// The ledger (pages.json) is written after this number of pages. If a run is stopped, at most this
// many pages are made again.
constexpr std::size_t pages_between_writes = 32;

/// Reads the ledger. If it can't be read, it counts as empty, and all pages are made again.
std::map<std::string, std::string> read_ledger(FileSystem& files, const std::string& path,
                                               const std::string& software) {
  std::map<std::string, std::string> out;
  const auto text = read_whole(files, path, longest_ledger);
  if (!text) return out;
  try {
    // If any part of the text is wrong, the ledger counts as empty.
    const Json json = Json::parse(*text);
    if (json.at("schema").get<std::string>() != schema) return out;
    // Another version of kinalign may write other pages, so all of them are made again.
    if (json.at("software").get<std::string>() != software) return out;
    for (const auto& [name, sha256] : json.at("pages").items()) {
      // The names become paths of files that may be removed, so only names of takes are accepted.
      if (parse_take_name(name)) out[name] = sha256.get<std::string>();
    }
  } catch (const Json::exception&) {
    // Entries before the fault are not used either.
    out.clear();
  }
  return out;
}

/// The folder with all raw files of a take, in which the names in the take are found.
std::string inputs_folder(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                          const TakeName& name) {
  const std::string base = folder_of(folder, name);
  const auto manifest = take_manifest(files, folder, catalogue, name);
  // A take that was added without raw files has no such folder.
  if (!manifest) return "";
  std::string out;
  for (const TakeInput& input : inputs_of(files, *manifest, base, {})) {
    if (!input.path.ends_with("/" + input.name)) return "";
    const std::string one = input.path.substr(0, input.path.size() - input.name.size());
    // If the inputs are in several folders, no single folder can be given.
    if (!out.empty() && one != out) return "";
    out = one;
  }
  return out;
}

/// The hashes of takes by the takes' names, from a table with these two columns.
std::map<std::string, std::string> hashes_of(const Table& table) {
  std::map<std::string, std::string> out;
  for (const auto& row : table.rows) {
    out[std::get<std::string>(row.at(0))] = std::get<std::string>(row.at(1));
  }
  return out;
}

}  // namespace

/// A page contains the mark near its beginning, so only the first block is read.
bool is_own_page(FileSystem& files, const std::string& path, std::string_view mark) {
  auto file = InputFile::open(files, path, head_bytes);
  if (!file) return false;
  const auto head = file->next();
  return head && head->find(mark) != std::string_view::npos;
}

TakePages::TakePages(FileSystem& files, std::string folder, std::string place, std::string software)
    : files_(files),
      folder_(std::move(folder)),
      place_(std::move(place)),
      software_(std::move(software)) {
  // Names of files are appended to this path below.
  if (!place_.ends_with('/')) place_ += '/';
  pages_ = read_ledger(files_, place_ + std::string(ledger_name), software_);
}

std::string TakePages::page_of(const std::string& name, const std::string& sha256) const {
  const auto known = pages_.find(name);
  // Equal hashes show that the page was made from the take's present bytes.
  const bool current = known != pages_.end() && known->second == sha256;
  return current && is_there(path_of_page(name)) ? name + ".html" : "";
}

/// Plans the pages that are missing or old. If a file with a page's name is not a page of kinalign,
/// this fails, and the file is not replaced.
Result<std::vector<PageJob>> TakePages::plan(const Catalogue& catalogue,
                                             const std::map<std::string, std::string>& hashes,
                                             const std::vector<std::string>& takes) const {
  std::vector<PageJob> jobs;
  for (const std::string& take : takes) {
    const auto name = parse_take_name(take);
    const auto hash = hashes.find(take);
    if (!name || hash == hashes.end() || !page_of(take, hash->second).empty()) continue;
    const std::string page = path_of_page(take);
    if (is_there(page) && !is_own_page(files_, page, "name=\"generator\" content=\"kinalign")) {
      return Failure(Error{page, 0, "a page that kinalign wrote, or no file", "another file"});
    }
    jobs.push_back({*name, path_of(folder_, *name, TakeFile::take), page,
                    inputs_folder(files_, folder_, catalogue, *name), hash->second});
  }
  return jobs;
}

/// Removes pages of takes that do not exist any more. Only pages in the ledger are removed, because
/// kinalign made these.
std::uint64_t TakePages::remove_old(const std::map<std::string, std::string>& known) {
  // The entry is removed from the ledger, even if the user has removed the page already.
  std::uint64_t removed = 0;
  std::erase_if(pages_, [&](const auto& page) {
    if (known.contains(page.first)) return false;
    removed += files_.remove(path_of_page(page.first).c_str()) == 0 ? 1 : 0;
    return true;
  });
  return removed;
}

/// Writes the ledger. It replaces the old one in one step, so it is never incomplete.
Result<void> TakePages::remember() const {
  const Json json{{"schema", schema}, {"software", software_}, {"pages", pages_}};
  OutputFile out =
      KA_TRY(OutputFile::create(files_, place_ + std::string(ledger_name), Overwrite::yes));
  KA_TRY(out.write(json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"));
  return out.commit();
}

Result<PagesMade> TakePages::make(const DatasetIndex& index, const std::vector<std::string>& takes,
                                  std::size_t jobs, const MakePage& make_page,
                                  const Progress& progress) {
  KA_TRY(make_folders(place_));
  const auto hashes = hashes_of(KA_TRY(index.select("select name, sha256 from takes")));
  const std::vector<PageJob> to_make = KA_TRY(plan(index.catalogue(), hashes, takes));
  PagesMade out;
  for (const std::string& take : takes) {
    const auto hash = hashes.find(take);
    out.up_to_date += hash != hashes.end() && !page_of(take, hash->second).empty() ? 1 : 0;
  }
  out.removed = remove_old(hashes);

  std::mutex mutex;
  std::uint64_t done = 0;
  bool stopped = false;
  parallel_for(to_make.size(), jobs, [&](std::size_t i) {
    // If the user has stopped the run, no further page is begun.
    if (std::lock_guard lock(mutex); stopped) return;
    const Result<void> made = make_page(to_make[i]);
    const std::lock_guard lock(mutex);
    stopped = stopped || !go_on(progress, "writing pages", ++done, to_make.size());
    if (!made) {
      if (!is_interruption(made.error())) out.failed.push_back(made.error());
      return;
    }
    pages_[to_string(to_make[i].name)] = to_make[i].sha256;
    // A failure does no harm here, because the ledger is written again at the end.
    if (++out.made % pages_between_writes == 0) (void)remember();
  });
  // If the run was stopped, the ledger is written, too, so that finished pages are kept.
  KA_TRY(remember());
  if (stopped) return Failure(interruption());
  // The threads finish pages in any order, so the failures are sorted.
  std::sort(out.failed.begin(), out.failed.end(),
            [](const Error& a, const Error& b) { return a.file < b.file; });
  return out;
}

}  // namespace kinalign
