// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/eval/comparison.h"
#include "apps/kinalign/learn/eval_methods.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/compare/denoise_marks.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// `kinalign benchmark` has the same limit, so both use the same stretches.
constexpr std::size_t least_rows = 8;  // frames; shorter stretches are left out

/// The marks of a method on a tested stretch: of its plain answer and of its steadied answer. An
/// answer is steadied by smoothing, constant bones and the answer to the mirrored input (Steadier).
struct Marked {
  std::string take, subject;
  std::array<DenoiseMarks, 2> marks;  // [0] plain, [1] steadied
};

/// Calls use(mark) for every mark, in the order of the cached texts. If this order or the meaning
/// of a mark changes, cache_version in eval.cpp must change, too.
void each_mark(auto& marks, const auto& use) {
  const auto all = [&](auto&... each) { (use(each), ...); };
  auto& p = marks.protocol;
  auto& t = marks.table_nine;
  all(p.position_cm, p.fitted_cm, p.bone_cm, p.constancy_cm);
  all(p.acceleration_mm, p.jitter_mm, p.true_jitter_mm);
  all(t.position, t.bone, t.smooth, t.true_smooth);
  all(marks.hand_cm, marks.feet.contacts, marks.feet.skate_m_s, marks.feet.true_skate_m_s);
  all(marks.radii[0], marks.radii[1], marks.radii[2]);
  all(marks.joint_cm, marks.lag_ms, marks.amplitude);
}

/// A mark in the cache. A missing mark is null.
Json json_of(const auto& number) { return number; }
Json json_of(const std::optional<double>& mark) { return mark ? Json(*mark) : Json(); }
/// The marks of joints in the cache: one entry for each shared joint.
Json json_of(const std::array<std::optional<double>, shared_joint_count>& joints) {
  Json out = Json::array();
  for (const auto& one : joints) out.push_back(json_of(one));
  return out;
}
/// The radii in the cache. The whole histogram is stored, because one_radius_m() of several
/// stretches does not follow from their means.
Json json_of(const RadiusMarks& radii) {
  return {radii.cells, radii.within, radii.sum_m, radii.errors};
}

/// Reads what json_of() wrote. Throws if the JSON has another type; read_marks() catches it.
void read_mark(const Json& json, auto& number) { json.get_to(number); }
void read_mark(const Json& json, std::optional<double>& mark) {
  mark = json.is_null() ? std::nullopt : std::optional(json.get<double>());
}
void read_mark(const Json& json, std::array<std::optional<double>, shared_joint_count>& joints) {
  for (std::size_t j = 0; j < joints.size(); ++j) read_mark(json.at(j), joints[j]);
}
void read_mark(const Json& json, RadiusMarks& radii) {
  json.at(0).get_to(radii.cells);
  json.at(1).get_to(radii.within);
  json.at(2).get_to(radii.sum_m);
  json.at(3).get_to(radii.errors);
}

Json marks_json(const DenoiseMarks& marks) {
  Json out = Json::array();
  each_mark(marks, [&](const auto& mark) { out.push_back(json_of(mark)); });
  return out;
}

DenoiseMarks marks_of(const Json& json) {
  DenoiseMarks out;
  std::size_t next = 0;
  each_mark(out, [&](auto& mark) { read_mark(json.at(next++), mark); });
  return out;
}

/// The text for the cache: an array with take, person, plain marks and steadied marks of each
/// stretch.
std::string written_marks(const std::vector<Marked>& all) {
  Json out = Json::array();
  for (const Marked& one : all) {
    out.push_back({one.take, one.subject, marks_json(one.marks[0]), marks_json(one.marks[1])});
  }
  return out.dump();
}

