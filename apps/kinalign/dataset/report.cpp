// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/dataset/report/dataset_figures.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/view/dataset_page/dataset_html.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace kinalign {

namespace {

struct Report {
  std::vector<std::string> folder;
};

Usage describe_report(Report& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  return usage;
}

Result<int> run_report(Report& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string folder = folder_of(o.folder);
  const std::string out = call.common.out.empty() ? folder + "/report.html" : call.common.out;
  const DatasetIndex index = KA_TRY(open_index(folder, call));
  DatasetPage page = KA_TRY(dataset_figures(index, folder));
  page.software = take_software();
  add_pictures(files, folder, page);
  const std::string html = dataset_html(page);
  OutputFile file = KA_TRY(OutputFile::create(files, out, Overwrite::yes));
  KA_TRY(file.write(html));
  KA_TRY(file.commit());
  call.console.wrote(out);
  return index.findings().empty() ? 0 : 1;
}

}  // namespace

Verb dataset_report_verb() {
  return make_verb<Report>(
      {.name = "dataset report",
       .summary = "a page for a data set",
       .text = "",
       .examples = {{"kinalign dataset report walks", "writes walks/report.html"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_report, run_report);
}

}  // namespace kinalign
