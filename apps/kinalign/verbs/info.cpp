// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"

namespace kinalign {

namespace {

/// The options of `kinalign info`. The flags that describe a stream are needed for files that do
/// not state how to read them, such as a table without a known layout.
struct Info {
  std::vector<std::string> file;
  StreamFlags stream;
};

/// The command line of `kinalign info`.
Usage describe_info(Info& o) {
  Usage usage;
  usage.positionals = {{"FILE",
                        "a take, a recording, a recording.toml, an XDF, a model or a stream's file",
                        &o.file,
                        1,
                        1,
                        {},
                        "info reads one file; kinalign check reads several"}};
  usage.flags = o.stream.fields();
  // A wrong --select is wrong use, which is found here before a file is opened.
  usage.check = [&o](const Common&, const Sources&) {
    return o.stream.stream({}).map([](const StreamOptions&) {});
  };
  return usage;
}

/// Reads a manifest's files or a stream's file to the end, and describes them.
Result<Description> describe_input(const Info& o, Call& call, const std::string& path,
                                   Names names) {
  const Input input =
      KA_TRY(open_input(call.surroundings.files, path, o.stream, call.console.progress()));
  // The open stream tells which flags its reader uses, so the flags are checked after opening.
  if (!input.manifest) {
    KA_TRY(o.stream.check_use(path, &input.recording.streams.front(), call));
  }
  // Some findings, for example about values, are known only after the last row.
  KA_TRY(read_through(input.recording, call.console.progress()));
  return describe_recording(path, input.recording, names);
}

/// Chooses the description by the kind of the file. Files that describe themselves allow no flags
/// that describe a stream.
Result<Description> describe(const Info& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& path = o.file.front();
  const Names names = call.common.verbose ? Names::yes : Names::no;
  const FileKind kind = KA_TRY(kind_of_file(files, path));
  if (kind != FileKind::stream && kind != FileKind::unknown) {
    KA_TRY(o.stream.check_use(path, nullptr, call));
  }
  const Progress progress = call.console.progress();
  switch (kind) {
    case FileKind::recording: {
      const auto source = KA_TRY(
          // The description does not need the devices' clocks, so Devices::surveyed leaves them
          // out.
          RecordingSource::open(files, path, RecordingSource::Devices::surveyed, {}, progress));
      return describe_survey(path, source->survey(), source->parts());
    }
    case FileKind::xdf:
      return describe_survey(path, KA_TRY(survey_xdf(files, path, progress)), names);
    case FileKind::take:
      // describe_take() reads HDF5 in a child process.
      return describe_take(files, path, names);
    case FileKind::model:
      return describe_model(path, KA_TRY(read_whole(files, path, most_model_bytes)));
    case FileKind::manifest:
    case FileKind::stream:
    case FileKind::unknown:  // opening fails with the reason, unless --layout states the format
      break;
  }
  return describe_input(o, call, path, names);
}

Result<int> run(Info& o, Call& call) {
  const Description found = KA_TRY(describe(o, call));
  // Names in files may contain control characters, which a terminal would obey.
  call.console.print(harmless(found.text));
  call.console.print_json(found.json);
  return 0;
}

}  // namespace

/// The verb `kinalign info`.
Verb info_verb() {
  return make_verb<Info>(
      {.name = "info",
       .summary = "show the contents of a file",
       .text = "Reads the whole file once. A take is opened in a separate process with limits, "
               "because HDF5 files from other people can crash the library.",
       .examples = {{"kinalign info demo/mocap.bvh", "joints, frames, rate"},
                    {"kinalign info demo/mocap.bvh -v", "with the joints' names"},
                    {"kinalign info demo/take.h5 --json", "everything, with the report"},
                    {"kinalign info denoise.safetensors", "a model: joints, network, training"}},
       .common = {"json"}},
      describe_info, run);
}

}  // namespace kinalign
