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
// The ledger is written after this number of pages: a stopped run loses at most as many.
constexpr std::size_t pages_between_writes = 32;

/// A ledger that can't be read counts as empty: its pages are made again.
std::map<std::string, std::string> read_ledger(FileSystem& files, const std::string& path,
                                               const std::string& software) {
  std::map<std::string, std::string> out;
  const auto text = read_whole(files, path, longest_ledger);
  if (!text) return out;
  try {
    // Any fault of the text makes the ledger count as empty.
    const Json json = Json::parse(*text);
    if (json.at("schema").get<std::string>() != schema) return out;
    // Another version may write other pages, so all of them are made again.
    if (json.at("software").get<std::string>() != software) return out;
    for (const auto& [name, sha256] : json.at("pages").items()) {
      // The names become paths that may be removed, so other texts are not accepted.
      if (parse_take_name(name)) out[name] = sha256.get<std::string>();
    }
  } catch (const Json::exception&) {
    // Pages that were read before the fault are not trusted either.
    out.clear();
  }
  return out;
}

/// The folder from which the names in the take lead to all of its raw files.
std::string inputs_folder(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                          const TakeName& name) {
  const std::string base = folder_of(folder, name);
  const auto manifest = take_manifest(files, folder, catalogue, name);
  // A take that was added as a take has no raw files.
  if (!manifest) return "";
  std::string out;
  for (const TakeInput& input : inputs_of(files, *manifest, base, {})) {
    if (!input.path.ends_with("/" + input.name)) return "";
    const std::string one = input.path.substr(0, input.path.size() - input.name.size());
    // Inputs in several folders can't be given by one folder.
    if (!out.empty() && one != out) return "";
    out = one;
  }
  return out;
}

/// The hashes of all takes by their names, from a table of these two columns.
std::map<std::string, std::string> hashes_of(const Table& table) {
  std::map<std::string, std::string> out;
  for (const auto& row : table.rows) {
    out[std::get<std::string>(row.at(0))] = std::get<std::string>(row.at(1));
  }
  return out;
}

}  // namespace

/// A page states its generator near its beginning, so the first block is enough.
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
  // File names are appended to the folder's path below.
  if (!place_.ends_with('/')) place_ += '/';
  pages_ = read_ledger(files_, place_ + std::string(ledger_name), software_);
}

std::string TakePages::page_of(const std::string& name, const std::string& sha256) const {
  const auto known = pages_.find(name);
  // The hash proves that the page shows the take's present bytes.
  const bool current = known != pages_.end() && known->second == sha256;
  return current && is_there(path_of_page(name)) ? name + ".html" : "";
}

/// The pages that are missing or old. A file that is no page of kinalign is never replaced.
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

/// Only pages of the ledger are removed: kinalign made these and no others.
std::uint64_t TakePages::remove_old(const std::map<std::string, std::string>& known) {
  // Entries leave the ledger even if their file was removed by hand.
  std::uint64_t removed = 0;
  std::erase_if(pages_, [&](const auto& page) {
    if (known.contains(page.first)) return false;
    removed += files_.remove(path_of_page(page.first).c_str()) == 0 ? 1 : 0;
    return true;
  });
  return removed;
}

/// The ledger replaces the old one in one step, so it is never half written.
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
    // After the user stopped the run, no further page is begun.
    if (std::lock_guard lock(mutex); stopped) return;
    const Result<void> made = make_page(to_make[i]);
    const std::lock_guard lock(mutex);
    stopped = stopped || !go_on(progress, "writing pages", ++done, to_make.size());
    if (!made) {
      if (!is_interruption(made.error())) out.failed.push_back(made.error());
      return;
    }
    pages_[to_string(to_make[i].name)] = to_make[i].sha256;
    // A failure here is no loss: the ledger is written again at the end.
    if (++out.made % pages_between_writes == 0) (void)remember();
  });
  // The ledger is written after a stop, too, so that finished pages are kept.
  KA_TRY(remember());
  if (stopped) return Failure(interruption());
  // Pages end in the order of the threads; the report must not depend on it.
  std::sort(out.failed.begin(), out.failed.end(),
            [](const Error& a, const Error& b) { return a.file < b.file; });
  return out;
}

}  // namespace kinalign
