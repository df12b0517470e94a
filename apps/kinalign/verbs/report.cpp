// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/child_process.h"
#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/inputs.h"
#include "apps/kinalign/verbs/take_origin.h"

#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"
#include "kinalign/view/page/page_html.h"
#include "kinalign/view/page/take_figures.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

/// The length of the detail, s: the part of a take for which the page shows raw samples. The rest
/// of the page shows the resampled rows of the take.
constexpr double detail_length_s = 60.0;
constexpr double no_detail_s = -1.0;  // no --detail-s was given; the verb chooses the part

/// The options of `kinalign report`. If `inputs` is empty, the raw files are searched in the take's
/// folder.
struct Report {
  std::vector<std::string> take;
  std::string inputs;
  double detail_s = no_detail_s;
  bool open = false;
};

/// The command line of `kinalign report`.
Usage describe_report(Report& o) {
  Usage usage;
  usage.positionals = {{"TAKE", "a take that kinalign wrote", &o.take}};
  usage.flags = {
      {"inputs",
       "folder of the files that the take was made from, for the raw samples (default: the take's "
       "folder, if they are there)",
       &o.inputs},
      {"detail-s",
       "begin of the 60 s of raw samples, s after the first row (default: around the longest gap)",
       &o.detail_s, no_detail_s, 1e9},
      {"open", "show the page with xdg-open", &o.open}};
  usage.check = [](const Common& common, const Sources&) -> Result<void> {
    // Browsers show a file as a page only if it has one of these endings.
    return check_out(common, {".html", ".htm"}, "the page's file name, as in -o take.html");
  };
  return usage;
}

// ---- in a child process: everything that reads HDF5
// These functions return text, because a child process can return nothing else.

/// The text that use(reader, report) makes of a take. `use` runs in a child process.
template <class Use>
Result<std::string> text_of_take(FileSystem& files, const std::string& path, const Use& use) {
  return run_guarded(GuardLimits{}, blame(path), [&]() -> Result<std::string> {
    TakeReader reader = KA_TRY(TakeReader::open(files, path));
    const std::string json = KA_TRY(reader.report_json());
    const AlignmentReport report = KA_TRY(parse_report_json(json, path));
    return use(reader, report);
  });
}

/// JSON about a take: the stamp of the first row, the begin of the detail ("begin_s"), and the
/// names of the streams of points and of nodes.
Result<std::string> outline_json(TakeReader& reader, const AlignmentReport& report) {
  nlohmann::json out{{"begin_ns", to_ns(report.begin)}, {"begin_s", 0.0}};
  out["points"] = out["nodes"] = nlohmann::json::array();
  for (const TakeGroup& group : reader.header().groups) {
    if (std::holds_alternative<PointGroup>(group.kind)) out["points"].push_back(group.name);
    if (std::holds_alternative<ImuGroup>(group.kind)) out["nodes"].push_back(group.name);
  }
  const double length = seconds(report.end - report.begin);
  // The detail shows the whole of a short take. A take without points has no gap to look for.
  if (length <= detail_length_s || out["points"].empty()) return json_text(out);
  LongestGap gap;
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) gap.add(slab);
  // The middle of the longest gap becomes the middle of the detail, unless the take begins or ends
  // too near.
  const double begin = gap.middle_s().value_or(0.0) - 0.5 * detail_length_s;
  out["begin_s"] = std::clamp(begin, 0.0, length - detail_length_s);
  return json_text(out);
}

/// One line of JSON about the page, followed by the page itself.
Result<std::string> page_text(const std::string& path, TakeReader& reader,
                              const AlignmentReport& report, const TakeFigureOptions& options) {
  // outline_json() used another reader, so this reader still begins at the first row.
  TakeFigures figures(reader.header(), report, options);
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) figures.add(slab);
  TakePage page = figures.finish();
  page.file = file_name(path);
  page.software = reader.software();
  // The printed summary needs three facts about the page. They stand in one line before the HTML,
  // so that the child process can return both as one text.
  nlohmann::ordered_json about{{"verdicts", nlohmann::ordered_json::array()},
                               {"worst", nlohmann::ordered_json::array()},
                               {"stride", page.stride}};
  for (const Verdict& verdict : page.verdicts) {
    about["verdicts"].push_back({{"stream", verdict.stream},
                                 {"quality", std::string(to_string(verdict.quality))},
                                 {"reason", verdict.reason}});
  }
  for (const Concern& concern : page.worst) {
    about["worst"].push_back(
        {{"stream", concern.stream}, {"part", concern.part}, {"what", words_of(concern)}});
  }
  const std::string html = KA_TRY(page_html(page));
  return json_text(about) + "\n" + html;
}

