// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/index.h"

#include "kinalign/core/file_version.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/sqlite.h"
#include "kinalign/dataset/take_summary.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_toml = std::size_t{16} << 20;
/// If two changes of a folder are closer than this, the folder's date may be the same.
constexpr std::int64_t racy_ns = 2'000'000'000;

/// Incremented with every change of the tables. An index with another number is made again.
constexpr std::int64_t layout = 2;

/// In the view, columns of other tables are subqueries. SQLite runs a subquery only if a statement
/// uses its column, whereas it would execute every join even for a sum.
constexpr const char* make_tables = R"(
create table catalogue(version text not null);
create table folder(path text primary key, changed_ns integer not null, not_built integer not null);
create table subject(id text primary key, sex text, height_cm real, weight_kg real, handedness text);
create table class(id text primary key, name text);
create table action(id text primary key, class text, name text);
create table take(
  id integer primary key, name text not null unique, subject text not null, class text,
  action text not null, run integer not null, frames integer not null, seconds real,
  rate_hz real, mocap integer not null, kinect integer not null, imu integer not null,
  verdict text not null, errors integer, warnings integer, residual_cm real, kinect_valid real,
  imu_valid real, inferred real, gap_s real, kinect_ms real, imu_ms real, begin_ns integer,
  bytes integer);
create table detail(id integer primary key, folder text not null, changed_ns integer, size integer,
  worst text, software text, recipe text, sha256 text);
create table stream(take integer not null, name text, modality text, columns integer, valid real,
  inferred real, gaps integer, gap_s real, interval_ms real, nodes text);
create index take_by_action on take(subject, class, action);
create index take_by_subject on take(subject, frames, mocap, kinect, imu);
create index take_by_class on take(class, frames, mocap, kinect, imu);
create index take_by_verdict on take(verdict, frames);
create index stream_by_take on stream(take);
create view takes as select name, subject, (select sex from subject where id = take.subject) as sex,
  (select height_cm from subject where id = take.subject) as height_cm, class,
  (select name from class where id = take.class) as class_name, action,
  (select name from action where id = take.action) as action_name, run, frames, seconds, rate_hz,
  mocap, kinect, imu, verdict, errors, warnings, residual_cm, kinect_valid, imu_valid, inferred,
  gap_s, kinect_ms, imu_ms, begin_ns, bytes,
  (select weight_kg from subject where id = take.subject) as weight_kg,
  (select handedness from subject where id = take.subject) as handedness,
  (select worst from detail where id = take.id) as worst,
  (select software from detail where id = take.id) as software,
  (select recipe from detail where id = take.id) as recipe,
  (select sha256 from detail where id = take.id) as sha256 from take;
create view streams as select take.name as take, stream.name, modality, columns, valid,
  stream.inferred, gaps, stream.gap_s, interval_ms, nodes from stream join take on take.id = stream.take;
)";

/// The time of day, ns UTC. It is only compared with the dates of files.
std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::int64_t whole(std::uint64_t value) { return static_cast<std::int64_t>(value); }