/// Reads the marks of a cached text. Returns nothing if the text is damaged or has other content; a
/// text of marks has at least one stretch.
std::vector<Marked> read_marks(const std::string& text) {
  try {
    std::vector<Marked> out;
    for (const Json& one : Json::parse(text)) {
      out.push_back({one.at(0).get<std::string>(),
                     one.at(1).get<std::string>(),
                     {marks_of(one.at(2)), marks_of(one.at(3))}});
    }
    return out;
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

/// Lists each take once, with its person, action and part of the split. A take with gaps has
/// several pairs; the first pair adds it to the list.
std::vector<FoldTake> takes_of(const Pairs& pairs) {
  std::vector<FoldTake> out;
  std::set<std::string> known;
  for (const Pair& pair : pairs.all) {
    if (known.insert(pair.take).second) {
      out.push_back({pair.take, pair.subject, pair.action, run_of(pair.take), pair.part});
    }
  }
  return out;
}

/// The data for methods with the same joints, and the object that computes their marks. Methods
/// that are trained here have the data's joints; a finished model may have others.
struct Bench {
  Pairs pairs;
  DenoiseLayout layout;
  DenoiseMarker marker;
};

/// Makes a Bench. The marker copies what it needs, so the pairs may be moved afterwards.
Result<Bench> bench_of(Pairs pairs, DenoiseLayout layout, MarkedIn marked_in) {
  DenoiseMarker marker = KA_TRY(DenoiseMarker::make(layout, pairs.all, marked_in));
  return Bench{std::move(pairs), std::move(layout), std::move(marker)};
}

/// The data, read once, and the coordinates in which errors are measured. All trials share it.
/// `windows` is kept for models with other joints.
struct BenchData {
  Windows windows;
  std::string input, truth;
  MarkedIn marked_in = MarkedIn::space;
  Bench own;  // for the joints of the data
};

/// The data with the joints of a finished model, which are found by name. Fails if the frame rates
/// differ by more than 1 %: the model would see the motion too fast or too slow.
Result<Bench> bench_of_model(const DenoiseLayout& layout, const BenchData& data) {
  if (std::abs(data.own.layout.rate_hz - layout.rate_hz) > 0.01 * layout.rate_hz) {
    return Failure(Error{"--rate", 0, fmt::format("{:g} Hz, the model's", layout.rate_hz),
                         fmt::format("{:g}", data.own.layout.rate_hz)});
  }
  // This object has no stretches. It only states the joints, their parents and the frame rate.
  const Pairs joints{layout.inputs, layout.outputs, layout.rate_hz, layout.parents};
  return bench_of(KA_TRY(pairs_for(data.windows, data.input, data.truth, joints, least_rows)),
                  layout, data.marked_in);
}

/// Marks each tested stretch twice: with the plain answer and with the steadied answer. `tested`:
/// names of takes. Stretches of other takes are for training.
Result<std::string> marks_on(const Bench& bench, const Answer& answer,
                             const std::vector<std::string>& tested) {
  // All methods are steadied with the default settings, so only their answers differ.
  const Steadier steadier({}, bench.layout);
  std::vector<Marked> out;
  for (const Pair& pair : bench.pairs.all) {
    if (std::find(tested.begin(), tested.end(), pair.take) == tested.end()) continue;
    out.push_back({pair.take, pair.subject,
                   both_marks(bench.marker, steadier, answer, pair, answer(pair.input))});
  }
  return written_marks(out);
}

/// Marks a method or a finished model. If a model has other joints than the data, the marks are
/// those of the model's joints.
Result<std::string> marks_of_trial(const Trial& trial, const BenchData& data, Call& call) {
  // make_answer() fits the method here, or lets kinalign-learn train it.
  if (trial.model.empty()) {
    const Answer answer =
        KA_TRY(make_answer({data.own.layout, data.own.pairs.all, trial.training}, call));
    return marks_on(data.own, answer, trial.tested);
  }
  const std::string bytes =
      KA_TRY(read_whole(call.surroundings.files, trial.model, most_model_bytes));
  const DenoiseLayout layout = KA_TRY(read_denoise_model(bytes, trial.model)).layout;
  const Answer answer = KA_TRY(answer_of_model(bytes, trial.model));
  // If the model has the joints of the data in the same order, the data can be used as it is.
  if (layout.inputs == data.own.layout.inputs && layout.outputs == data.own.layout.outputs) {
    return marks_on(data.own, answer, trial.tested);
  }
  return marks_on(KA_TRY(bench_of_model(layout, data)), answer, trial.tested);
}

/// Stretches that give one value of the table together. The pointers lead to elements of the
/// caller's vector.
using Group = std::vector<const Marked*>;

/// Groups the marks by fold, or by person if there is a single fold. One fold would give a single
/// value without a deviation.
std::map<std::string, Group> groups_of(const std::vector<FoldMarks>& folds,
                                       const std::vector<std::vector<Marked>>& marks) {
  std::map<std::string, Group> out;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    for (const Marked& one : marks[f]) {
      out[folds.size() > 1 ? folds[f].fold : one.subject].push_back(&one);
    }
  }
  return out;
}

/// The key of a joint's column in the table of joints: "WristLeft_cm".
std::string joint_key(std::size_t joint) { return std::string(shared_joints[joint]) + "_cm"; }

/// Adds the means of E_p, E_b and E_s, the columns of table 9 in the HFUT-MMD paper. Each stretch
/// has the same weight; in `kinalign benchmark` each frame has the same weight.
void add_table_nine(const std::string& name, const Group& group, std::size_t which,
                    MethodMarks& out) {
  Mean position, bone, smooth;
  for (const Marked* one : group) {
    const TableNine& marks = one->marks[which].table_nine;
    position.add(marks.position);
    bone.add(marks.bone);
    smooth.add(marks.smooth);
  }
  out.marks["table_9_position_cm2"][name].add(position.value_or(0.0));
  out.marks["table_9_bone_cm"][name].add(bone.value_or(0.0));
  out.marks["table_9_smooth_cm"][name].add(smooth.value_or(0.0));
}

/// Adds the means of a group. `which`: the index in Marked::marks. Skating is weighted by the
/// number of frames in which a foot stands. If no stretch of the group has a mark, the table's cell
/// is empty.
void add_group(const std::string& name, const Group& group, std::size_t which, MethodMarks& out) {
  std::vector<ProtocolMarks> marks;
  double skate = 0.0, contacts = 0.0;
  // The radii of all parts of the body are added up. Those of each part are kept, too.
  RadiusMarks radii;
  Mean hands, lag, amplitude;
  std::array<Mean, shared_joint_count> joints{};
  for (const Marked* one : group) {
    const DenoiseMarks& m = one->marks[which];
    marks.push_back(m.protocol);
    for (std::size_t g = 0; g < m.radii.size(); ++g) {
      if (m.radii[g].cells == 0) continue;
      radii.add(m.radii[g]);
      out.radii[std::string(radius_groups[g])].add(m.radii[g]);
    }
    // A stretch without this mark does not count.
    const auto add = [](const std::optional<double>& value, Mean& to) {
      if (value) to.add(*value);
    };
    add(m.hand_cm, hands);
    add(m.lag_ms, lag);
    add(m.amplitude, amplitude);
    for (std::size_t j = 0; j < joints.size(); ++j) add(m.joint_cm[j], joints[j]);
    // The factor 100 turns metres into centimetres. Skating exists only in frames in which a foot
    // of the truth stands.
    const auto standing = static_cast<double>(m.feet.contacts);
    skate += 100.0 * m.feet.skate_m_s * standing;
    contacts += standing;
  }
  // protocol_row() computes the means. Its jitter is the ratio of two means.
  const ProtocolMeans row = protocol_row(marks);
  const auto put = [&](const std::string& key, const std::optional<double>& value) {
    if (value) out.marks[key][name].add(*value);
  };
  put("mpjpe_cm", row.position_cm);
  put("pa_mpjpe_cm", row.fitted_cm);
  put("bone_cm", row.bone_cm);
  put("constancy_cm", row.constancy_cm);
  put("acceleration_mm", row.acceleration_mm);
  put("jitter", row.jitter);
  // A method that states no radii gets an empty cell, since 0 % would mean that every error is too
  // large.
  if (radii.cells > 0) {
    put("covered_percent", 100.0 * radii.covered());
    put("radius_cm", 100.0 * radii.mean_radius_m());
  }
  put("hand_cm", hands.value());
  put("lag_ms", lag.value());
  put("amplitude", amplitude.value());
  add_table_nine(name, group, which, out);
  for (std::size_t j = 0; j < joints.size(); ++j) put(joint_key(j), joints[j].value());
  if (contacts > 0.0) put("skate_cm_s", skate / contacts);
}

/// Makes two rows for a method: [0] its plain answers, [1] its steadied answers.
std::vector<MethodMarks> sum_up(const std::string& name, const std::vector<FoldMarks>& folds) {
  std::vector<std::vector<Marked>> marks;
  for (const FoldMarks& fold : folds) {
    marks.emplace_back();
    // Each seed gives one text. The stretches of all seeds go into the same group, whose mean is
    // taken.
    for (const std::string& text : fold.texts) {
      for (Marked& one : read_marks(text)) marks.back().push_back(std::move(one));
    }
  }
  const auto groups = groups_of(folds, marks);
  // There is no group if no text could be read.
  if (groups.empty()) return {};
  std::vector<MethodMarks> out{{name, ""}, {name, "steadied"}};
  for (const auto& [who, group] : groups) {
    for (std::size_t which = 0; which < out.size(); ++which) {
      add_group(who, group, which, out[which]);
    }
  }
  return out;
}

}  // namespace

