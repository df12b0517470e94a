// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/twin/twin_plan.h"

#include "kinalign/dataset/twin/twin_actions.h"
#include "kinalign/simulate/random.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace kinalign {

namespace {

// Fixed times replace the time of day, so that the same plan gives the same bytes.
constexpr std::int64_t first_start_ns = 1'790'000'000'000'000'000;
constexpr std::int64_t take_spacing_ns = 120'000'000'000;
// These sizes were measured on takes of 30 s (docs/benchmark.md).
constexpr std::uint64_t bytes_a_frame = 1900, kinect_bytes_a_frame = 800, imu_bytes_a_frame = 450;
constexpr std::uint64_t bytes_a_take = 40'000;

/// A seed below 2^52. Every JSON parser reads such a number exactly.
std::uint64_t derived(std::uint64_t seed, std::uint64_t stream, std::uint64_t number) {
  return mix64(mix64(mix64(seed) ^ stream) + number) >> 12;
}

std::uint64_t scaled(std::uint64_t frames, double scale) {
  return static_cast<std::uint64_t>(std::llround(static_cast<double>(frames) * scale));
}

void add(const ModalityFrames& from, ModalityFrames& to) {
  to.mocap += from.mocap;
  to.kinect += from.kinect;
  to.imu += from.imu;
}

/// The number of a person's id: 7 for "07".
std::uint64_t person_number(std::string_view id) {
  const auto digit = [&](std::size_t i) { return static_cast<std::uint64_t>(id[i] - '0'); };
  return 10 * digit(0) + digit(1);
}

/// Gives people, actions and runs to the takes, in turn.
class TwinPlanner {
 public:
  explicit TwinPlanner(std::uint64_t seed) : seed_(seed) {}

  void add_take(const PaperCell& cell, std::uint64_t frames) {
    const PaperPeople& people = paper_people[cell.people];
    // People and actions take turns separately, so that every person does many actions.
    const auto actions = twin_actions_of(paper_classes[cell.of_class].id);
    TwinTake take;
    const std::string_view id = people.ids[next_person_[cell.people]++ % people.count()];
    take.name.subject = id;
    take.name.action = actions[next_action_[cell.of_class]++ % actions.size()]->id;
    take.name.run = ++runs_[{take.name.subject, take.name.action}];
    take.people = cell.people;
    take.of_class = cell.of_class;
    take.kinect = cell.kinect;
    take.imu = cell.imu;
    take.frames = frames;
    // Streams 131 and 132 make both seeds independent of each other and of the movements (stream
    // 130).
    take.seed = derived(seed_, 131, takes_.size());
    take.person_seed = derived(seed_, 132, person_number(id));
    take.start_ns = first_start_ns + take_spacing_ns * static_cast<std::int64_t>(takes_.size());
    takes_.push_back(std::move(take));
  }
  std::vector<TwinTake> takes() && { return std::move(takes_); }

 private:
  std::uint64_t seed_;
  std::vector<TwinTake> takes_;
  std::array<std::size_t, paper_people.size()> next_person_{};
  std::array<std::size_t, paper_classes.size()> next_action_{};
  // The last run so far of each person and action.
  std::map<std::pair<std::string, std::string>, std::uint32_t> runs_;
};

}  // namespace

std::vector<TwinTake> plan_twin(const TwinOptions& options) {
  TwinPlanner planner(options.seed);
  for (const PaperCell& cell : paper_cells()) {
    // Each cell gets at least one take, even if the scaled number of frames is below 1.
    const std::uint64_t wanted = scaled(cell.frames, options.scale);
    const std::uint64_t count =
        std::max<std::uint64_t>(1, (wanted + longest_twin_take - 1) / longest_twin_take);
    for (std::uint64_t i = 0; i < count; ++i) {
      // The differences of rounded sums add up exactly to the wanted number of frames.
      const std::uint64_t frames = wanted * (i + 1) / count - wanted * i / count;
      planner.add_take(cell, std::max(frames, shortest_twin_take));
    }
  }
  return std::move(planner).takes();
}

ModalityFrames TwinCounts::sum() const {
  ModalityFrames out;
  // The sums over classes equal those over people.
  for (const ModalityFrames& row : classes) add(row, out);
  return out;
}

void count(const TwinTake& take, std::uint64_t frames, TwinCounts& counts) {
  const ModalityFrames row{frames, take.kinect ? frames : 0, take.imu ? frames : 0};
  // `choice` is an index into device_choices.
  const std::size_t choice = !take.imu ? 0 : take.kinect ? 2 : 1;
  add(row, counts.people[take.people]);
  add(row, counts.classes[take.of_class]);
  add(row, counts.choices[choice]);
  ++counts.takes[choice];
}

TwinCounts paper_counts(double scale) {
  TwinCounts out;
  const auto of_table = [scale](const ModalityFrames& row) {
    return ModalityFrames{scaled(row.mocap, scale), scaled(row.kinect, scale),
                          scaled(row.imu, scale)};
  };
  for (std::size_t i = 0; i < paper_people.size(); ++i) {
    out.people[i] = of_table(paper_people[i].frames);
  }
  for (std::size_t i = 0; i < paper_classes.size(); ++i) {
    out.classes[i] = of_table(paper_classes[i].frames);
  }
  // The paper does not count frames by choice of devices. These counts follow from our division.
  TwinCounts whole;
  for (const PaperCell& cell : paper_cells()) {
    TwinTake take;
    take.kinect = cell.kinect;
    take.imu = cell.imu;
    count(take, cell.frames, whole);
  }
  for (std::size_t i = 0; i < whole.choices.size(); ++i) {
    out.choices[i] = of_table(whole.choices[i]);
  }
  return out;
}

/// An estimate from measured sizes, so that the user can be asked before the disk is full.
std::uint64_t bytes_of(const std::vector<TwinTake>& takes) {
  std::uint64_t bytes = 0;
  for (const TwinTake& take : takes) {
    const std::uint64_t each = bytes_a_frame + (take.kinect ? kinect_bytes_a_frame : 0) +
                               (take.imu ? imu_bytes_a_frame : 0);
    bytes += bytes_a_take + take.frames * each;
  }
  return bytes;
}

std::string twin_json(const TwinOptions& options, const std::vector<std::string>& motions,
                      const std::vector<TwinTake>& takes) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const TwinTake& take : takes) {
    list.push_back({{"name", to_string(take.name)},
                    {"frames", take.frames},
                    {"kinect", take.kinect},
                    {"imu", take.imu},
                    {"seed", take.seed},
                    {"person_seed", take.person_seed},
                    {"start_ns", take.start_ns}});
  }
  const Json all{{"schema", "kinalign.twin/1"},
                 {"scale", options.scale},
                 {"seed", options.seed},
                 {"motions", motions},
                 {"takes", list}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kinalign
