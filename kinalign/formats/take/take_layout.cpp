// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/take_layout.h"

#include "kinalign/motion/targets.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace kinalign {

namespace {

using Facts = std::vector<std::pair<std::string, std::string>>;

const Facts time_facts{{"units", "ns"}};

Facts facts(std::string units, std::string space) {
  return {{"units", std::move(units)}, {"space", std::move(space)}};
}

Facts rotation_facts(std::string space) {
  return {{"order", "w,x,y,z"}, {"space", std::move(space)}};
}

// The columns of a stream with a skeleton. A root's space is that of the take, unless the stream
// was not converted to it.
std::vector<TakeColumn> clip_columns(const Skeleton& skeleton, const TakeGroup& group,
                                     Stored number) {
  const std::uint64_t joints = skeleton.joints();
  const std::string parent_space =
      "each joint in its parent's, a root in " +
      (group.space == "take" ? std::string("the take's") : group.space + "'s own");
  std::vector<TakeColumn> out{
      {"positions", number, {joints, 3}, facts("m", group.space)},
      {"local_positions", number, {joints, 3}, facts("m", parent_space)},
      {"local_rotations", number, {joints, 4}, rotation_facts(parent_space)}};
  // All rows of the reference stream are valid, so it has no column `valid`.
  if (group.resampled) out.push_back({"valid", Stored::uint8, {}, {{"values", "0 no, 1 yes"}}});
  return out;
}

std::vector<TakeColumn> point_columns(std::uint64_t joints, const TakeGroup& group, Stored number) {
  return {{"positions", number, {joints, 3}, facts("m", group.space)},
          {"state", Stored::uint8, {joints}, {{"values", "0 missing, 1 inferred, 2 tracked"}}},
          {"valid", Stored::uint8, {joints}, {{"values", "0 no, 1 yes"}}}};
}

/// The columns of a stream of nodes. Each column names the space of its vectors.
std::vector<TakeColumn> imu_columns(const ImuGroup& group, Stored number) {
  const std::uint64_t nodes = group.node_names.size();
  const std::string& root = group.root_node;
  const std::string space = root.empty() ? "each node's own, as mounted" : root;
  std::vector<TakeColumn> out;
  if (group.content.orientation) {
    // If there is a root node, only its own orientation is in the world.
    const std::string turned = root.empty() ? "world" : root + "; its own: world";
    out.push_back({"orientation", number, {nodes, 4}, rotation_facts(turned)});
  }
  if (group.content.acceleration) {
    Facts described = facts("m/s2", space);
    const std::string gravity = group.content.gravity ? gravity_included : gravity_removed;
    // If there is a root node, only its own acceleration still contains gravity.
    const bool differs = group.content.gravity && !root.empty();
    described.emplace_back("gravity", gravity + (differs ? " in " + root + " only" : ""));
    out.push_back({"acceleration", number, {nodes, 3}, std::move(described)});
  }
  if (group.content.angular_velocity) {
    out.push_back({"angular_velocity", number, {nodes, 3}, facts("rad/s", space)});
  }
  out.push_back({"valid", Stored::uint8, {nodes}, {{"values", "0 no, 1 yes"}}});
  return out;
}

Failure bad_name(const std::string& what, const std::string& name) {
  return refuse(what, name.empty() ? "an empty name" : "\"" + shown(name) + "\"");
}

Result<void> check_names(const std::vector<std::string>& names, const std::string& what) {
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    // A NUL would end the name in other programs.
    if (name.empty() || name.find('\0') != std::string::npos) return bad_name(what, name);
    if (!seen.insert(name).second) return bad_name(what + ", only once", name);
  }
  return {};
}

}  // namespace

EndSiteArrays end_site_arrays(const Skeleton& skeleton) {
  EndSiteArrays out;
  for (const EndSite& site : skeleton.end_sites) {
    out.parents.push_back(site.parent);
    out.offsets.push_back(site.offset);
  }
  return out;
}

std::size_t size_of(Stored stored) {
  switch (stored) {
    case Stored::float32:
    case Stored::int32:
      return 4;
    case Stored::float64:
    case Stored::int64:
      return 8;
    case Stored::uint8:
      break;
  }
  return 1;
}

std::uint64_t TakeColumn::row_values() const {
  std::uint64_t count = 1;
  for (const std::uint64_t size : shape) count *= size;
  return count;
}

