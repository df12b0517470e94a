// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/windows/windows.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/dataset/split.h"
#include "kinalign/view/table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// Each window stores the index of its part in one byte.
constexpr std::size_t most_parts = 255;
constexpr std::size_t shown_takes = 5;

/// The options of `kinalign dataset windows`. Without --split all windows are in one part, "all".
struct Windows {
  std::vector<std::string> folder;
  WindowOptions options;
  std::string split, where;
};

/// The command line of `kinalign dataset windows`.
Usage describe_windows(Windows& o) {
  Usage usage;
  usage.positionals = {folder_word(o.folder)};
  usage.flags = {
      split_field(o.split),
      where_field(o.where),
      text_flag("stream",
                "stream to use; may be repeated (default: the streams that all takes have)",
                &o.options.streams, "NAME"),
      {"length", "rows per window", &o.options.length, 2.0, 1e6},
      {"step", "rows from the start of one window to the start of the next", &o.options.step, 1.0,
       1e6},
      {"rate", "rows per second; 0: the rate of the takes", &o.options.rate_hz, 0.0, 1e4, {}, "HZ"},
      {"valid", "smallest fraction of valid cells in each stream", &o.options.valid, 0.0, 1.0}};
  usage.check = [](const Common& common, const Sources&) -> Result<void> {
    return check_out(common, {".npz"}, "-o FILE.npz");
  };
  return usage;
}

/// Notes the part of the split to which each take belongs. Takes that are in no part are removed.
Result<void> divide(const Split& split, const std::string& file, std::vector<SplitTake>& takes,
                    WindowSource& source) {
  if (split.parts.size() > most_parts) {
    return Failure(Error{file, 0, "at most 255 parts", std::to_string(split.parts.size())});
  }
  std::map<TakeName, std::uint8_t> part_of;
  // The parts of the split replace the part "all".
  source.parts.clear();
  for (const SplitPart& part : split.parts) {
    for (const TakeName& name : part.takes) {
      // most_parts makes sure that the index fits into one byte.
      part_of[name] = static_cast<std::uint8_t>(source.parts.size());
    }
    source.parts.push_back(part.name);
  }
  // Takes that the split does not name give no windows.
  std::erase_if(takes, [&](const SplitTake& take) { return !part_of.contains(take.name); });
  for (const SplitTake& take : takes) {
    source.takes.push_back({take.name, "", take.summary, part_of.at(take.name)});
  }
  return {};
}

/// The takes from which windows are cut, each with its part of the split and its class of actions.
Result<WindowSource> source_of(const Windows& o, const std::string& folder, Call& call) {
  FileSystem& files = call.surroundings.files;
  const DatasetIndex index = KA_TRY(open_index(folder, call));
  const Catalogue& catalogue = index.catalogue();
  KA_TRY(print_not_built(index, folder, call));
  WindowSource source{folder, catalogue.name, catalogue.licence, catalogue.citation, {"all"}, {}};
  auto takes = KA_TRY(built_takes(files, folder, index, o.where));
  if (o.split.empty()) {
    for (const SplitTake& take : takes) source.takes.push_back({take.name, "", take.summary, 0});
  } else {
    // The split is checked against all takes, even those that --where leaves out. It is an error if
    // the test part has data of the training part.
    const auto all = o.where.empty() ? takes : KA_TRY(built_takes(files, folder, index, ""));
    KA_TRY(divide(KA_TRY(read_good_split(files, o.split, all)), o.split, takes, source));
  }
  for (WindowTake& take : source.takes) {
    // An action that dataset.toml does not describe has no class.
    const Action* action = find_action(catalogue, take.name.action);
    if (action != nullptr) take.class_id = action->class_id;
  }
  return source;
}

/// Prints the number of windows in each part and what was left out, for three reasons: too few
/// valid samples, stretches shorter than a window, and takes without the needed streams.
void print(const WindowsMade& made, const WindowSource& source, Call& call) {
  Table table;
  table.columns = {{"part", "part"}, {"windows", "windows"}};
  for (std::size_t part = 0; part < source.parts.size(); ++part) {
    table.rows.push_back({source.parts[part], static_cast<std::int64_t>(made.windows[part])});
  }
  call.console.print(written(table, TableFormat::text));
  if (made.too_little_valid > 0) {
    call.console.print(fmt::format("note   {} windows left out: too few valid cells (--valid)\n",
                                   made.too_little_valid));
  }
  if (made.rows_left_out > 0) {
    call.console.print(
        fmt::format("note   {} rows left out: their stretches are shorter than half a window\n",
                    made.rows_left_out));
  }
  auto left_out = nlohmann::ordered_json::array();
  std::vector<std::string> lines;
  for (const TakeLeftOut& one : made.takes_left_out) {
    left_out.push_back({{"take", to_string(one.name)}, {"why", one.why}});
    lines.push_back(fmt::format("note   {} left out: {}\n", to_string(one.name), one.why));
  }
  call.console.print(harmless(
      first_lines(lines, shown_takes, "note   {} more takes left out (--json has them)\n")));
  call.console.print_json(
      json_text(nlohmann::ordered_json{{"windows", made.windows},
                                       {"parts", source.parts},
                                       {"rows_left_out", made.rows_left_out},
                                       {"windows_with_too_little_valid", made.too_little_valid},
                                       {"takes_left_out", left_out}},
                1));
}

/// Cuts the windows and writes them into one NPZ file.
Result<int> run_windows(Windows& o, Call& call) {
  const std::string folder = folder_of(o.folder);
  const WindowSource source = KA_TRY(source_of(o, folder, call));
  const WindowsMade made =
      // The windows of all takes go into one file.
      KA_TRY(write_windows(call.surroundings.files, source, o.options,
                           {call.common.out, call.common.overwrite()}, call.console.progress()));
  call.console.wrote(call.common.out);
  print(made, source, call);
  return 0;
}

}  // namespace

/// The verb `kinalign dataset windows`.
Verb dataset_windows_verb() {
  return make_verb<Windows>(
      {.name = "dataset windows",
       .summary = "arrays for training: windows of takes, with masks, in one NPZ",
       .text = "The arrays are [window, row, column]; `manifest` in the file says what each column "
               "is. No window crosses a gap. Padded rows and samples that were not measured are "
               "0 in the arrays STREAM_valid.",
       .examples =
           {{"kinalign dataset windows walks -o walks.npz --split walks/splits/people.json",
             "windows of 64 rows, each marked with its part of the split"},
            {"kinalign dataset windows walks -o pairs.npz --where \"kinect > 0\" --stream mocap "
             "--stream kinect --rate 30 --length 90 --step 45",
             "pairs for cleaning a Kinect, 3 s at 30 Hz"}},
       .common = {"out", "force", "json"}},
      describe_windows, run_windows);
}

}  // namespace kinalign
