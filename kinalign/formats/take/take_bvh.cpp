// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/take_bvh.h"

#include "kinalign/core/file_version.h"
#include "kinalign/formats/take/take_hdf5.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

/// Replaces the pose of each invalid row by the pose of the last valid row. Rows arrive in slabs
/// (blocks of rows), so the pose is kept between slabs.
class PoseHolder {
 public:
  explicit PoseHolder(std::size_t joints) : positions_(3 * joints), rotations_(4 * joints) {}

  /// Sets the pose for rows before the first valid row. The first pass calls it for each valid row,
  /// and only the first call has an effect.
  void begin_with(const ClipRows& rows, std::size_t i) {
    if (!std::exchange(known_, true)) keep(rows, i);
  }

  /// Second pass: replaces the invalid rows among the first `count` rows. The caller then writes
  /// the changed rows.
  void hold(ClipRows& rows, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (is_valid(rows, i)) {
        keep(rows, i);
      } else {
        std::copy(positions_.begin(), positions_.end(),
                  &rows.local_positions[i * positions_.size()]);
        std::copy(rotations_.begin(), rotations_.end(),
                  &rows.local_rotations[i * rotations_.size()]);
      }
    }
  }

  // An empty array means that all rows are valid. The stream then is the reference of the take.
  static bool is_valid(const ClipRows& rows, std::size_t i) {
    return rows.valid.empty() || rows.valid[i] != 0;
  }

 private:
  void keep(const ClipRows& rows, std::size_t i) {
    std::copy_n(&rows.local_positions[i * positions_.size()], positions_.size(),
                positions_.begin());
    std::copy_n(&rows.local_rotations[i * rotations_.size()], rotations_.size(),
                rotations_.begin());
  }

  std::vector<double> positions_, rotations_;
  bool known_ = false;
};

/// The number of rows and the times between them, from the first pass.
struct RowSurvey {
  std::uint64_t rows = 0, invalid = 0;
  Time first{}, last{};
  Duration shortest = Duration::max(), longest = Duration::min();  // time between neighbouring rows

  void add(const std::vector<Time>& stamps, const ClipRows& clip) {
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      if (rows++ == 0) {
        first = stamps[i];
      } else {
        shortest = std::min(shortest, stamps[i] - last);
        longest = std::max(longest, stamps[i] - last);
      }
      last = stamps[i];
      invalid += PoseHolder::is_valid(clip, i) ? 0 : 1;
    }
  }

  // A single row has no time to the next row, so 60 Hz is used.
  double step_s() const {
    return rows > 1 ? seconds(last - first) / static_cast<double>(rows - 1) : 1.0 / 60.0;
  }
};

/// The stream to write, which has the first skeleton of the take. `others`: the names of streams
/// with further skeletons.
struct Chosen {
  std::size_t group = 0;
  std::string name, others;
};

// Chooses the first skeleton in the order of the take.
Result<Chosen> choose(const TakeHeader& header, const std::string& path) {
  Chosen out;
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    const TakeGroup& group = header.groups[g];
    if (!std::holds_alternative<ClipGroup>(group.kind)) continue;
    if (out.name.empty()) {
      out.group = g;
      out.name = group.name;
    } else {
      out.others += (out.others.empty() ? "" : ", ") + group.name;
    }
  }
  if (!out.name.empty()) return out;
  return refuse(path, "a take with a skeleton", "none");
}

/// Findings about data of the take that the BVH file does not contain.
Findings lost(const std::string& path, const Chosen& chosen, const RowSurvey& survey) {
  Findings out;
  if (!chosen.others.empty()) {
    add_note(out, {path, 0, "one skeleton", chosen.name + ", " + chosen.others},
             chosen.name + " was written", "convert to .npz to keep all of them");
  }
  if (survey.invalid > 0) {
    add_warning(out,
                {path, 0, "valid rows of " + chosen.name,
                 fmt::format("{} of {} rows that are not valid", survey.invalid, survey.rows)},
                "these rows have the pose of the last valid row, because a BVH can't mark them");
  }
  const double step = survey.step_s();
  // Differences below 1 % are not reported.
  if (survey.rows > 2 && seconds(survey.longest - survey.shortest) > 0.01 * step) {
    add_warning(out,
                {path, 0, "evenly spaced stamps",
                 fmt::format("steps of {:.4g} to {:.4g} ms", 1e3 * seconds(survey.shortest),
                             1e3 * seconds(survey.longest))},
                fmt::format("the frame time is the mean step, {:.4g} ms", 1e3 * step));
  }
  return out;
}