// ---- the raw samples of figures 4, 11 and 12
// A take has only resampled rows. Raw samples come from the input files, which are not HDF5, so no
// child process is needed.

/// The facts about a take that are needed to read its raw samples.
struct Outline {
  Time begin{};
  double detail_begin_s = 0.0;             // begin of the detail, s after the first row
  std::vector<std::string> points, nodes;  // names of streams
};

/// The raw samples for figures 4, 11 and 12. Empty if the input files were not found, or if the
/// take has neither points nor nodes. The page then shows no raw samples.
struct RawSamples {
  std::vector<RawPoints> points;
  std::vector<RawNode> nodes;
  bool empty() const { return points.empty() && nodes.empty(); }
};

/// Reads the facts in a child process. `wanted_s`: the value of --detail-s; negative if the verb
/// chooses the begin of the detail.
Result<Outline> outline_of(FileSystem& files, const std::string& path, double wanted_s) {
  const std::string text = KA_TRY(text_of_take(files, path, outline_json));
  try {  // the child read a file that may be damaged, so its text may be wrong
    const auto json = nlohmann::json::parse(text);
    Outline out;
    out.begin = utc_time(json.at("begin_ns").get<std::int64_t>());
    out.detail_begin_s = wanted_s >= 0.0 ? wanted_s : json.at("begin_s").get<double>();
    out.points = json.at("points").get<std::vector<std::string>>();
    out.nodes = json.at("nodes").get<std::vector<std::string>>();
    return out;
  } catch (const nlohmann::json::exception&) {
    return Failure(Error{path, 0, "a take that states its first stamp", "no first stamp"});
  }
}

/// The raw samples of a stream of points within the detail, with stamps in the time of the take. A
/// stream can only be read from its beginning, so all of it is read, but only the detail is stored.
Result<RawPoints> raw_points(const RecordedStream& stream, const Outline& outline) {
  const auto& input = std::get<PointInput>(stream.data);
  const std::size_t joints = input.joint_names.size();
  const double end_s = outline.detail_begin_s + detail_length_s;
  RawPoints out{stream.name, {}};
  const Pass<PointFrames> pass = KA_TRY(input.passes());
  PointFrames block;
  while (KA_TRY(pass(block))) {
    for (std::size_t t = 0; t < block.size(); ++t) {
      const Time at = take_time(stream.clock, block.stamps[t]);
      const double s = seconds(at - outline.begin);
      if (s < outline.detail_begin_s || s > end_s) continue;
      out.frames.stamps.push_back(at);
      // The joints of frame t begin at this index of the arrays [frame, joint, 3] (m) and [frame,
      // joint].
      const auto cell = static_cast<std::ptrdiff_t>(t * joints);
      const auto count = static_cast<std::ptrdiff_t>(joints);
      const auto places = block.positions.begin() + 3 * cell;
      out.frames.positions.insert(out.frames.positions.end(), places, places + 3 * count);
      const auto states = block.state.begin() + cell;
      out.frames.state.insert(out.frames.state.end(), states, states + count);
    }
  }
  return out;
}

/// The raw samples of each node of a stream within the detail, with stamps in the time of the take.
/// A row has one sample of each of N nodes, so sample i belongs to stamp i / N and node i % N.
Result<std::vector<RawNode>> raw_nodes(const RecordedStream& stream, const Outline& outline) {
  const auto& input = std::get<ImuInput>(stream.data);
  const std::size_t worn = input.node_names.size();
  const double end_s = outline.detail_begin_s + detail_length_s;
  std::vector<RawNode> out;
  for (const std::string& node : input.node_names) out.push_back({stream.name, node, {}, {}, {}});
  const Pass<ImuSamples> pass = KA_TRY(input.passes());
  ImuSamples block;
  while (KA_TRY(pass(block))) {
    for (std::size_t sample = 0; sample < block.valid.size(); ++sample) {
      const Time at = take_time(stream.clock, block.stamps[sample / worn]);
      const double s = seconds(at - outline.begin);
      // An invalid sample is a gap in the figure and not a zero.
      if (block.valid[sample] == 0 || s < outline.detail_begin_s || s > end_s) continue;
      RawNode& node = out[sample % worn];
      node.stamps.push_back(at);
      const auto put = [sample](const std::vector<double>& from, std::vector<double>& to) {
        // The array is empty if the device has no gyroscope or accelerometer.
        if (from.empty()) return;
        const auto begin = from.begin() + static_cast<std::ptrdiff_t>(3 * sample);
        to.insert(to.end(), begin, begin + 3);
      };
      put(block.angular_velocity, node.angular_velocity);
      put(block.acceleration, node.acceleration);
    }
  }
  return out;
}

