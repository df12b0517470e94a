// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/unused_options.h"

#include "kinalign/align/plan.h"
#include "kinalign/core/find_named.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace kinalign {

namespace {

/// Returns the names of the options that differ between two structures of the same type. describe()
/// lists the options of both in the same order.
std::vector<std::string> differing(const Fields& some, const Fields& others) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const bool same = std::visit(
        [&](auto* value) { return *value == *std::get<decltype(value)>(others[i].value); },
        some[i].value);
    if (!same) names.push_back(some[i].name);
  }
  return names;
}

/// Adds the options that a file sets, including those set to their defaults.
void add_stated(const KeyLines& lines, std::vector<std::string>& names) {
  for (const auto& [key, line] : lines) names.push_back(key);
}

std::vector<std::string> options_set(StreamOptions options) {
  StreamOptions defaults;
  std::vector<std::string> names = differing(describe(options), describe(defaults));
  add_stated(options.lines, names);
  return names;
}

/// The method decides which other options are used, so the method itself never counts as unused.
std::vector<std::string> options_set(SpaceOptions options) {
  SpaceOptions defaults;
  defaults.method = options.method;
  std::vector<std::string> names = differing(describe(options), describe(defaults));
  add_stated(options.lines, names);
  std::erase(names, "method");
  return names;
}

/// A method of [space] and the options that it uses.
struct Method {
  std::string_view name;
  std::vector<std::string_view> takes;
};

const Method& method_named(std::string_view name) {
  static const std::array<Method, 4> methods{
      {{"none", {}},
       {"fit", {"onto", "joints"}},
       {"given", {"onto", "joints", "rotation", "translation"}},
       {"paper", {"onto", "joints", "rotation_y_deg", "magnification", "root", "onto_root"}}}};
  // The manifest allows only these four methods (take/manifest.cpp).
  return *find_named(methods, name);
}

bool contains(std::span<const std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Fails if [space.STREAM] sets an option that its method does not use.
Result<void> check_space(const std::string& stream, const SpaceOptions& space) {
  const std::string at = "[space." + stream + "]";
  const Method& method = method_named(space.method);
  for (const std::string& name : options_set(space)) {
    if (contains(method.takes, name)) continue;
    const std::string taken = fmt::format("{}", fmt::join(method.takes, ", "));
    return Failure(Error{"", line_of(space.lines, name),
                         "in " + at + " only options of method = \"" + space.method + "\" (" +
                             (taken.empty() ? "nothing" : taken) + ")",
                         name});
  }
  if (space.method == "given" && space.rotation.empty() && space.translation.empty()) {
    return Failure(Error{"", line_of(space.lines, "method"),
                         "rotation or translation in " + at + ", whose method is \"given\"",
                         "neither"});
  }
  return {};
}

/// Refuses an interval for stamps that need none: those of a shared clock and those of the
/// reference. Also refuses clock = "unknown" for the reference or together with an interval.
Result<void> check_intervals(const Recording& recording, const Manifest& manifest) {
  const std::string reference = reference_name(recording, manifest);
  for (const StreamOptions& options : manifest.streams) {
    const std::int64_t doubt = options.clock == "unknown" ? line_of(options.lines, "clock") : 0;
    if (doubt > 0 && (options.interval_ms || options.name == reference)) {
      return Failure(Error{
          "", doubt, "no clock for '" + options.name + "', whose stamps have a known accuracy",
          "clock = \"unknown\""});
    }
    if (!options.interval_ms) continue;
    const std::int64_t line = line_of(options.lines, "interval_ms");
    if (options.clock == "shared") {
      return Failure(Error{"", line,
                           "either a shared clock or an interval_ms for '" + options.name + "'",
                           "both: with clock = \"shared\" the interval is 0"});
    }
    if (options.name == reference) {
      return Failure(Error{"", line, "interval_ms only for streams other than the reference",
                           "interval_ms for '" + reference + "', the reference"});
    }
  }
  return {};
}

}  // namespace

/// The lists follow from the kinds of streams. Nodes have no unit of length, points have no clicks.
/// Only a recorded skeleton needs a hierarchy from another file.
std::span<const std::string_view> useless_options(const RecordedStream& stream) {
  static constexpr std::array<std::string_view, 4> clip{"rate_hz", "root_node", "mounting",
                                                        "skeleton"};
  static constexpr std::array<std::string_view, 5> points{"end_ns", "click_latency_ms", "root_node",
                                                          "mounting", "skeleton"};
  static constexpr std::array<std::string_view, 4> nodes{"end_ns", "click_latency_ms",
                                                         "metres_per_unit", "skeleton"};
  // A recording contains the device's clock, which is more accurate than an option.
  static constexpr std::array<std::string_view, 8> recorded_clip{
      "start_ns",  "end_ns",      "click_latency_ms", "clock",
      "drift_ppm", "interval_ms", "root_node",        "mounting"};
  static constexpr std::array<std::string_view, 10> recorded_points{
      "start_ns",    "end_ns",    "click_latency_ms", "clock",           "drift_ppm",
      "interval_ms", "root_node", "mounting",         "metres_per_unit", "up"};
  static constexpr std::array<std::string_view, 7> recorded_nodes{
      "start_ns",  "end_ns",      "click_latency_ms", "clock",
      "drift_ppm", "interval_ms", "metres_per_unit"};
  if (stream.format == "recording") {
    if (std::holds_alternative<ClipInput>(stream.data)) return recorded_clip;
    if (std::holds_alternative<PointInput>(stream.data)) return recorded_points;
    return recorded_nodes;
  }
  if (std::holds_alternative<ClipInput>(stream.data)) return clip;
  if (std::holds_alternative<PointInput>(stream.data)) return points;
  return nodes;
}

/// Only the first option without effect is reported.
Result<void> check_options_used(const Recording& recording, const Manifest& manifest) {
  constexpr std::array<const char*, 3> kinds{"a skeleton", "points", "nodes"};
  for (const RecordedStream& stream : recording.streams) {
    const StreamOptions& options = options_of(manifest, stream.name);
    for (const std::string& name : options_set(options)) {
      if (!contains(useless_options(stream), name)) continue;
      const std::string file = stream.files.empty() ? "" : " (" + stream.files[0].name + ")";
      return Failure(Error{
          "", line_of(options.lines, name),
          "for '" + stream.name + "'" + file + " only options of " + kinds[stream.data.index()],
          name});
    }
  }
  KA_TRY(check_intervals(recording, manifest));
  for (const auto& [stream, space] : manifest.spaces) KA_TRY(check_space(stream, space));
  return {};
}

}  // namespace kinalign