Result<Comparison> denoise_comparison(const Eval& o, const std::string& bytes,
                                      const std::string& file) {
  Windows windows = KA_TRY(read_windows(bytes, file));
  const std::string input = rough_stream(o.input, Learns::denoise);
  Pairs pairs = KA_TRY(pairs_of(windows, input, o.truth, least_rows));
  DenoiseLayout layout = KA_TRY(eval_layout(pairs));
  const MarkedIn marked_in = o.own_root ? MarkedIn::own_root : MarkedIn::space;
  Bench own = KA_TRY(bench_of(std::move(pairs), std::move(layout), marked_in));
  // The functions below share the data, because they use it after this function has returned.
  const auto data = std::make_shared<BenchData>(
      BenchData{std::move(windows), input, o.truth, marked_in, std::move(own)});
  Comparison out;
  out.dataset = data->windows.facts.dataset;
  out.takes = takes_of(data->own.pairs);
  out.columns = {{"mpjpe_cm", "position, cm", 2},
                 {"pa_mpjpe_cm", "fitted, cm", 2},
                 {"bone_cm", "bones, cm", 2},
                 {"constancy_cm", "constancy, cm", 2},
                 {"acceleration_mm", "acceleration, mm/frame²", 2},
                 {"jitter", "jitter, × truth", 2},
                 {"covered_percent", "within 90 % radius, %", 1},
                 {"radius_cm", "90 % radius, cm", 1},
                 {"hand_cm", "wrists, cm", 2},
                 {"skate_cm_s", "standing feet, cm/s", 2},
                 {"lag_ms", "lag, ms", 1},
                 {"amplitude", "amplitude, × truth", 3},
                 {"table_9_position_cm2", "E_p, cm²", 1},
                 {"table_9_bone_cm", "E_b, cm", 2},
                 {"table_9_smooth_cm", "E_s, cm", 3}};
  // The joints have their own table, because the first table would become too wide.
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    out.joints.push_back({joint_key(j), std::string(shared_joints[j]), 1});
  }
  // With a split or folds of people, values belong to people. With other folds, values belong to
  // folds.
  const bool by_people = !o.split.empty() || o.folds == "people" || o.folds == "split";
  out.over = by_people ? "people" : "folds";
  out.mark = [data](const Trial& trial, Call& call) { return marks_of_trial(trial, *data, call); };
  out.sum_up = sum_up;
  return out;
}

}  // namespace kinalign