Cell maybe(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

/// The time of the last change in a folder, ns; -1 if it does not exist.
std::int64_t changed_ns(const std::string& folder) {
  struct stat facts {};
  if (::stat(folder.c_str(), &facts) != 0) return -1;
  return facts.st_mtim.tv_sec * 1'000'000'000 + facts.st_mtim.tv_nsec;
}

/// One value for all streams of one modality, for a column of the view `takes`.
template <class Value, class Fold>
std::optional<double> over(const TakeSummary& take, Modality modality, Value value, Fold fold) {
  std::optional<double> out;
  for (const StreamSummary& stream : take.streams) {
    if (stream.modality != modality) continue;
    const std::optional<double> one = value(stream);
    if (one) out = out ? fold(*out, *one) : *one;
  }
  return out;
}

/// The least share of valid samples of all streams of the modality.
std::optional<double> least_valid(const TakeSummary& take, Modality modality) {
  return over(
      take, modality, [](const StreamSummary& s) { return std::optional(s.valid); },
      [](double a, double b) { return std::min(a, b); });
}

/// The widest uncertainty of stamps of all streams of the modality, ms.
std::optional<double> widest_ms(const TakeSummary& take, Modality modality) {
  return over(
      take, modality,
      [](const StreamSummary& s) {
        return s.interval_ns ? std::optional(1e-6 * static_cast<double>(*s.interval_ns))
                             : std::nullopt;
      },
      [](double a, double b) { return std::max(a, b); });
}

/// The cells of a take's row, in the order of the table's columns.
std::vector<Cell> take_cells(std::int64_t id, const TakeName& name, const TakeSummary& take,
                             const Catalogue& catalogue) {
  const Action* action = find_action(catalogue, name.action);
  const auto frames_of = [&](Modality modality) {
    return take.has(modality) ? whole(take.frames) : std::int64_t{0};
  };
  // Lengths of gaps are added over all streams. For inferred samples the worst stream counts.
  double gap_s = 0.0, inferred = 0.0;
  for (const StreamSummary& stream : take.streams) {
    gap_s += stream.gap_s;
    inferred = std::max(inferred, stream.inferred);
  }
  return {id,
          to_string(name),
          name.subject,
          action == nullptr ? Cell() : Cell(action->class_id),
          name.action,
          std::int64_t{name.run},
          whole(take.frames),
          take.seconds(),
          take.rate_hz,
          frames_of(Modality::mocap),
          frames_of(Modality::kinect),
          frames_of(Modality::imu),
          std::string(take.verdict()),
          whole(take.errors),
          whole(take.warnings),
          take.residual_m ? Cell(100.0 * *take.residual_m) : Cell(),
          maybe(least_valid(take, Modality::kinect)),
          maybe(least_valid(take, Modality::imu)),
          inferred,
          gap_s,
          maybe(widest_ms(take, Modality::kinect)),
          maybe(widest_ms(take, Modality::imu)),
          take.begin_ns,
          whole(take.bytes)};
}

std::string places(std::size_t count) {
  std::string text = "?";
  for (std::size_t i = 1; i < count; ++i) text += ",?";
  return text;
}

// The columns of the table `take`, as take_cells() fills them.
constexpr std::size_t take_columns = 24;

/// The statements that add a take. They are prepared once and used for many takes.
struct TakeInserts {
  sqlite::Statement next_id, take, detail, stream;
};

/// The statements that remove a take.
struct TakeDrops {
  sqlite::Statement take, detail, streams;

  Result<void> run(std::int64_t id) {
    KA_TRY(take.run({id}));
    KA_TRY(detail.run({id}));
    return streams.run({id});
  }
};

/// A summary's file as it was when the index read it: its date and its size.
struct Known {
  std::int64_t id = 0, changed_ns = 0, size = 0;
};

/// The folders of people that have to be read again, and those that were removed.
struct FolderChanges {
  std::set<std::string> changed, gone;
};

struct Found {
  TakeName name;
  std::int64_t changed_ns = 0, size = 0;
};

/// The file of a summary; absent if it was just removed. Fails if the folder can be listed but not
/// entered.
Result<std::optional<Found>> found_in(const std::string& folder, const TakeName& name) {
  const std::string file(file_name(path_of(name, TakeFile::summary)));
  if (const auto version = version_of(folder + "/" + file)) {
    return Found{name, version->changed_ns, whole(version->size)};
  }
  std::error_code fault;
  // The folder can be entered, so the file was removed.
  if (fs::exists(folder + "/.", fault) || !fault) return std::nullopt;
  return Failure(Error{folder, 0, "a folder that can be read", fault.message()});
}

}  // namespace

Result<Catalogue> load_catalogue(FileSystem& files, const std::string& folder) {
  const std::string path = folder + "/" + std::string(catalogue_file);
  std::error_code fault;
  // These cases have different errors, because the user must do something else in each.
  if (!fs::exists(folder, fault) || !fs::exists(path, fault)) {
    if (fault) return Failure(Error{folder, 0, "the folder of a data set", fault.message()});
    if (!is_there(folder))
      return Failure(Error{folder, 0, "the folder of a data set", "no such folder"});
    return Failure(Error{folder, 0, "the folder of a data set, with a dataset.toml in it",
                         "no dataset.toml; kinalign dataset init makes one"});
  }
  return read_catalogue(KA_TRY(read_whole(files, path, most_toml)), path);
}

/// The open database with the catalogue. The functions below change tables within the transaction
/// that refresh() begins.
struct DatasetIndex::State {
  FileSystem* files = nullptr;
  std::string folder;
  Catalogue catalogue;
  Findings findings;
  sqlite::Database database;
  std::optional<Error> unreadable;  // a folder of takes that a new index could not read either

