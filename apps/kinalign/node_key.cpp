// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/capture/node_keys.h"

namespace kinalign {

namespace {

struct NodeKeyFlags {
  std::string new_lab_key, lab_key;
  std::optional<std::int64_t> node;
};

Usage describe_node_key(NodeKeyFlags& o) {
  Usage usage;
  usage.flags = {{"new_lab_key", "draw a lab key, and write it into this new file", &o.new_lab_key},
                 {"lab_key", "the file with the lab's key", &o.lab_key},
                 {"node", "the node's id, as it is flashed", &o.node, 0.0, 4294967295.0}};
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    const bool draws = !o.new_lab_key.empty(), derives = !o.lab_key.empty() && o.node;
    if (draws != derives && !(draws && (!o.lab_key.empty() || o.node || !common.out.empty()))) {
      return {};
    }
    return Failure(Error{"", 0, "--new-lab-key FILE alone, or --lab-key FILE with --node N",
                         draws ? "both" : "neither"});
  };
  return usage;
}

Result<int> run_node_key(NodeKeyFlags& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  if (!o.new_lab_key.empty()) {
    KA_TRY(write_key(files, o.new_lab_key, KA_TRY(new_lab_key())));
    call.console.print(o.new_lab_key + ": a new lab key; keep a copy where nobody else reads it\n");
    return 0;
  }
  const LabKey lab = KA_TRY(read_lab_key(files, o.lab_key));
  const MacKey key = node_key(lab, static_cast<std::uint32_t>(*o.node));
  if (call.common.out.empty()) {
    call.console.put(key_text(key) + "\n");
    return 0;
  }
  KA_TRY(write_key(files, call.common.out, key));
  call.console.print(call.common.out + ": the key of node " + std::to_string(*o.node) + "\n");
  return 0;
}

}  // namespace

Verb node_key_verb() {
  return make_verb<NodeKeyFlags>(
      {.name = "node-key",
       .summary = "the lab's key, and the key that a node is flashed with",
       .text =
           "A node with a key can't be imitated, nor its frames be replayed. Its key is derived "
           "from the lab's, which time-server --lab-key reads; no file is ever overwritten.",
       .examples = {{"kinalign node-key --new-lab-key lab.key", "once in a lab"},
                    {"kinalign node-key --lab-key lab.key --node 7", "prints 32 digits"},
                    {"kinalign node-key --lab-key lab.key --node 7 -o node7.key",
                     "writes them, for nobody else to read"}},
       .common = {"out"}},
      describe_node_key, run_node_key);
}

}  // namespace kinalign
