// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/dataset_figures.h"

#include "kinalign/dataset/report/take_pictures.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/tables.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

/// The next functions return the value of a cell. Without a value they return 0, nothing or an
/// empty text.
std::int64_t whole(const Cell& cell) {
  const auto* value = std::get_if<std::int64_t>(&cell);
  return value == nullptr ? 0 : *value;
}

/// A count from a cell. Counts are never negative; a damaged index gives 0.
std::uint64_t count(const Cell& cell) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, whole(cell)));
}

std::optional<double> number(const Cell& cell) {
  const auto* value = std::get_if<double>(&cell);
  return value == nullptr ? std::nullopt : std::optional(*value);
}

std::string text(const Cell& cell) {
  const auto* value = std::get_if<std::string>(&cell);
  return value == nullptr ? std::string() : *value;
}

// The worst takes come first. A missing measure sorts as if it were good.
constexpr const char* worst_first =
    "select name, subject, class, action, action_name, verdict, worst, frames, seconds, mocap, "
    "kinect, imu, residual_cm, kinect_valid, imu_valid from takes order by "
    "case verdict when 'bad' then 0 when 'usable' then 1 else 2 end, errors desc, warnings desc, "
    "coalesce(residual_cm, 0) desc, min(coalesce(kinect_valid, 1), coalesce(imu_valid, 1)), name "
    "limit ?";

/// The take in a row, whose cells are in the order of the query.
DatasetTake take_of(const std::vector<Cell>& row) {
  DatasetTake take;
  // These are the first seven columns of the query.
  const std::array<std::string*, 7> texts{&take.name,   &take.subject,     &take.class_id,
                                          &take.action, &take.action_name, &take.verdict,
                                          &take.reason};
  for (std::size_t i = 0; i < texts.size(); ++i) *texts[i] = text(row[i]);
  take.frames = count(row[7]);
  take.seconds = number(row[8]).value_or(0.0);
  take.has_mocap = whole(row[9]) > 0;
  take.has_kinect = whole(row[10]) > 0;
  take.has_imu = whole(row[11]) > 0;
  take.residual_cm = number(row[12]);
  take.kinect_valid = number(row[13]);
  take.imu_valid = number(row[14]);
  return take;
}

/// The sums over all takes.
Result<void> add_sums(const DatasetIndex& index, DatasetPage& page) {
  const Table sums = KA_TRY(
      index.select("select count(*), count(distinct subject), coalesce(sum(mocap), 0), "
                   "coalesce(sum(kinect), 0), "
                   "coalesce(sum(imu), 0), coalesce(sum(verdict = 'good'), 0), "
                   "coalesce(sum(verdict = 'usable'), 0), coalesce(sum(verdict = 'bad'), 0), "
                   "coalesce(sum(seconds), 0.0) from takes"));
  const std::vector<Cell>& row = sums.rows.at(0);
  // These are the first eight columns of the query.
  const std::array<std::uint64_t*, 8> counts{
      &page.takes,      &page.people, &page.mocap_frames, &page.kinect_frames,
      &page.imu_frames, &page.good,   &page.usable,       &page.bad};
  for (std::size_t i = 0; i < counts.size(); ++i) *counts[i] = count(row[i]);
  page.seconds = number(row[counts.size()]).value_or(0.0);
  return {};
}

}  // namespace

Result<DatasetPage> dataset_figures(const DatasetIndex& index, const std::string& folder,
                                    std::size_t most) {
  DatasetPage page;
  const Catalogue& catalogue = index.catalogue();
  page.name = catalogue.name.empty() ? std::string(file_name(folder)) : catalogue.name;
  page.licence = catalogue.licence;
  page.contact = catalogue.contact;
  page.description = catalogue.description;
  page.citation = catalogue.citation;
  page.folder = folder;
  KA_TRY(add_sums(index, page));
  // The query limits the number of rows, so the index does not return all takes.
  const Table rows = KA_TRY(index.select(worst_first, {static_cast<std::int64_t>(most)}));
  for (const auto& row : rows.rows) page.worst.push_back(take_of(row));
  // Here every take counts as one without a page. The caller subtracts those that have a page.
  page.takes_without_page = page.worst.size();
  for (auto* const table : {table_by_subject, table_by_class, table_by_modalities}) {
    page.tables.push_back(KA_TRY(table(index)));
  }
  for (const auto& [name, there] : KA_TRY(scan_takes(folder))) {
    // The index has only takes with a summary, so the others are counted in the folder.
    page.not_built += there.manifest && !there.summary ? 1 : 0;
  }
  return page;
}

void add_pictures(FileSystem& files, const std::string& folder, DatasetPage& page) {
  std::vector<TakeName> names;
  // The pointers point into the page, whose list of takes does not change meanwhile.
  std::vector<DatasetTake*> takes;
  for (DatasetTake& take : page.worst) {
    const auto name = parse_take_name(take.name);
    if (!name) continue;
    names.push_back(*name);
    takes.push_back(&take);
  }
  // All takes are opened together, so few child processes are needed.
  auto rows = typical_rows(files, folder, names);
  for (std::size_t i = 0; i < takes.size(); ++i) takes[i]->bodies = std::move(rows[i]);
}

}  // namespace kinalign
