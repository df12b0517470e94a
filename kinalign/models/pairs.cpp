// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pairs.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/motion/kinect_joints.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

/// If fewer joints of a stream have the name of a Kinect's joint, the stream is not from a Kinect.
constexpr std::size_t least_known = 10;

/// The joint names of a stream. Fails if there is no such stream or it has no names; the message
/// lists the known streams.
Result<std::vector<std::string>> joints_of(const Windows& windows, const std::string& stream) {
  const WindowsFacts::Stream* found = windows.facts.find(stream);
  if (found != nullptr && !found->names.empty()) return found->names;
  std::string known;
  for (const auto& one : windows.facts.streams) {
    known += known.empty() ? "" : ", ";
    known += one.name;
  }
  return Failure(Error{"", 0, "a stream \"" + stream + "\" with names", known});
}

/// The state of each joint (0, 1, 2), from the array "state" if there is one, else from "valid".
/// A stream may have both arrays, one or none. Without both, all joints count as tracked. If
/// "valid" is 0, the joint is missing, whatever "state" says.
std::vector<std::uint8_t> seen_of(const StretchStream& stream, std::size_t rows,
                                  std::size_t joints) {
  std::vector<std::uint8_t> out(rows * joints, 2);
  const auto valid = stream.arrays.find("valid"), state = stream.arrays.find("state");
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (state != stream.arrays.end() && state->second.size() == out.size()) {
      out[i] = static_cast<std::uint8_t>(std::clamp(state->second[i], 0.0F, 2.0F));
    }
    if (valid == stream.arrays.end()) continue;
    const bool one_flag = valid->second.size() == rows;  // one flag for the whole skeleton
    if (!one_flag && valid->second.size() != out.size()) continue;
    if (valid->second[one_flag ? i / joints : i] == 0.0F) out[i] = 0;
  }
  return out;
}

/// The chosen input joints: their Kinect names and their places in the stream.
struct Chosen {
  std::vector<std::string> names;
  std::vector<std::size_t> places;
};

/// The joints that a Kinect has, under its names; all joints if these are too few.
Chosen choose(const std::vector<std::string>& joints) {
  const auto names = kinect_names(joints);
  Chosen known, all;
  for (std::size_t j = 0; j < names.size(); ++j) {
    all.names.push_back(names[j]);
    all.places.push_back(j);
    if (std::find(kinect_joints.begin(), kinect_joints.end(), names[j]) == kinect_joints.end()) {
      continue;
    }
    known.names.push_back(names[j]);
    known.places.push_back(j);
  }
  return known.names.size() < least_known ? all : known;
}

/// The positions [T,J,3] of a stream in a stretch; null if absent or of another number of joints.
const std::vector<float>* positions_of(const Stretch& stretch, const std::string& stream,
                                       std::size_t joints) {
  const auto found = stretch.streams.find(stream);
  if (found == stretch.streams.end()) return nullptr;
  const auto positions = found->second.arrays.find("positions");
  if (positions == found->second.arrays.end()) return nullptr;
  return positions->second.size() == stretch.rows * joints * 3 ? &positions->second : nullptr;
}

/// Copies the chosen joints out of rows of all joints, `values` numbers per joint.
template <class Value>
std::vector<Value> chosen_of(const std::vector<Value>& all, const Chosen& chosen,
                             std::size_t joints, std::size_t values) {
  std::vector<Value> out;
  for (std::size_t row = 0; row + joints * values <= all.size(); row += joints * values) {
    for (const std::size_t j : chosen.places) {
      const auto at = all.begin() + static_cast<std::ptrdiff_t>(row + j * values);
      out.insert(out.end(), at, at + static_cast<std::ptrdiff_t>(values));
    }
  }
  return out;
}

/// Sets non-finite numbers of missing joints to 0. Fails if a joint that is not missing has one.
/// Other programs often write NaN where nothing was measured. A single NaN in a batch would spread
/// to all weights.
Result<void> check_numbers(const std::vector<std::uint8_t>& there, const std::string& stream,
                           std::vector<float>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (std::isfinite(positions[i])) continue;
    if (there[i / 3] != 0) {
      return Failure(Error{"", 0, "finite positions of " + stream + " where they are valid",
                           "a NaN or an infinity"});
    }
    positions[i] = 0.0F;
  }
  return {};
}

