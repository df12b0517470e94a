// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/dataset/own_process.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/dataset/report/data_card.h"
#include "kinalign/dataset/report/dataset_figures.h"
#include "kinalign/dataset/report/take_pages.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/view/dataset_page/dataset_html.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>

namespace kinalign {

namespace {

/// The options of `kinalign dataset report`. --card and --pages exclude each other, since a card
/// has no links to pages.
struct Report {
  std::vector<std::string> folder;
  bool pages = false, card = false;
};

/// The command line of `kinalign dataset report`.
Usage describe_report(Report& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {
      {"pages", "also write the pages of takes that have no page or have changed", &o.pages},
      {"card", "write the data card, FOLDER/README.md, instead of the page", &o.card}};
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    const std::string& out = common.out;
    if (o.card && o.pages) {
      return Failure(Error{"--card", 0, "either --card or --pages", "both"});
    }
    if (o.card && !out.empty() && !out.ends_with(".md")) {
      return Failure(Error{"-o", 0, "the card's file name, as in -o README.md", shown(out)});
    }
    // -o may be missing, because the page and the card have default places in the data set.
    if (o.card || out.empty() || out.ends_with(".html") || out.ends_with(".htm")) return {};
    return Failure(Error{"-o", 0, "the page's file name, as in -o report.html", shown(out)});
  };
  return usage;
}

/// Writes a file. An existing file is replaced only if it contains `mark`, a text that only this
/// verb writes, or if --force was given. A README.md written by hand is therefore never lost.
Result<void> write_over_own(const std::string& path, std::string_view mark, const std::string& text,
                            Call& call) {
  FileSystem& files = call.surroundings.files;
  const bool is_own = is_there(path) && is_own_page(files, path, mark);
  KA_TRY(write_whole(files, path, text, is_own ? Overwrite::yes : call.common.overwrite()));
  call.console.wrote(path);
  return {};
}

// ---- the pages of takes

/// Makes a take's page with `kinalign report`. If the raw files have changed since the take was
/// built, the page has no raw samples. Several threads call this function. `report` forks, which a
/// thread must not do, so it runs as a separate process.
Result<void> make_page(const PageJob& job) {
  std::vector<std::string> words{"report", job.take,         "-o",      job.page, "--force",
                                 "--jobs", std::string("1"), "--color", "never"};
  Ended ended;
  // The first try includes the raw samples. If raw files are missing or have changed, the second
  // try leaves them out.
  if (!job.inputs.empty()) {
    std::vector<std::string> with_inputs = words;
    with_inputs.insert(with_inputs.end(), {"--inputs", job.inputs});
    ended = KA_TRY(run_own_process(with_inputs));
  }
  constexpr int most_findings = 1;  // 1: the page was written, and a stream is bad
  if (job.inputs.empty() || ended.code > most_findings) ended = KA_TRY(run_own_process(words));
  if (ended.code <= most_findings) return {};
  if (interrupted()) return Failure(interruption());
  // The first line on stderr is the error. The lines after it are advice.
  const std::string first = ended.complaint.substr(0, ended.complaint.find('\n'));
  return Failure(Error{job.take, 0, "a take that kinalign report can make a page of",
                       first.empty() ? fmt::format("exit code {}", ended.code) : first});
}

/// The folder of the takes' pages, named after the page without its ending: walks/report.html gives
/// walks/report/.
std::string place_of_pages(const std::string& out) { return out.substr(0, out.rfind('.')) + "/"; }

/// A folder's name for a relative link, percent-encoded. Only the characters that RFC 3986 calls
/// unreserved stay as they are.
std::string as_link(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.' || c == '~';
    out += plain ? std::string(1, c)
                 : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return out;
}

/// Links each take in the table to its own page, if that page shows the take as it is now.
Result<void> link_pages(const TakePages& pages, const DatasetIndex& index, const std::string& place,
                        DatasetPage& page) {
  // A page is current if it states the hash of the take's bytes. A page of an older take would show
  // other data.
  std::map<std::string, std::string> hashes;
  for (const auto& row : KA_TRY(index.select("select name, sha256 from takes")).rows) {
    hashes[std::get<std::string>(row.at(0))] = std::get<std::string>(row.at(1));
  }
  // The link is relative, so that the page and the folder can be moved together.
  const std::string folder =
      as_link(file_name(std::string_view(place).substr(0, place.size() - 1)));
  for (DatasetTake& take : page.worst) {
    const std::string file = pages.page_of(take.name, hashes[take.name]);
    if (file.empty()) continue;
    take.page.assign(folder).append("/").append(file);
    // A take with a link is no longer counted as a take without a page.
    --page.takes_without_page;
  }
  return {};
}

/// Makes the pages of those takes that are in the table of the data set's page. Other takes have no
/// row from which a link could lead to their page.
Result<PagesMade> make_pages(TakePages& pages, const DatasetIndex& index, const DatasetPage& page,
                             Call& call) {
  std::vector<std::string> names;
  for (const DatasetTake& take : page.worst) names.push_back(take.name);
  return pages.make(index, names, call.jobs, make_page, call.console.progress());
}

// ---- text and JSON

/// Prints what was written: the number of takes by verdict and the number of pages. Pages that
/// failed are listed; they do not stop the verb.
void print_written(const std::string& out, std::size_t bytes, const DatasetPage& page,
                   const std::optional<PagesMade>& pages, Call& call) {
  std::string text = fmt::format("{}: {}, {}: {} bad, {} usable, {} good\n", out, size_text(bytes),
                                 counted(page.takes, "take"), page.bad, page.usable, page.good);
  if (page.worst.size() < page.takes) {
    text += fmt::format("  its table has the {} worst\n", page.worst.size());
  }
  if (page.not_built > 0) {
    text += fmt::format("  {} not built: kinalign dataset build {}\n", page.not_built, page.folder);
  }
  nlohmann::ordered_json json{{"path", out},         {"bytes", bytes},
                              {"takes", page.takes}, {"shown", page.worst.size()},
                              {"bad", page.bad},     {"usable", page.usable},
                              {"good", page.good},   {"not_built", page.not_built}};
  if (pages) {
    text += fmt::format("  pages of takes: {} made, {} up to date", pages->made, pages->up_to_date);
    if (pages->removed > 0) text += fmt::format(", {} of removed takes deleted", pages->removed);
    text += "\n";
    json["pages"] = {{"made", pages->made},
                     {"up_to_date", pages->up_to_date},
                     {"removed", pages->removed},
                     {"failed", nlohmann::ordered_json::array()}};
    for (const Error& error : pages->failed) {
      text += "failed  " + to_string(error) + "\n";
      json["pages"]["failed"].push_back(to_string(error));
    }
  }
  call.console.print(harmless(text));
  call.console.print_json(json_text(json));
}

// ---- the verb

/// Writes the page of the data set; with --pages also the pages of its takes. The takes' pages are
/// made first, because the data set's page links to them.
Result<int> write_page(const std::string& folder, const DatasetIndex& index, bool with_pages,
                       Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string out = call.common.out.empty() ? folder + "/report.html" : call.common.out;
  DatasetPage page = KA_TRY(dataset_figures(index, folder));
  page.software = take_software();
  add_pictures(files, folder, page);
  const std::string place = place_of_pages(out);
  TakePages pages(files, folder, place, page.software);
  std::optional<PagesMade> made;
  if (with_pages) made = KA_TRY(make_pages(pages, index, page, call));
  // Links are also set without --pages, because pages of an earlier run may still be current.
  KA_TRY(link_pages(pages, index, place, page));
  const std::string html = dataset_html(page);
  KA_TRY(write_over_own(out, dataset_page_mark, html, call));
  print_written(out, html.size(), page, made, call);
  // The exit code is 1 if a summary could not be read or a page could not be made.
  return index.findings().empty() && (!made || made->failed.empty()) ? 0 : 1;
}

/// Writes the data card in Markdown, by default to the README.md of the data set.
Result<int> write_card(const std::string& folder, const DatasetIndex& index, Call& call) {
  const std::string out = call.common.out.empty() ? folder + "/README.md" : call.common.out;
  const std::string text =
      KA_TRY(data_card(call.surroundings.files, index, folder, out, take_software()));
  KA_TRY(write_over_own(out, data_card_mark, text, call));
  call.console.print(harmless(out) + ": the data card\n");
  call.console.print_json(json_text(nlohmann::ordered_json{{"path", out}, {"bytes", text.size()}}));
  return index.findings().empty() ? 0 : 1;
}

Result<int> run_report(Report& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  const DatasetIndex index = KA_TRY(open_index(folder, call));
  return o.card ? write_card(folder, index, call) : write_page(folder, index, o.pages, call);
}

}  // namespace

/// The verb `kinalign dataset report`.
Verb dataset_report_verb() {
  return make_verb<Report>(
      {.name = "dataset report",
       .summary = "a page for a data set, its takes' pages, and the data card",
       .text = "Writes FOLDER/report.html, one file that loads nothing: all takes, worst first, "
               "with pictures, filters and the paper's tables. --pages also writes the takes' "
               "pages below report/. --card writes README.md and keeps its text between <!-- own "
               "text --> and <!-- end -->. A file that this verb wrote before is replaced; any "
               "other file only with --force.",
       .examples = {{"kinalign dataset report walks", "writes walks/report.html"},
                    {"kinalign dataset report walks --pages",
                     "also walks/report/NAME.html, for takes that are new or changed"},
                    {"kinalign dataset report walks --card", "writes walks/README.md"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_report, run_report);
}

}  // namespace kinalign
