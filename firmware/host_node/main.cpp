// SPDX-License-Identifier: Apache-2.0
// The node's logic as a program; options.cpp has its options.
#include "firmware/host_node/key_file.h"
#include "firmware/host_node/node_run.h"
#include "firmware/host_node/pipe_line.h"
#include "firmware/host_node/report.h"
#include "firmware/script/script.h"

#include <sys/signalfd.h>

#include <csignal>
#include <memory>

namespace {

using namespace kinalign;

void complain(const std::string& line) { std::fprintf(stderr, "host_node: %s\n", line.c_str()); }

/// A descriptor that can be read once the program was asked to end.
int stop_descriptor() {
  sigset_t signals{};
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  return signalfd(-1, &signals, SFD_CLOEXEC);
}

void play_script() {
  PipeLine line;
  std::make_unique<Script>(line)->play();
  std::fflush(stdout);
}

Tried<void> run(HostNodeOptions options) {
  if (options.help) {
    std::fputs(host_node_help(), stdout);
    return {};
  }
  if (options.script) {
    play_script();
    return {};
  }
  if (!options.key_file.empty()) {
    const auto key = read_key_file(options.key_file);
    if (!key) return tl::unexpected(key.error());
    options.node.has_key = true;
    options.node.key = *key;
  }
  auto socket = NodeSocket::connected_to(options.host, options.port);
  if (!socket) return tl::unexpected(socket.error());
  const int stop = stop_descriptor();
  const auto node_run = std::make_unique<NodeRun>(options, *std::move(socket));
  if (auto lived = node_run->live(stop, complain); !lived) return lived;
  std::puts(report(options, *node_run).c_str());
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<const char*> words(argv + 1, argv + argc);
  auto options = options_from(words);
  const Tried<void> done = options ? run(*std::move(options)) : tl::unexpected(options.error());
  if (done) return 0;
  complain(done.error().text);
  return done.error().exit_code;
}
