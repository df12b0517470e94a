// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/time_server.h"

#include "apps/kinalign/text/advice.h"
#include "apps/kinalign/text/summary.h"
#include "apps/kinalign/text/time_server_text.h"
#include "apps/kinalign/time_server/node_printer.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/capture/net/own_addresses.h"
#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/nodes/node_keys.h"

#include <fmt/format.h>

#include <utility>

namespace kinalign {

namespace {

using Clock = std::chrono::steady_clock;

/// The options of `kinalign time-server`. If local_stratum or node_port is empty, that service is
/// off.
struct TimeServerFlags {
  std::int64_t port = 123;
  std::vector<std::string> listen, exempt;
  std::optional<std::int64_t> local_stratum, node_port;
  std::string lab_key;
};

/// Parses the networks or single addresses of --exempt. parse_network() does not know the flag, so
/// its name is added to the error here.
Result<std::vector<AddressBlock>> networks_of(const std::vector<std::string>& texts) {
  std::vector<AddressBlock> networks;
  for (const std::string& text : texts) {
    auto network = parse_network(text);
    if (!network) return Failure(Error{"--exempt", 0, network.error().expected, shown(text)});
    networks.push_back(*network);
  }
  return networks;
}

/// Refuses two addresses if one of them includes the other. Otherwise the system would report that
/// another program uses the port.
Result<void> check_pair(const std::string& one, const std::string& other) {
  if (one == other) {
    return Failure(Error{"--listen", 0, "each address once", one + " twice"});
  }
  // An IPv4 address and an IPv6 address never include each other.
  if (is_ipv6_text(one) != is_ipv6_text(other)) return {};
  for (const auto& [all, part] : {std::pair{one, other}, std::pair{other, one}}) {
    // "0.0.0.0" includes every IPv4 address, "::" every IPv6 address.
    if (!is_any_address(all)) continue;
    return Failure(Error{"--listen", 0, "no address that " + all + " already includes", part});
  }
  return {};
}

/// The addresses of --listen in the spelling of the operating system.
Result<std::vector<std::string>> addresses_of(const std::vector<std::string>& texts) {
  std::vector<std::string> addresses;
  // An address, above all of IPv6, may be spelt in several ways. With one spelling addresses can be
  // compared as text.
  for (const std::string& text : texts) {
    const auto address = spelt_address(text);
    if (!address) return Failure(Error{"--listen", 0, "an IPv4 or IPv6 address", shown(text)});
    for (const std::string& other : addresses) KA_TRY(check_pair(other, *address));
    addresses.push_back(*address);
  }
  return addresses;
}

/// Checks flags that exclude or need each other.
Result<void> check_flags(const TimeServerFlags& o, const Sources& given) {
  // A wrong address is wrong use. Both calls report it before any socket is opened.
  KA_TRY(addresses_of(o.listen));
  KA_TRY(networks_of(o.exempt));
  // An empty text comes from a shell variable that is not set; it must not mean "no key".
  if (given.contains("lab_key") && o.lab_key.empty()) {
    return Failure(Error{"--lab-key", 0, "a file's name", "nothing"});
  }
  if (!o.node_port && !o.lab_key.empty()) {
    return Failure(Error{"--lab-key", 0, "--node-port as well", "no --node-port"});
  }
  // For port 0 the system chooses a free port, so two zeros give two different ports.
  if (o.node_port == o.port && o.port != 0) {
    return Failure(Error{"--node-port", 0, "a port other than that of --port",
                         fmt::format("port {} for both", o.port)});
  }
  return {};
}

/// The command line of `kinalign time-server`.
Usage describe_time_server(TimeServerFlags& o) {
  Usage usage;
  usage.flags = {
      {"listen", "an address to serve on (default: all addresses); may be repeated", &o.listen},
      {"exempt", "an address or network without a limit of requests; may be repeated", &o.exempt}};
  usage.settings = {
      {"port", "UDP port; 0: any free one", &o.port, 0.0, 65535.0},
      {"local_stratum",
       "while this machine's clock is not synchronised, let clients follow it as the lab's "
       "reference, at this stratum; 10 is usual",
       &o.local_stratum, 1.0, 15.0},
      {"node_port", "UDP port for inertial nodes; 0: any free one", &o.node_port, 0.0, 65535.0},
      {"lab_key", "file with the lab's key, from which the nodes' keys are derived (see node-key)",
       &o.lab_key}};
  usage.check = [&o](const Common&, const Sources& given) { return check_flags(o, given); };
  return usage;
}

Result<TimeServerOptions> options_of(const TimeServerFlags& flags) {
  TimeServerOptions options;
  options.addresses = flags.listen;
  options.port = static_cast<std::uint16_t>(flags.port);
  if (flags.local_stratum) options.local_stratum = static_cast<std::uint8_t>(*flags.local_stratum);
  options.exempt = KA_TRY(networks_of(flags.exempt));
  // The secret of the NTP server is new at each start and is never stored.
  options.key = KA_TRY(new_secret());
  return options;
}

/// Advice for a port that could not be opened. `flag`: the flag that sets the port.
Advice advice_on_port(const std::string& flag, std::int64_t port) {
  const WantedPort wanted{static_cast<std::uint16_t>(port), flag, "--listen", false};
  return [wanted](const Error& error) { return port_advice(error, wanted); };
}

Result<LabKeyFile> read_key_file(const TimeServerFlags& flags, Call& call) {
  LabKeyFile lab{flags.lab_key, std::nullopt};
  if (lab.path.empty()) return lab;
  FileSystem& files = call.surroundings.files;
  // This advice is for the key file. The caller sets other advice before it opens a port.
  call.console.if_it_fails(key_advice);
  lab.key = KA_TRY(read_lab_key(files, lab.path));
  return lab;
}

/// Opens the receiver of nodes; empty without --node-port. The receiver uses the addresses of
/// --listen and its own port. Its secret is new at each start; the lab's key comes from a file.
Result<std::optional<NodeReceiver>> open_nodes(const TimeServerFlags& flags,
                                               const std::optional<LabKey>& lab_key,
                                               ClockReader& clocks) {
  if (!flags.node_port) return std::nullopt;
  NodeReceiverOptions options;
  options.addresses = flags.listen;
  options.port = static_cast<std::uint16_t>(*flags.node_port);
  options.responder.secret = KA_TRY(new_secret());
  options.responder.lab_key = lab_key;
  return KA_TRY(NodeReceiver::open(options, clocks));
}

/// The addresses and ports that users of clients need.
ServedPort served_port(const TimeServer& server, const std::optional<NodeReceiver>& nodes,
                       const TimeServerFlags& flags) {
  ServedPort served;
  // If the user gave port 0, only the open sockets know the real port.
  for (const UdpSocket& socket : server.sockets()) served.addresses.push_back(socket.address());
  served.reachable = reachable_at(flags.listen, own_addresses());
  served.port = server.sockets().front().port();
  if (nodes) served.node_port = nodes->sockets().front().port();
  served.keyed = !flags.lab_key.empty();
  return served;
}

/// Prints changes while the server runs. The server calls it four times a second. It remembers the
/// last printed state, so each line reports a change. All references must outlive it.
class ServerPrinter {
 public:
  ServerPrinter(const TimeServer& server, std::optional<NodePrinter>& nodes, Console& console)
      : server_(server),
        nodes_(nodes),
        console_(console),
        progress_(console.progress()),
        printed_(server.state()) {}