  /// The result of reading a folder. A fault is also stored in `unreadable`.
  template <class Value>
  Result<Value> read(Result<Value> found) {
    if (!found) unreadable = found.error();
    return found;
  }
  Result<void> make(bool in_memory);
  Result<bool> has_tables() const;
  Result<void> refresh();
  std::string catalogue_version() const;
  Result<void> make_tables_of(const std::string& path);
  Result<bool> has_catalogue() const;
  Result<void> refresh_catalogue();
  Result<FolderChanges> folder_changes();
  Result<void> refresh_takes(const std::string& name, const std::set<TakeName>& summarised);
  Result<void> refresh_folder(const std::string& name);
  Result<void> remember_folder(const std::string& name, std::int64_t changed,
                               std::int64_t not_built);
  Result<void> forget_folder(const std::string& name);
  Result<TakeInserts> inserts() const;
  Result<TakeDrops> drops() const;
  Result<void> refresh_take(const Found& found, std::map<std::string, Known>& known,
                            TakeDrops& drop, TakeInserts& add);
  Result<void> put(const Found& found, const TakeSummary& take, TakeInserts& inserts);
  Result<std::map<std::string, Known>> known_in(const std::string& name) const;
};

/// True if the index has tables of this layout. The layout's number is stored in the database; a
/// new file has 0.
Result<bool> DatasetIndex::State::has_tables() const {
  auto version = KA_TRY(database.prepare("pragma user_version"));
  return KA_TRY(version.step()) && std::get<std::int64_t>(version.at(0)) == layout;
}

/// Opens the index, and makes its tables again if they have another layout.
Result<void> DatasetIndex::State::make(bool in_memory) {
  const std::string path = in_memory ? ":memory:" : folder + "/" + std::string(index_file);
  std::error_code fault;
  // If the folder .kinalign can't be made, opening fails, and open() uses an index in memory.
  if (!in_memory) fs::create_directory(folder + "/" + std::string(cache_folder), fault);
  database = KA_TRY(sqlite::Database::open(
      path, in_memory ? sqlite::Access::in_memory : sqlite::Access::read_write));
  if (!in_memory) {
    KA_TRY(database.run(
        "pragma journal_mode=wal; pragma synchronous=normal; pragma mmap_size=1073741824;"));
  }
  return KA_TRY(has_tables()) ? Result<void>{} : make_tables_of(path);
}

/// The tables are looked at again after the lock is taken, so two processes never make them twice.
/// If the index has another layout, this fails, and open() then removes the index.
Result<void> DatasetIndex::State::make_tables_of(const std::string& path) {
  KA_TRY(database.run("begin immediate"));
  if (!KA_TRY(has_tables())) {  // another process may have made the tables meanwhile
    auto old = KA_TRY(database.prepare("select count(*) from sqlite_master"));
    const bool is_other = KA_TRY(old.step()) && std::get<std::int64_t>(old.at(0)) > 0;
    if (is_other)
      return Failure(Error{path, 0, "an index of this version", "an index of another version"});
    KA_TRY(database.run(make_tables));
    KA_TRY(database.run(fmt::format("pragma user_version={}", layout)));
  }
  return database.run("commit");
}

/// The takes of a folder that are in the index.
Result<std::map<std::string, Known>> DatasetIndex::State::known_in(const std::string& name) const {
  auto rows =
      KA_TRY(database.prepare("select take.name, take.id, changed_ns, size from detail join take "
                              "using(id) where folder = ?"));
  KA_TRY(rows.bind({name}));
  std::map<std::string, Known> out;
  while (KA_TRY(rows.step())) {
    out[std::get<std::string>(rows.at(0))] = {std::get<std::int64_t>(rows.at(1)),
                                              std::get<std::int64_t>(rows.at(2)),
                                              std::get<std::int64_t>(rows.at(3))};
  }
  return out;
}

Result<TakeInserts> DatasetIndex::State::inserts() const {
  return TakeInserts{
      KA_TRY(database.prepare("select coalesce(max(id), 0) + 1 from take")),
      KA_TRY(database.prepare("insert into take values(" + places(take_columns) + ")")),
      KA_TRY(database.prepare("insert into detail values(?,?,?,?,?,?,?,?)")),
      KA_TRY(database.prepare("insert into stream values(?,?,?,?,?,?,?,?,?,?)"))};
}