/// The raw samples of all streams of points and nodes. Fails if an input file is missing or has
/// changed since the take was made.
Result<RawSamples> read_raw(Call& call, const Origin& origin, const Outline& outline,
                            const std::string& base) {
  Manifest manifest = origin.parameters;
  // Raw samples of skeletons are not shown, so their streams are removed and their files need not
  // exist.
  std::erase_if(manifest.streams, [&outline](const StreamOptions& stream) {
    const auto has = [&stream](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), stream.name) != names.end();
    };
    return !has(outline.points) && !has(outline.nodes);
  });
  RawSamples out;
  if (manifest.streams.empty()) return out;
  FileSystem& files = call.surroundings.files;
  // Each file is opened once before the recording is read, so that a missing file gives an early
  // error.
  for (const std::string& file : files_named(manifest, base)) {
    KA_TRY(InputFile::open(files, file));
  }
  const Recording recording =
      KA_TRY(open_recording(files, manifest, base, {call.console.progress(), call.jobs}));
  const std::vector<std::string> changed = changed_inputs(origin, recording);
  // If an input has changed, its samples are not those of the take, so none are shown.
  if (!changed.empty()) {
    return Failure(Error{changed.front(), 0, "the file that the take was made from", "another"});
  }
  for (const RecordedStream& stream : recording.streams) {
    if (std::holds_alternative<PointInput>(stream.data)) {
      out.points.push_back(KA_TRY(raw_points(stream, outline)));
    } else if (std::holds_alternative<ImuInput>(stream.data)) {
      for (RawNode& node : KA_TRY(raw_nodes(stream, outline))) out.nodes.push_back(std::move(node));
    }
  }
  return out;
}

// ---- the verb

/// A size in megabytes of 10^6 bytes, as file managers show it.
std::string size_text(std::size_t bytes) {
  return fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes));
}

/// The printed text: the page's file and size, the verdicts, and the most serious problems.
std::string summary_text(const std::string& out, std::size_t bytes,
                         const nlohmann::ordered_json& about, Call& call) {
  std::string streams;
  for (const auto& verdict : about["verdicts"]) {
    const auto quality = verdict["quality"].get<std::string>();
    // "bad" has the colour of an error, "good" is green, and all other verdicts have the colour of
    // a warning.
    const Colour colour =
        quality == "good" ? Colour::good : (quality == "bad" ? Colour::bad : Colour::warning);
    streams += (streams.empty() ? "" : ", ") + harmless(verdict["stream"].get<std::string>()) +
               " " + call.console.paint(colour, quality);
  }
  std::string text = fmt::format("{}: {}, {}\n", harmless(out), size_text(bytes), streams);
  for (const auto& worst : about["worst"]) {
    text += "  " +
            harmless(worst["stream"].get<std::string>() + ": " + worst["what"].get<std::string>()) +
            "\n";
  }
  return text;
}

/// Opens the page in a browser with xdg-open. If xdg-open fails, the user gets a note, but no
/// error, because the page has been written.
void show(const std::string& out, Call& call) {
  const auto child = start_child("xdg-open", {"xdg-open", out}, -1, -1);
  if (child && wait_for_child(*child) == 0) return;
  call.console.note(harmless("kinalign report: xdg-open could not show " + out));
}

/// The size of the page, and the JSON about it.
struct Written {
  std::size_t bytes = 0;
  nlohmann::ordered_json about;
};

