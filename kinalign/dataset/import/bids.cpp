// SPDX-License-Identifier: Apache-2.0
// Imports BIDS-Motion. Subject, task and run become those of the take, tracking systems its
// streams.
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/formats/bids/names.h"
#include "kinalign/formats/bids/system.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <tuple>

namespace kinalign {

namespace {

/// True for a file of BIDS-Motion. Only the file's name is needed to recognise this corpus.
bool is_motion(FileSystem&, const SourceFile& file) { return named_as_bids_motion(file.name); }

/// One recording: the parts that the names of its tracking systems have in common.
struct Recorded {
  std::string subject, session, task, acquisition, run;

  auto operator<=>(const Recorded&) const = default;
  std::string text() const {
    std::string out = "sub-" + subject;
    for (const auto& [key, label] : {std::pair("_ses-", session), std::pair("_task-", task),
                                     std::pair("_acq-", acquisition), std::pair("_run-", run)}) {
      // Parts that the name lacks are left out.
      if (!label.empty()) out += key + label;
    }
    return out;
  }
};

/// A tracking system of a recording: one stream of the take.
struct System {
  std::string name, path;
  bool has_points = false;
};

/// The run's number; 0 for a label that does not begin with a number.
std::uint32_t run_number(const std::string& run) {
  std::uint32_t value = 0;
  std::from_chars(run.data(), run.data() + run.size(), value);
  return value;
}

/// The manifest of a take. Systems with positions come first, because the first stream is the
/// reference and needs positions.
Manifest systems_manifest(std::vector<System> systems) {
  std::stable_partition(systems.begin(), systems.end(),
                        [](const System& one) { return one.has_points; });
  Manifest out;
  for (const System& one : systems) {
    out.streams.push_back(stream_of(one.name, one.path, "bids"));
    // A system without positions is read as nodes.
    if (!one.has_points) out.streams.back().select = {{"kind", "nodes"}};
  }
  return out;
}

/// Lists a take for every recording with positions; its tracking systems are the streams.
Result<Corpus> list_bids(const ImportInput& input) {
  Corpus out{.name = "BIDS-Motion", .classes = {{"bids", "tasks"}}, .class_id = "bids"};
  // The recordings are sorted, so takes have the same order in every import.
  std::map<Recorded, std::vector<System>> recorded;
  for (const SourceFile& file : input.sources) {
    const auto name = parse_bids_name(file_name(file.name));
    if (!is_motion(input.files, file) || !name) continue;
    const auto label = [&](std::string_view key) { return std::string(name->label(key)); };
    // A system whose sidecar files can't be read is left out. Other systems of the recording stay.
    const auto system = read_bids_system(input.files, file.path);
    if (!system) {
      out.left_out.push_back({std::string(stem_of(file.name)), to_string(system.error())});
      continue;
    }
    // Systems whose names share these parts were recorded together.
    recorded[{label("sub"), label("ses"), label("task"), label("acq"), label("run")}].push_back(
        {label("tracksys"), file.path, has_positions(*system)});
  }
  for (const auto& [key, systems] : recorded) {
    // A take needs a reference with positions.
    const bool has_points = std::any_of(systems.begin(), systems.end(),
                                        [](const System& one) { return one.has_points; });
    if (!has_points) {
      out.left_out.push_back({key.text(), "no tracking system with positions"});
      continue;
    }
    // Runs are numbered anew in each session, so the run of a later session may be taken already.
    out.takes.push_back(
        {key.subject, key.task, run_number(key.run), systems_manifest(systems), key.text()});
  }
  return out;
}

}  // namespace

CorpusKind bids_corpus() {
  // A BIDS data set is a separate kind of corpus and not just a folder of motion files.
  return {"bids", "sub-*_tracksys-*_motion.tsv", false, is_motion, list_bids};
}

}  // namespace kinalign