  /// Prints what has changed since the last call. Returns false if the server has to stop.
  bool operator()() {
    print_clock();
    print_misdirected();
    print_counts();
    print_trouble();
    const std::string nodes = nodes_ ? (*nodes_)() : "";
    const std::string both = counts_text(server_.counts()) + (nodes.empty() ? "" : "; " + nodes);
    return progress_("serving: " + both, 0, 0);
  }
  void print_end() {
    const double s = elapsed_s();
    console_.print(
        fmt::format("served for {}: {}\n", duration_text(s), counts_text(server_.counts())));
    if (nodes_) nodes_->print_end();
    console_.print_json(counts_json(server_.counts(), "stopped", s));
  }

 private:
  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

  void print_clock() {
    const NtpServerState& now = server_.state();
    // Other members of the state, such as the dispersion, change all the time and are not printed.
    if (now.leap == printed_.leap && now.stratum == printed_.stratum) return;
    printed_ = now;
    print_live(console_, "the clock is now " + clock_text(now));
    console_.print_json(clock_json(now));
    console_.flush();
  }
  /// Warns once if a node sends to the NTP port; such datagrams are still counted.
  void print_misdirected() {
    // A node gets no useful answer from the NTP port. One warning is enough for the user to find
    // the wrong setting.
    if (misdirected_printed_ || server_.counts()[NtpOutcome::from_node] == 0) return;
    misdirected_printed_ = true;
    print_live(console_,
               "warning: a node sends to the NTP port; it must send to the port of --node-port");
  }
  /// Prints each fault of stdout once for as long as it lasts. Without the line nobody may notice
  /// for hours that the output is lost.
  void print_trouble() {
    const std::string trouble = console_.out_trouble();
    if (std::exchange(out_trouble_, trouble) == trouble) return;
    print_live(console_, trouble.empty()
                             ? "standard output accepts lines again"
                             : "warning: standard output is blocked (" + trouble +
                                   "): up to 1 MiB of lines is kept; serving continues");
  }
  void print_counts() {
    constexpr double every_s = 10;
    // Line n is printed n * 10 s after the start, so that a late line does not delay later ones.
    if (elapsed_s() < every_s * (counts_printed_ + 1)) return;
    ++counts_printed_;
    console_.print_json(counts_json(server_.counts(), "counts", elapsed_s()));
    console_.flush();
  }