std::string_view kind_of(const TakeGroup& group) {
  constexpr std::string_view kinds[] = {"clip", "points", "imu"};
  return kinds[group.kind.index()];
}

AnyRows rows_for(const TakeGroup& group) {
  if (std::holds_alternative<ClipGroup>(group.kind)) return ClipRows{};
  if (std::holds_alternative<PointGroup>(group.kind)) return PointRows{};
  return ImuRows{};
}

std::vector<std::string> gravity_texts(const ImuGroup& group) {
  std::vector<std::string> out;
  for (std::size_t node = 0; node < group.node_names.size(); ++node) {
    out.emplace_back(has_gravity(group, node) ? gravity_included : gravity_removed);
  }
  return out;
}

std::vector<TakeColumn> columns_of(const TakeGroup& group, Precision precision) {
  const Stored number = stored_number(precision);
  std::vector<TakeColumn> out;
  std::vector<std::uint64_t> times;
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    out = clip_columns(clip->skeleton, group, number);
  } else if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
    out = point_columns(points->joint_names.size(), group, number);
  } else {
    const auto& imu = std::get<ImuGroup>(group.kind);
    out = imu_columns(imu, number);
    // Each node has its own distance in time. All joints of a row share one distance.
    times = {imu.node_names.size()};
  }
  if (group.resampled) out.push_back({"nearest_raw_ns", Stored::int64, times, time_facts});
  if (group.interval_known) out.push_back({"time_interval_ns", Stored::int64, times, time_facts});
  return out;
}

const std::vector<std::string>& names_of(const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) return clip->skeleton.joint_names;
  if (const auto* points = std::get_if<PointGroup>(&group.kind)) return points->joint_names;
  return std::get<ImuGroup>(group.kind).node_names;
}

std::vector<std::string> labels_of(const TakeColumn& column, const TakeGroup& group) {
  if (column.shape.empty()) return {"row"};
  constexpr std::string_view none[] = {""}, vector[] = {".x", ".y", ".z"},
                             rotation[] = {".w", ".x", ".y", ".z"};
  std::span<const std::string_view> parts(none);
  // Four numbers form a rotation, and three form a vector.
  if (column.shape.size() > 1)
    parts = column.shape[1] == 4 ? std::span(rotation) : std::span<const std::string_view>(vector);
  std::vector<std::string> out;
  for (const std::string& name : names_of(group)) {
    for (const std::string_view part : parts) out.push_back(name + std::string(part));
  }
  return out;
}

std::string stream_json(const TakeGroup& group) {
  nlohmann::ordered_json out{
      {"name", group.name}, {"kind", kind_of(group)}, {"names", names_of(group)}};
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    const auto vector = [](const Vec3& v) { return std::array{v.x(), v.y(), v.z()}; };
    out["parents"] = clip->skeleton.parents;
    for (const Vec3& offset : clip->skeleton.rest_offsets) {
      out["rest_offsets"].push_back(vector(offset));
    }
    for (const EndSite& site : clip->skeleton.end_sites) {
      out["end_sites"].push_back({{"parent", site.parent}, {"offset", vector(site.offset)}});
    }
  }
  if (const auto* imu = std::get_if<ImuGroup>(&group.kind)) {
    out["root_node"] = imu->root_node;
    out["gravity"] = gravity_texts(*imu);
  }
  // Names may contain bytes that are not UTF-8. Each such byte becomes U+FFFD.
  return out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Result<void> validate(const TakeHeader& header) {
  std::vector<std::string> names;
  for (const TakeGroup& group : header.groups) {
    names.push_back(group.name);
    KA_TRY(check_stream_name(group.name));
    const auto* clip = std::get_if<ClipGroup>(&group.kind);
    if (clip != nullptr) KA_TRY(validate(clip->skeleton));
    const bool nodes = std::holds_alternative<ImuGroup>(group.kind);
    KA_TRY(check_names(names_of(group), nodes ? "a name for each node" : "a name for each joint"));
  }
  return check_names(names, "a name for each stream");
}

void NumberStore::check_numbers([[maybe_unused]] std::span<const double> values) {
  // A take must not contain NaN, because masks mark missing values.
  assert(std::none_of(values.begin(), values.end(), [](double v) { return std::isnan(v); }));
}

KA_EVERY_PROCESSOR
static void to_single(const double* from, float* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<float>(from[i]);
}

void NumberStore::narrow(std::span<const double> values) {
  to_single(values.data(), singles_.data(), values.size());
}

}  // namespace kinalign