/// Makes the page in a child process and writes the file.
Result<Written> write_page(const std::string& take, const TakeFigureOptions& options, Call& call) {
  FileSystem& files = call.surroundings.files;
  // The file is created first: if its name is taken, the verb fails before the long work.
  OutputFile out = KA_TRY(OutputFile::create(files, call.common.out, call.common.overwrite()));
  const auto page = [&](TakeReader& reader, const AlignmentReport& report) {
    return page_text(take, reader, report, options);
  };
  const std::string text = KA_TRY(text_of_take(files, take, page));
  // The JSON is one line, so the page begins after the first line end.
  const std::size_t line = text.find('\n');
  const std::string_view html = std::string_view(text).substr(line + 1);
  // The child process has read a file that may be damaged, so its text may be wrong.
  Written written{html.size(), nlohmann::ordered_json::parse(text.substr(0, line), nullptr, false)};
  if (!written.about.is_object()) {
    return Failure(Error{take, 0, "a take that can be read", "an unreadable answer"});
  }
  KA_TRY(out.write(html));
  KA_TRY(out.commit());
  return written;
}

/// Prints the text and the JSON about the page, and returns the exit code.
int print_written(const Written& written, bool has_raw, Call& call) {
  const std::string& out = call.common.out;
  call.console.wrote(out);
  call.console.print(summary_text(out, written.bytes, written.about, call));
  nlohmann::ordered_json json{{"path", out}, {"bytes", written.bytes}};
  json.update(written.about);
  json["raw_samples"] = has_raw;
  call.console.print_json(json_text(json));
  // A bad stream gives exit code 1. Warnings alone give 0, because the page shows them anyway.
  const auto& verdicts = written.about["verdicts"];
  const bool any_bad = std::any_of(verdicts.begin(), verdicts.end(),
                                   [](const auto& verdict) { return verdict["quality"] == "bad"; });
  return any_bad ? 1 : 0;
}

/// The raw samples that can be read. Without --inputs it is no error if the input files are
/// elsewhere; there are no raw samples then.
Result<RawSamples> find_raw(const Report& o, Call& call, const Origin& origin,
                            const Outline& outline, const std::string& base) {
  auto raw = read_raw(call, origin, outline, base);
  // With --inputs the user wants raw samples, so it is an error if they can't be read. Ctrl-C is
  // always an error.
  const bool optional = o.inputs.empty() && !interrupted();
  if (!raw && optional) return RawSamples{};
  return raw;
}

/// Makes the page of a take.
Result<int> run(Report& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& take = o.take.front();
  // The schema is kinalign.report_page, because kinalign.report is the schema of the report in a
  // take.
  call.console.name_json("report_page");
  if (KA_TRY(kind_of_file(files, take)) != FileKind::take) {
    return call.console.refuse(
        Error{take, 0, "a take (kinalign align makes one)", "a file of another kind"});
  }
  call.console.advise("nothing was written");
  const Origin origin = KA_TRY(origin_of(files, take));
  std::string base = o.inputs.empty() ? std::string(folder(take)) : o.inputs;
  if (!base.empty() && !base.ends_with('/')) base += '/';
  std::vector<std::string> inputs = files_named(origin.parameters, base);
  // -o must not name the take itself, because the take is an input of the page.
  inputs.push_back(take);
  KA_TRY(keep_inputs(call.common.out, inputs));
  const Outline outline = KA_TRY(outline_of(files, take, o.detail_s));
  TakeFigureOptions options;
  options.detail_begin_s = outline.detail_begin_s;
  options.detail_length_s = detail_length_s;
  RawSamples raw = KA_TRY(find_raw(o, call, origin, outline, base));
  const bool has_raw = !raw.empty();
  options.raw = std::move(raw.points);
  options.raw_nodes = std::move(raw.nodes);
  const Written written = KA_TRY(write_page(take, options, call));
  const int code = print_written(written, has_raw, call);
  if (o.open) show(call.common.out, call);
  return code;
}

}  // namespace

/// The verb `kinalign report`.
Verb report_verb() {
  return make_verb<Report>(
      {.name = "report",
       .summary = "make a page for a take",
       .text = "Writes one HTML file that loads nothing: a verdict for each stream, figures of "
               "time, space and nodes, and a 3D player. It shows raw samples if the take's inputs "
               "can be read. Exit code 1 if a stream is bad.",
       .examples = {{"kinalign report demo/take.h5 -o demo/page.html", "open it in a browser"},
                    {"kinalign report demo/take.h5 -o demo/page.html --force --open",
                     "also opens the page"},
                    {"kinalign report demo/take.h5 -o demo/page.html --force --json",
                     "path, size, verdicts"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_report, run);
}

}  // namespace kinalign