  const TimeServer& server_;
  std::optional<NodePrinter>& nodes_;
  Console& console_;
  Progress progress_;
  NtpServerState printed_;
  std::string out_trouble_;  // the fault that was printed and still lasts
  Clock::time_point began_ = Clock::now();
  int counts_printed_ = 0;
  bool misdirected_printed_ = false;
};

Result<int> run(TimeServerFlags& o, Call& call) {
  Console& console = call.console;
  // A program that reads stdout slowly must not delay the answers to clients.
  console.never_wait();
  o.listen = KA_TRY(addresses_of(o.listen));
  const LabKeyFile lab = KA_TRY(read_key_file(o, call));
  // The advice is for the port that is opened next, since each port has its own flag.
  console.if_it_fails(advice_on_port("--port", o.port));
  TimeServer server = KA_TRY(TimeServer::open(KA_TRY(options_of(o))));
  console.if_it_fails(advice_on_port("--node-port", o.node_port.value_or(0)));
  SystemClocks clocks;
  // The receiver of nodes is opened after the server. If that fails, no client has been answered
  // yet.
  auto nodes = KA_TRY(open_nodes(o, lab.key, clocks));
  const ServedPort served = served_port(server, nodes, o);
  console.print(harmless(start_lines(served, server.state())));
  console.print_json(start_json(served, server.state()));
  // If this machine's clock is not synchronised, clients ignore the server. The user must learn
  // that at the start.
  if (server.state().leap == NtpLeap::unsynchronised) {
    console.note(
        "kinalign time-server: warning: this machine's clock is not synchronised, so clients will "
        "not follow it; if the lab has no other clock, --local-stratum 10 makes "
        "them follow this one, right or wrong");
  }
  console.flush();
  std::optional<NodePrinter> node_printer;
  if (nodes) node_printer.emplace(*nodes, console, call.surroundings.files, lab);
  ServerPrinter printer(server, node_printer, console);
  // serve() returns after Ctrl-C. The nodes' port comes first, because arrival times there stamp
  // data.
  server.serve([&printer] { return printer(); }, nodes ? &*nodes : nullptr);
  printer.print_end();
  return 0;
}

}  // namespace

/// The verb `kinalign time-server`.
Verb time_server_verb() {
  return make_verb<TimeServerFlags>(
      {.name = "time-server",
       .summary = "be the lab's clock: answer NTP requests",
       .text = "Serves the system's clock by NTP (RFC 5905) until Ctrl-C. A client gets at most 8 "
               "answers at once, then one every 2 s; --exempt is for clients that ask more often. "
               "With --json each line is an object with a member event: started and stopped; with "
               "--node-port pair and, for each node, node (node_id, certainty, time_ns, "
               "earliest_ns, latest_ns, "
               "drift_ppm and more), once a second; counts and node_counts, every 10 s; clock, "
               "node_event, clock_event, host_event, key_replaced, key_unreadable and missed when "
               "they happen. Members in _ns are on CLOCK_MONOTONIC_RAW, except utc_ns and the "
               "node's own counter_ns: "
               R"({"schema": "kinalign.time-server/1", "event": "pair", "raw_ns": 4521080113, )"
               R"("utc_ns": 1790000000000000000}. docs/time_server_json.md has every member.)",
       .examples = {{"kinalign time-server --local-stratum 10",
                     "a lab without another clock; port 123 needs root"},
                    {"kinalign time-server --port 12300 --listen 127.0.0.1",
                     "without root rights, for this machine"},
                    {"kinalign time-server --node-port 5005 --lab-key lab.key",
                     "inertial nodes too; see node-key"},
                    {"kinalign time-server --json", "a line of JSON for each event"}},
       .common = {"json"}},
      describe_time_server, run);
}

}  // namespace kinalign