/// Adds a take with its streams.
Result<void> DatasetIndex::State::put(const Found& found, const TakeSummary& take,
                                      TakeInserts& inserts) {
  KA_TRY(inserts.next_id.bind({}));
  KA_TRY(inserts.next_id.step());
  // The rows in all three tables have this id.
  const auto id = std::get<std::int64_t>(inserts.next_id.at(0));
  KA_TRY(inserts.take.run(take_cells(id, found.name, take, catalogue)));
  // Columns that are rarely queried are in a separate table, so that the table `take` stays small.
  KA_TRY(inserts.detail.run({id, "sub-" + found.name.subject, found.changed_ns, found.size,
                             take.worst, take.software, take.recipe, take.sha256}));
  for (const StreamSummary& stream : take.streams) {
    const auto modality = modality_names[static_cast<std::size_t>(stream.modality)];
    KA_TRY(inserts.stream.run(
        {id, stream.name, std::string(modality), whole(stream.columns), stream.valid,
         stream.inferred, whole(stream.gaps), stream.gap_s,
         stream.interval_ns ? Cell(1e-6 * static_cast<double>(*stream.interval_ns)) : Cell(),
         fmt::format("{}", fmt::join(stream.nodes, " "))}));
  }
  return {};
}

/// Removes all takes of a folder. Streams and takes are found through `detail`, so its rows are
/// removed last.
Result<void> DatasetIndex::State::forget_folder(const std::string& name) {
  for (const char* sql :
       {"delete from stream where take in (select id from detail where folder = ?)",
        "delete from take where id in (select id from detail where folder = ?)",
        "delete from detail where folder = ?", "delete from folder where path = ?"}) {
    KA_TRY(KA_TRY(database.prepare(sql)).run({name}));
  }
  return {};
}

Result<TakeDrops> DatasetIndex::State::drops() const {
  return TakeDrops{KA_TRY(database.prepare("delete from take where id = ?")),
                   KA_TRY(database.prepare("delete from detail where id = ?")),
                   KA_TRY(database.prepare("delete from stream where take = ?"))};
}

/// Adds a take that is new or changed, and removes it from `known`. If its summary can't be read, a
/// finding is added.
Result<void> DatasetIndex::State::refresh_take(const Found& found,
                                               std::map<std::string, Known>& known, TakeDrops& drop,
                                               TakeInserts& add) {
  const auto old = known.find(to_string(found.name));
  if (old != known.end()) {
    const Known before = old->second;
    known.erase(old);
    // If the date and the size of a summary are the same, it counts as unchanged.
    if (before.changed_ns == found.changed_ns && before.size == found.size) return {};
    KA_TRY(drop.run(before.id));
  }
  const auto take = read_summary(*files, folder, found.name);
  if (take) return put(found, *take, add);
  findings.push_back({Severity::error, take.error(), "lists do not show this take",
                      "kinalign dataset build makes it again"});
  return {};
}

/// Updates the takes of a folder. Takes that have no summary any more are removed.
Result<void> DatasetIndex::State::refresh_takes(const std::string& name,
                                                const std::set<TakeName>& summarised) {
  const std::string place = folder + "/" + name;
  std::map<std::string, Known> known = KA_TRY(known_in(name));
  TakeInserts add = KA_TRY(inserts());
  TakeDrops drop = KA_TRY(drops());
  for (const TakeName& take : summarised) {
    const auto found = KA_TRY(read(found_in(place, take)));
    if (found) KA_TRY(refresh_take(*found, known, drop, add));
  }
  // Takes that remain in `known` have no summary any more.
  for (const auto& [gone, one] : known) KA_TRY(drop.run(one.id));
  return {};
}

/// Updates the takes of a folder. The folder's date is stored only if it is old enough that a later
/// change must alter it (racy_ns).
Result<void> DatasetIndex::State::refresh_folder(const std::string& name) {
  const std::string place = folder + "/" + name, below = name + "/";
  // The date is taken before the names are read, so a change in between is noticed the next time.
  const std::int64_t began = now_ns();
  const std::int64_t changed = changed_ns(place);
  std::set<TakeName> all, summarised;
  for (const std::string& file : KA_TRY(read(names_in_folder(place)))) {
    const auto parsed = parse_take_path(below + file);
    if (!parsed) continue;
    all.insert(parsed->first);
    if (parsed->second == TakeFile::summary) summarised.insert(parsed->first);
  }
  KA_TRY(refresh_takes(name, summarised));
  // If there is a finding, the folder is read again next time, so that the finding is reported
  // again.
  const bool settled = findings.empty() && changed < began - racy_ns;
  return remember_folder(name, settled ? changed : 0, whole(all.size() - summarised.size()));
}