/// Calls `use(stamps, rows of the group)` for all slabs of a take.
template <class Use>
Result<void> for_each_slab(TakeReader& reader, std::size_t group, Use&& use) {
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) KA_TRY(use(slab.stamps, std::get<ClipRows>(slab.rows[group])));
  return {};
}

// Checks the size of numbers, because a hostile take may contain any finite number.
Result<void> check_size(const std::string& path, const ClipRows& rows) {
  constexpr double largest = 1e12;  // m; a BVH file can contain this number in centimetres
  const auto small = [](double x) { return std::abs(x) < largest; };
  const auto& values = rows.local_positions;
  if (std::all_of(values.begin(), values.end(), small)) return {};
  return refuse(path, "positions below 1e12 m", "larger positions");
}

/// The results of the first pass: channels of the skeleton, number of invalid rows, times between
/// rows.
struct FirstPass {
  FirstPass(Chosen stream, const Skeleton& skeleton)
      : chosen(std::move(stream)),
        channels(skeleton),
        holder(skeleton.joints()),
        row(3 * skeleton.joints()) {}

  Chosen chosen;
  BvhChannels channels;
  PoseHolder holder;
  RowSurvey survey;
  std::size_t row;  // number of values in a row of positions

  void add(const std::vector<Time>& stamps, const ClipRows& rows) {
    survey.add(stamps, rows);
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      // Invalid rows contain zeros, which are not movements.
      if (!PoseHolder::is_valid(rows, i)) continue;
      holder.begin_with(rows, i);
      channels.see(std::span(rows.local_positions).subspan(i * row, row));
    }
  }
};

// The first pass. Skeleton and channels are known only after all rows.
Result<FirstPass> look_through(FileSystem& files, const std::string& path) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  const Chosen chosen = KA_TRY(choose(reader.header(), path));
  FirstPass pass(chosen, std::get<ClipGroup>(reader.header().groups[chosen.group].kind).skeleton);
  KA_TRY(for_each_slab(reader, chosen.group, [&](const auto& stamps, const ClipRows& rows) {
    pass.add(stamps, rows);
    return check_size(path, rows);
  }));
  // Without a valid row, no pose can be written.
  if (pass.survey.rows == 0 || pass.survey.invalid < pass.survey.rows) return pass;
  return refuse(path, "a valid row of " + chosen.name, "none");
}

}  // namespace

Result<Findings> take_to_bvh(FileSystem& files, const std::string& from, const FileSink& sink) {
  // Both passes must read the same file, so its version is compared.
  const auto version = version_of(from);
  FirstPass pass = KA_TRY(look_through(files, from));
  const RowSurvey& survey = pass.survey;
  BvhWriter writer(pass.channels.hierarchy(survey.rows, survey.step_s()), survey.rows, 6, sink);
  // The second pass opens the file again, in order to begin at the first row.
  TakeReader reader = KA_TRY(TakeReader::open(files, from));
  KA_TRY(unchanged(from, version));
  std::vector<double> values;
  KA_TRY(for_each_slab(reader, pass.chosen.group, [&](const auto& stamps, ClipRows& rows) {
    pass.holder.hold(rows, stamps.size());
    values.clear();
    pass.channels.append(rows.local_positions, rows.local_rotations, values);
    return writer.append(values);
  }));
  KA_TRY(writer.finish());
  return lost(from, pass.chosen, survey);
}

}  // namespace kinalign