/// Fills the names of take, person, action and part.
void name_pair(const Windows& windows, const Stretch& stretch, Pair& pair) {
  if (stretch.take < windows.facts.takes.size()) {
    const WindowsFacts::Take& take = windows.facts.takes[stretch.take];
    pair.take = take.name;
    pair.subject = take.subject;
    pair.action = take.action;
  }
  if (stretch.part < windows.facts.parts.size()) pair.part = windows.facts.parts[stretch.part];
}

}  // namespace

Result<Pairs> pairs_of(const Windows& windows, const std::string& input, const std::string& truth,
                       std::size_t least) {
  const auto joints = KA_TRY(joints_of(windows, input));
  const Chosen chosen = choose(joints);
  // This is not one braced list, because GCC leaks its earlier members if a later one returns
  // early.
  auto outputs = KA_TRY(joints_of(windows, truth));
  Pairs out{
      .inputs = chosen.names, .outputs = std::move(outputs), .rate_hz = windows.facts.rate_hz};
  const std::vector<int>& parents = windows.facts.find(truth)->parents;
  if (parents.size() == out.outputs.size()) out.parents = parents;
  const std::string missing = "positions of all joints of " + input + " and " + truth;
  for (const Stretch& stretch : windows.stretches) {
    if (stretch.rows < least) continue;
    const auto* rough = positions_of(stretch, input, joints.size());
    const auto* precise = positions_of(stretch, truth, out.outputs.size());
    // The manifest lists both streams, so a stretch without one of them means a damaged file.
    if (rough == nullptr || precise == nullptr) {
      return Failure(Error{"", 0, missing, "none"});
    }
    Pair pair;
    pair.input.joints = out.inputs.size();
    pair.input.positions = chosen_of(*rough, chosen, joints.size(), 3);
    pair.input.seen = chosen_of(seen_of(stretch.streams.at(input), stretch.rows, joints.size()),
                                chosen, joints.size(), 1);
    pair.truth = *precise;
    pair.valid = seen_of(stretch.streams.at(truth), stretch.rows, out.outputs.size());
    for (std::uint8_t& one : pair.valid) one = one == 0 ? 0 : 1;
    KA_TRY(check_numbers(pair.input.seen, input, pair.input.positions));
    KA_TRY(check_numbers(pair.valid, truth, pair.truth));
    name_pair(windows, stretch, pair);
    out.all.push_back(std::move(pair));
  }
  return out;
}

Result<Pairs> pairs_for(const Windows& windows, const std::string& input, const std::string& truth,
                        const Pairs& joints, std::size_t least) {
  // Only names, rate and parents are taken over; pairs come from this file.
  Pairs out = joints;
  out.all.clear();
  for (const Stretch& stretch : windows.stretches) {
    if (stretch.rows < least) continue;
    Pair pair;
    pair.input = KA_TRY(kinect_frames(windows, stretch, input, joints.inputs));
    JointFrames precise = KA_TRY(kinect_frames(windows, stretch, truth, joints.outputs));
    pair.truth = std::move(precise.positions);
    for (const std::uint8_t seen : precise.seen) pair.valid.push_back(seen == 0 ? 0 : 1);
    name_pair(windows, stretch, pair);
    out.all.push_back(std::move(pair));
  }
  return out;
}

Result<JointFrames> kinect_frames(const Windows& windows, const Stretch& stretch,
                                  const std::string& stream,
                                  const std::vector<std::string>& wanted) {
  const auto names = kinect_names(KA_TRY(joints_of(windows, stream)));
  const auto wanted_names = kinect_names(wanted);
  const auto* positions = positions_of(stretch, stream, names.size());
  if (positions == nullptr) return Failure(Error{"", 0, "positions of " + stream, "none"});
  const auto seen = seen_of(stretch.streams.at(stream), stretch.rows, names.size());
  JointFrames out{wanted.size(), std::vector<float>(stretch.rows * wanted.size() * 3, 0.0F),
                  std::vector<std::uint8_t>(stretch.rows * wanted.size(), 0)};
  // Joint by joint, because each may be at another place of the stream, or absent.
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const auto j = index_of(names, wanted_names[k]);
    if (!j) continue;
    for (std::size_t t = 0; t < stretch.rows; ++t) {
      const std::size_t from = t * names.size() + *j, to = t * wanted.size() + k;
      out.seen[to] = seen[from];
      if (seen[from] != 0) std::copy_n(&(*positions)[3 * from], 3, &out.positions[3 * to]);
    }
  }
  KA_TRY(check_numbers(out.seen, stream, out.positions));
  return out;
}

}  // namespace kinalign