/// Stores the state of a folder. `changed`: its date when it was read; 0: it is read again next
/// time.
Result<void> DatasetIndex::State::remember_folder(const std::string& name, std::int64_t changed,
                                                  std::int64_t not_built) {
  return KA_TRY(database.prepare("insert or replace into folder values(?,?,?)"))
      .run({name, changed, not_built});
}

/// The version (date and size) of dataset.toml that the index was made from.
std::string DatasetIndex::State::catalogue_version() const {
  const auto version = version_of(folder + "/" + std::string(catalogue_file));
  if (!version) return "";
  return fmt::format("{} {} {}", version->number, version->size, version->changed_ns);
}

/// True if the tables were made from the present dataset.toml.
Result<bool> DatasetIndex::State::has_catalogue() const {
  auto known = KA_TRY(database.prepare("select version from catalogue"));
  return KA_TRY(known.step()) && std::get<std::string>(known.at(0)) == catalogue_version();
}

/// Replaces all rows that come from dataset.toml.
Result<void> DatasetIndex::State::refresh_catalogue() {
  KA_TRY(database.run(
      "delete from catalogue; delete from subject; delete from class; delete from action;"));
  const auto put_all = [&](const char* sql, const auto& all, const auto& cells) -> Result<void> {
    auto insert = KA_TRY(database.prepare(sql));
    for (const auto& one : all) KA_TRY(insert.run(cells(one)));
    return {};
  };
  using Cells = std::vector<Cell>;
  KA_TRY(put_all("insert into subject values(?,?,?,?,?)", catalogue.subjects,
                 [](const Subject& s) -> Cells {
                   return {s.id, s.sex, maybe(s.height_cm), maybe(s.weight_kg), s.handedness};
                 }));
  KA_TRY(put_all("insert into class values(?,?)", catalogue.classes,
                 [](const ActionClass& c) -> Cells {
                   return {c.id, c.name};
                 }));
  KA_TRY(
      put_all("insert into action values(?,?,?)", catalogue.actions, [](const Action& a) -> Cells {
        return {a.id, a.class_id, a.name};
      }));
  // An action may now belong to another class, so the class in the rows of takes is updated.
  KA_TRY(database.run("update take set class = (select class from action where id = take.action)"));
  return KA_TRY(database.prepare("insert into catalogue values(?)")).run({catalogue_version()});
}

/// The folders that have changed since they were read, and those that were removed.
Result<FolderChanges> DatasetIndex::State::folder_changes() {
  FolderChanges out;
  std::map<std::string, std::int64_t> known;
  auto rows = KA_TRY(database.prepare("select path, changed_ns from folder"));
  while (KA_TRY(rows.step())) {
    known[std::get<std::string>(rows.at(0))] = std::get<std::int64_t>(rows.at(1));
  }
  for (const std::string& name : KA_TRY(read(people_in(folder)))) {
    if (!is_label(name.substr(4))) continue;
    const auto old = known.find(name);
    // A folder that was stored with the date 0 counts as changed.
    const bool same = old != known.end() && old->second == changed_ns(folder + "/" + name);
    if (!same) out.changed.insert(name);
    if (old != known.end()) known.erase(old);
  }
  for (const auto& [name, when] : known) out.gone.insert(name);
  return out;
}

/// Brings the index up to date in one transaction; without changes nothing is written.
Result<void> DatasetIndex::State::refresh() {
  const FolderChanges folders = KA_TRY(folder_changes());
  const bool same_catalogue = KA_TRY(has_catalogue());
  // Usually nothing has changed, and no lock is needed.
  if (same_catalogue && folders.changed.empty() && folders.gone.empty()) return {};
  KA_TRY(database.run("begin immediate"));
  // The catalogue comes first, because rows of takes contain its classes.
  if (!same_catalogue) KA_TRY(refresh_catalogue());
  for (const std::string& name : folders.gone) KA_TRY(forget_folder(name));
  for (const std::string& name : folders.changed) KA_TRY(refresh_folder(name));
  return database.run("commit");
}

