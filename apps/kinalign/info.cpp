// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/describe_file.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/manifest_toml.h"
#include "kinalign/io/open_recording.h"

namespace kinalign {

namespace {

struct Info {
  std::vector<std::string> file;
  StreamFlags stream;
};

Usage describe_info(Info& o) {
  Usage usage;
  usage.positionals = {{"FILE", "a take, a recording.toml or a stream's file", &o.file}};
  usage.flags = o.stream.fields();
  return usage;
}

Result<int> run(Info& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& path = o.file.front();
  Description found;
  if (KA_TRY(is_take(files, path))) {
    found = KA_TRY(describe_take(files, path));
  } else {
    const Recording recording = KA_TRY(open_input(files, path, o.stream, call.console.progress()));
    found = describe_recording(path, recording);
  }
  call.console.print(harmless(found.text));
  call.console.print_json(found.json);
  return 0;
}

}  // namespace

Verb info_verb() {
  return make_verb<Info>(
      {.name = "info",
       .summary = "what is in a file",
       .text = "Reads the whole file once. A take is opened in a process of its "
               "own, with limits: HDF5 files from outside can crash the library.",
       .examples = {{"kinalign info walk.bvh", "joints, frames, rate"},
                    {"kinalign info take.h5 --json", "everything, with the report"}},
       .common = {"json"}},
      describe_info, run);
}

}  // namespace kinalign
