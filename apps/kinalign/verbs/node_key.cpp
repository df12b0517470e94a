// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/text/advice.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/capture/nodes/node_keys.h"

namespace kinalign {

namespace {

/// The options of `kinalign node-key`: either new_lab_key is set, or lab_key and node are. `node`
/// is an optional, because 0 is a valid id.
struct NodeKeyFlags {
  std::string new_lab_key, lab_key;
  std::optional<std::int64_t> node;
};

/// Refuses an empty file name, which comes from a shell variable that is not set. `given` tells
/// whether the flag was given at all.
Result<void> check_named(const NodeKeyFlags& o, const Sources& given) {
  const bool drawn = given.contains("new_lab_key") && o.new_lab_key.empty();
  const bool read = given.contains("lab_key") && o.lab_key.empty();
  if (!drawn && !read) return {};
  return Failure(Error{drawn ? "--new-lab-key" : "--lab-key", 0, "a file's name", "nothing"});
}

/// --new-lab-key makes only the key of a lab, so no other flag may be given.
Result<void> check_drawn(const NodeKeyFlags& o, const Common& common) {
  if (!common.out.empty()) {
    return Failure(Error{"--out", 0,
                         "no --out with --new-lab-key, which already names the new file",
                         shown(common.out)});
  }
  if (o.lab_key.empty() && !o.node) return {};
  return Failure(
      Error{o.node ? "--node" : "--lab-key", 0,
            "--new-lab-key FILE alone; for a node's key, run again with --lab-key FILE --node N",
            "both"});
}

/// The key of a node needs the lab's key and the node's id.
Result<void> check_node(const NodeKeyFlags& o) {
  if (o.lab_key.empty() && !o.node) {
    return Failure(
        Error{"", 0, "--new-lab-key FILE, once per lab, or --lab-key FILE --node N, for each node",
              "neither"});
  }
  if (!o.node) {
    return Failure(Error{"--lab-key", 0, "--node N as well, the id of the node", "no --node"});
  }
  if (!o.lab_key.empty()) return {};
  return Failure(Error{"--node", 0, "--lab-key FILE as well, from which the node's key is derived",
                       "no --lab-key"});
}

/// The command line of `kinalign node-key`.
Usage describe_node_key(NodeKeyFlags& o) {
  Usage usage;
  usage.flags = {
      {"new_lab_key", "make a random lab key and write it to this new file", &o.new_lab_key},
      {"lab_key", "the file with the lab's key", &o.lab_key},
      {"node", "id of the node, as in its firmware", &o.node, 0.0, 4294967295.0}};
  usage.check = [&o](const Common& common, const Sources& given) -> Result<void> {
    KA_TRY(check_named(o, given));
    return o.new_lab_key.empty() ? check_node(o) : check_drawn(o, common);
  };
  return usage;
}

/// Makes the key of a lab, or derives a node's key from it and prints or writes that.
Result<int> run_node_key(NodeKeyFlags& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  // write_key() never replaces a file: if a key is lost, all its nodes must be flashed again.
  if (!o.new_lab_key.empty()) {
    KA_TRY(write_key(files, o.new_lab_key, KA_TRY(new_lab_key())));
    call.console.print(o.new_lab_key + ": a new lab key; keep a copy where only you can read it\n");
    return 0;
  }
  // The advice is only about reading the lab's key, so it is removed before the node's key is
  // written.
  call.console.if_it_fails(key_advice);
  const LabKey lab = KA_TRY(read_lab_key(files, o.lab_key));
  call.console.if_it_fails({});
  const MacKey key = node_key(lab, static_cast<std::uint32_t>(*o.node));
  if (call.common.out.empty()) {
    // put() prints the key even with --quiet, so that a script can read it.
    call.console.put(key_text(key) + "\n");
    return 0;
  }
  KA_TRY(write_key(files, call.common.out, key));
  call.console.print(call.common.out + ": the key of node " + std::to_string(*o.node) + "\n");
  return 0;
}

}  // namespace

/// The verb `kinalign node-key`.
Verb node_key_verb() {
  return make_verb<NodeKeyFlags>(
      {.name = "node-key",
       .summary = "make the lab's key, and the key of each node",
       .text = "If a node has a key, no other sender can imitate it or replay its frames. The "
               "node's key is derived from the lab's key, which time-server --lab-key reads. No "
               "file is ever overwritten.",
       .examples = {{"kinalign node-key --new-lab-key lab.key", "once per lab"},
                    {"kinalign node-key --lab-key lab.key --node 7", "prints 32 digits"},
                    {"kinalign node-key --lab-key lab.key --node 7 -o node7.key",
                     "writes them to a file that only you can read"}},
       .common = {"out"}},
      describe_node_key, run_node_key);
}

}  // namespace kinalign