DatasetIndex::DatasetIndex(std::unique_ptr<State> state) : state_(std::move(state)) {}
DatasetIndex::DatasetIndex(DatasetIndex&&) noexcept = default;
DatasetIndex& DatasetIndex::operator=(DatasetIndex&&) noexcept = default;
DatasetIndex::~DatasetIndex() = default;

Result<DatasetIndex> DatasetIndex::open(FileSystem& files, const std::string& folder) {
  Catalogue catalogue = KA_TRY(load_catalogue(files, folder));
  const std::string path = folder + "/" + std::string(index_file);
  Result<void> done;
  // The index is only a cache. The existing index is tried first. If it fails, it is made again; if
  // it can't be written, it is made in memory.
  for (const int attempt : {0, 1, 2}) {
    auto state = std::make_unique<State>();
    state->files = &files;
    state->folder = folder;
    state->catalogue = catalogue;
    if (attempt == 1) {
      // The second attempt removes the index and the two files that SQLite keeps beside it.
      for (const char* ending : {"", "-wal", "-shm"}) files.remove((path + ending).c_str());
    }
    done = state->make(attempt == 2);
    if (done) done = state->refresh();
    // A folder that can't be read would make every attempt fail.
    if (state->unreadable) return Failure(*state->unreadable);
    if (done) return DatasetIndex(std::move(state));
  }
  return Failure(done.error());
}

const Catalogue& DatasetIndex::catalogue() const { return state_->catalogue; }
const Findings& DatasetIndex::findings() const { return state_->findings; }

const std::vector<TableColumn>& DatasetIndex::columns() {
  static const std::vector<TableColumn> all{{"name", "take"},
                                            {"subject", "subject"},
                                            {"sex", "sex"},
                                            {"height_cm", "height, cm"},
                                            {"class", "class"},
                                            {"class_name", "class"},
                                            {"action", "action"},
                                            {"action_name", "action"},
                                            {"run", "run"},
                                            {"frames", "frames"},
                                            {"seconds", "s", 1},
                                            {"rate_hz", "Hz", 1},
                                            {"mocap", "mocap"},
                                            {"kinect", "Kinect"},
                                            {"imu", "IMU"},
                                            {"verdict", "verdict"},
                                            {"errors", "errors"},
                                            {"warnings", "warnings"},
                                            {"residual_cm", "residual, cm", 1},
                                            {"kinect_valid", "Kinect valid", 3},
                                            {"imu_valid", "IMU valid", 3},
                                            {"inferred", "inferred", 3},
                                            {"gap_s", "gaps, s", 2},
                                            {"kinect_ms", "Kinect ± ms", 1},
                                            {"imu_ms", "IMU ± ms", 1},
                                            {"begin_ns", "begin, ns"},
                                            {"bytes", "bytes"},
                                            {"weight_kg", "weight, kg", 1},
                                            {"handedness", "hand"},
                                            {"worst", "worst finding"},
                                            {"software", "software"},
                                            {"recipe", "recipe"},
                                            {"sha256", "SHA-256"}};
  return all;
}

Result<Table> DatasetIndex::select(const std::string& sql, const std::vector<Cell>& values) const {
  auto rows = KA_TRY(state_->database.prepare_reading(sql));
  KA_TRY(rows.bind(values));
  Table out;
  for (std::size_t c = 0; c < rows.columns(); ++c) {
    // Columns of the view `takes` have titles. Other columns are shown with their own names.
    const std::string name = rows.column_name(c);
    const auto known = std::find_if(columns().begin(), columns().end(),
                                    [&](const TableColumn& one) { return one.key == name; });
    out.columns.push_back(known == columns().end() ? TableColumn{name, name, 3} : *known);
  }
  while (KA_TRY(rows.step())) {
    auto& row = out.rows.emplace_back();
    for (std::size_t c = 0; c < rows.columns(); ++c) row.push_back(rows.at(c));
  }
  return out;
}

Result<std::uint64_t> DatasetIndex::not_built() const {
  auto sum = KA_TRY(state_->database.prepare("select coalesce(sum(not_built), 0) from folder"));
  KA_TRY(sum.step());
  return static_cast<std::uint64_t>(std::get<std::int64_t>(sum.at(0)));
}

}  // namespace kinalign
