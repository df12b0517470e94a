// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/data_card.h"

#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/tables.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

constexpr std::size_t longest_card = std::size_t{4} << 20;
constexpr std::string_view own_begin = "<!-- own text -->", own_end = "<!-- end -->";

/// One line of text for Markdown, with markup characters escaped.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      out += ' ';
    } else if (c == '<') {
      // A tag in a description must not become a tag of the page.
      out += "&lt;";
    } else {
      if (std::string_view("\\`*_[]|#").find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

/// A text of dataset.toml, or the words that it is missing. Otherwise a reader could think that a
/// missing licence permits everything.
std::string or_not_stated(const std::string& text) {
  return text.empty() ? "not stated in dataset.toml" : plain(text);
}

/// The text of a cell; empty if the cell has no value.
std::string text_at(const Cell& cell, const TableColumn& column) {
  return std::holds_alternative<std::monostate>(cell) ? "" : cell_text(cell, column);
}

/// The blocks of text that the user added to the old card, with the marks around them.
Result<std::string> own_texts(FileSystem& files, const std::string& path) {
  // A new card has one empty block, which shows the user where to write.
  const std::string empty = fmt::format("{}\n\n{}\n", own_begin, own_end);
  if (path.empty() || !is_there(path)) return empty;
  const std::string text = KA_TRY(read_whole(files, path, longest_card));
  std::string out;
  for (std::size_t at = text.find(own_begin); at != std::string::npos;
       at = text.find(own_begin, at)) {
    const std::size_t end = text.find(own_end, at);
    if (end == std::string::npos) {
      const auto line =
          1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      return Failure(Error{path, line, std::string(own_end) + " behind the own text", "none"});
    }
    out += (out.empty() ? "" : "\n") + text.substr(at, end + own_end.size() - at) + "\n";
    // The search continues after this block, because a card may have several.
    at = end;
  }
  return out.empty() ? empty : out;
}

/// Writes the card part by part into `text_`. All of it comes from the index and dataset.toml, so
/// the same data set gives the same card.
class Card {
 public:
  Card(const DatasetIndex& index, const std::string& folder, const std::string& software)
      : index_(index), catalogue_(index.catalogue()), folder_(folder), software_(software) {}

  Result<std::string> written(const std::string& own) {
    // The parts are in the order in which a reader asks for them.
    KA_TRY(put_head(own));
    KA_TRY(put_tables());
    KA_TRY(put_units());
    put_files();
    KA_TRY(put_reading());
    put_devices();
    put_splits();
    put_terms();
    return std::move(text_);
  }

 private:
  // A heading of Markdown.
  void title(std::string_view words) { text_ += fmt::format("\n## {}\n\n", words); }
  void line(std::string_view words) { text_ += fmt::format("{}\n", words); }

  /// The first column of a query, each value with the second column in brackets.
  Result<std::string> joined(const std::string& sql) const {
    const Table table = KA_TRY(index_.select(sql));
    std::vector<std::string> words;
    for (const auto& row : table.rows) {
      std::string one = plain(text_at(row.at(0), table.columns[0]));
      // In all queries the second column is a number of takes.
      if (row.size() > 1) one += " (" + text_at(row.at(1), table.columns[1]) + ")";
      words.push_back(one);
    }
    return fmt::format("{}", fmt::join(words, ", "));
  }

  Result<void> put_head(const std::string& own) {
    // If the data set has no name, the title is the name of its folder.
    const std::string name =
        catalogue_.name.empty() ? std::string(file_name(folder_)) : catalogue_.name;
    // From the mark below the title a later run sees that kinalign wrote the file.
    line("# " + plain(name));
    line(
        fmt::format("{}: `kinalign dataset report FOLDER --card` writes it again. Text between the "
                    "marks\nof an own text is kept. -->",
                    data_card_mark));
    line("");
    if (!catalogue_.description.empty()) line(plain(catalogue_.description) + "\n");
    const Table sums = KA_TRY(index_.select(
        "select count(*) as takes, count(distinct subject) as people, "
        "coalesce(sum(frames), 0) as frames, coalesce(sum(seconds), 0.0) from takes"));
    // cell_text() writes these sums in the same form as in tables.
    const auto cell = [&](std::size_t c) {
      return cell_text(sums.rows.at(0).at(c), sums.columns[c]);
    };
    // Good takes come first.
    const std::string verdicts =
        KA_TRY(joined("select verdict, count(*) as takes from takes group by verdict order by "
                      "case verdict when 'good' then 0 when 'usable' then 1 else 2 end"));
    line(fmt::format("Takes: {}. People: {}. Frames: {}. Motion: {}. Verdicts: {}.", cell(0),
                     cell(1), cell(2), duration_text(std::get<double>(sums.rows.at(0).at(3))),
                     verdicts.empty() ? "none yet" : verdicts));
    line(
        "The verdict of a take is that of its worst stream: by findings of its alignment, and by "
        "limits for invalid, inferred and interpolated samples, gaps, clocks and distances.\n");
    text_ += own;
    return {};
  }

  // The tables of the HFUT-MMD paper, as `kinalign dataset tables` prints them.
  Result<void> put_tables() {
    title("Composition");
    for (auto* const table : {table_by_subject, table_by_class, table_by_modalities}) {
      line(kinalign::written(KA_TRY(table(index_)), TableFormat::markdown));
    }
    return {};
  }

  Result<void> put_units() {
    title("Rates, units and axes");
    // Equal streams of many takes are one row. Only the most frequent ones are listed.
    Table streams = KA_TRY(
        index_.select("select name, modality, columns, count(*) as takes from streams "
                      "group by name, modality, columns order by count(*) desc, name limit 20"));
    streams.columns = {{"name", "stream"},
                       {"modality", "modality"},
                       {"columns", "joints or nodes"},
                       {"takes", "takes"}};
    line(kinalign::written(streams, TableFormat::markdown));
    line("- Rows: " +
         KA_TRY(
             joined("select cast(round(rate_hz, 2) as text) || ' Hz', count(*) as takes from takes "
                    "group by round(rate_hz, 2) order by count(*) desc limit 20")) +
         "; in brackets the takes.");
    line(
        "- Stamps: int64, ns since 1970-01-01 UTC. The same stamps hold for all streams of a "
        "take.");
    line("- Positions in metres, right-handed, y up. Rotations are quaternions w,x,y,z.");
    line("- Angular velocity in rad/s, acceleration in m/s².");
    line(
        "- `valid` is 0 where a device has no measurement near enough; no value is made up there. "
        "`state`: 2 tracked, 1 inferred, 0 missing.");
    return {};
  }

  void put_files() {
    title("Files");
    text_ +=
        "```text\n"
        "dataset.toml                                people, classes, actions, terms\n"
        "sub-ID/sub-ID_task-ACTION_run-NN_take.h5    a take (HDF5)\n"
        "sub-ID/..._take.json                        its summary and SHA-256\n"
        "sub-ID/..._recording.toml                   how it was made from raw files\n"
        "sourcedata/sub-ID/...                       raw files, if they were copied\n"
        "splits/                                     parts for training and test\n"
        "```\n"
        "`kinalign dataset verify` compares every byte with its SHA-256.\n";
  }

  // A Python example that works for this data set: it opens the take with the most kinds of
  // streams.
  Result<void> put_reading() {
    const Table takes =
        KA_TRY(index_.select("select name from takes order by (mocap > 0) + (kinect > 0) + (imu > "
                             "0) desc, name limit 1"));
    // If the data set has no take, there is no example.
    if (takes.rows.empty()) return {};
    const std::string take = std::get<std::string>(takes.rows[0].at(0));
    const auto name = parse_take_name(take);
    if (!name) return {};
    title("Read a take");
    line("With Python and h5py, in the folder of this file:\n");
    text_ += fmt::format(
        "```python\n"
        "import h5py\n\n"
        "with h5py.File(\"{}\") as take:\n"
        "    seconds = (take[\"time_ns\"][:] - take[\"time_ns\"][0]) / 1e9\n"
        "    for stream in take.attrs[\"streams\"]:\n"
        "        stream = stream.decode() if isinstance(stream, bytes) else stream\n"
        "        for column in take[stream]:\n"
        "            if isinstance(take[stream][column], h5py.Dataset):\n"
        "                print(stream, column, take[stream][column].shape, "
        "take[stream][column].dtype)\n"
        "    print(len(seconds), \"rows,\", seconds[-1], \"s\")\n"
        "```\n",
        path_of(*name, TakeFile::take));
    return {};
  }

  // Lists devices and rigs, with the texts that the lab chose.
  void put_devices() {
    if (catalogue_.devices.empty() && catalogue_.rigs.empty()) return;
    title("Devices");
    for (const auto* list : {&catalogue_.devices, &catalogue_.rigs}) {
      for (const Described& one : *list) {
        std::vector<std::string> texts;
        for (const auto& [key, text] : one.texts) {
          texts.push_back(fmt::format("{}: {}", plain(key), plain(text)));
        }
        line(fmt::format("- {}{}: {}", list == &catalogue_.rigs ? "rig " : "", plain(one.id),
                         fmt::join(texts, "; ")));
      }
    }
  }

  // Lists the files of splits that exist. They are not read.
  void put_splits() {
    std::vector<std::string> names =
        names_in_folder(folder_ + "/splits").value_or(std::vector<std::string>{});
    std::erase_if(names, [](const std::string& name) { return !name.ends_with(".json"); });
    if (names.empty()) return;
    title("Splits");
    for (const std::string& name : names) line("- `splits/" + name + "`");
    line("\n`kinalign dataset split FOLDER --check FILE` checks whether a split still fits.");
  }

  // Lists the terms of use. People with the same consent are listed together.
  void put_terms() {
    title("Terms");
    line("- Licence: " + or_not_stated(catalogue_.licence));
    line("- Citation: " + or_not_stated(catalogue_.citation));
    line("- Contact: " + or_not_stated(catalogue_.contact));
    // The map is sorted by the text of the consent.
    std::map<std::string, std::vector<std::string>> consents;
    for (const Subject& one : catalogue_.subjects) {
      consents[one.consent].push_back(one.id);
    }
    for (const auto& [consent, people] : consents) {
      line(fmt::format("- Consent of {}: {}", fmt::join(people, ", "), or_not_stated(consent)));
    }
    line("- People have pseudonyms. The list of names is kept elsewhere.");
    line("\nWritten by " + plain(software_) + ".");
  }

  const DatasetIndex& index_;
  const Catalogue& catalogue_;
  const std::string& folder_;
  const std::string& software_;
  std::string text_;
};

}  // namespace

Result<std::string> data_card(FileSystem& files, const DatasetIndex& index,
                              const std::string& folder, const std::string& old_card,
                              const std::string& software) {
  // The user's texts are read before anything is written, because the new card replaces the old
  // file.
  const std::string own = KA_TRY(own_texts(files, old_card));
  return Card(index, folder, software).written(own);
}

}  // namespace kinalign
