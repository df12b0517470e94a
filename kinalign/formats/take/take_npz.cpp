// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/take_npz.h"

#include <cassert>
#include <set>
#include <string_view>
#include <utility>

namespace kinalign {

namespace {

/// Arrays of known contents, and where they stand among all.
struct Fixed {
  std::size_t array;
  std::string bytes;
};

/// The members of the file, in order.
struct Members {
  std::vector<NpzArray> arrays;
  std::vector<Fixed> fixed;

  void add(NpzArray array, std::string_view bytes) {
    fixed.push_back({arrays.size(), std::string(bytes)});
    arrays.push_back(std::move(array));
  }
  void add_texts(const std::string& name, const std::vector<std::string>& texts) {
    NpzTexts made = npz_texts(name, texts);
    add(std::move(made.array), made.bytes);
  }
  void add_vectors(const std::string& name, const std::vector<Vec3>& vectors) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    const std::span numbers(reinterpret_cast<const double*>(vectors.data()), 3 * vectors.size());
    add(npz_numbers(name, Stored::float64, {vectors.size(), 3}), bytes_of(numbers));
  }
  template <class Value>
  void add_numbers(const std::string& name, Stored stored, std::vector<std::uint64_t> shape,
                   const std::vector<Value>& values) {
    add(npz_numbers(name, stored, std::move(shape)), bytes_of(std::span<const Value>(values)));
  }
};

void add_skeleton(Members& members, const std::string& prefix, const Skeleton& skeleton) {
  const std::uint64_t joints = skeleton.joints();
  members.add_texts(prefix + "joint_names", skeleton.joint_names);
  members.add_numbers(prefix + "parents", Stored::int32, {joints}, skeleton.parents);
  members.add_vectors(prefix + "rest_offsets", skeleton.rest_offsets);
  const EndSiteArrays sites = end_site_arrays(skeleton);
  members.add_numbers(prefix + "end_sites_parents", Stored::int32, {sites.parents.size()},
                      sites.parents);
  members.add_vectors(prefix + "end_sites_offsets", sites.offsets);
}

void add_names(Members& members, const std::string& prefix, const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    add_skeleton(members, prefix, clip->skeleton);
  } else if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
    members.add_texts(prefix + "joint_names", points->joint_names);
  } else {
    members.add_texts(prefix + "node_names", std::get<ImuGroup>(group.kind).node_names);
  }
}

/// A stream's name and an array's may make the same member as another stream's.
Result<void> check_names(const std::vector<NpzArray>& arrays, const std::string& path) {
  std::set<std::string_view> seen;
  for (const NpzArray& array : arrays) {
    if (seen.insert(array.name).second) continue;
    return Failure(Error{path, 0,
                         "streams whose arrays can be told apart (STREAM_ARRAY.npy): rename one",
                         "'" + shown(array.name) + "' twice"});
  }
  return {};
}

}  // namespace

Result<TakeNpzWriter> TakeNpzWriter::create(FileSystem& files, std::string path,
                                            Overwrite overwrite, const TakeHeader& header,
                                            NpzNames names) {
  assert(names == NpzNames::by_stream || header.groups.size() == 1);
  KA_TRY(validate(header));
  const Precision precision =
      header.parameters.align.store_double ? Precision::full : Precision::single;
  Members members;
  members.arrays.push_back(npz_numbers("time_ns", Stored::int64, {header.frames}));
  std::vector<std::vector<Column>> groups;
  for (const TakeGroup& group : header.groups) {
    const std::string prefix = names == NpzNames::plain ? "" : group.name + "_";
    auto& columns = groups.emplace_back();
    for (const TakeColumn& column : columns_of(group, precision)) {
      std::vector<std::uint64_t> shape{header.frames};
      shape.insert(shape.end(), column.shape.begin(), column.shape.end());
      columns.push_back({column.name, column.stored, members.arrays.size()});
      members.arrays.push_back(npz_numbers(prefix + column.name, column.stored, shape));
    }
    add_names(members, prefix, group);
  }
  KA_TRY(check_names(members.arrays, path));
  TakeNpzWriter out(KA_TRY(NpzWriter::create(files, std::move(path), overwrite, members.arrays)),
                    std::move(groups));
  for (const Fixed& fixed : members.fixed) {
    KA_TRY(out.writer_.append(fixed.array, fixed.bytes));
  }
  return out;
}

Result<void> TakeNpzWriter::append(const TakeSlab& slab) {
  KA_TRY(writer_.append(0, bytes_of(std::span<const Time>(slab.stamps))));
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    auto column = groups_[g].cbegin();
    const auto use = [&](std::string_view name, const auto& values) -> Result<void> {
      if (column == groups_[g].cend() || column->name != name) return {};
      const Column& to = *column++;
      const auto put = [&](std::string_view bytes) { return writer_.append(to.array, bytes); };
      const std::span given(values);
      if constexpr (std::is_same_v<typename decltype(given)::value_type, double>) {
        return numbers_.store(given, to.stored, put);
      } else {
        return put(bytes_of(given));
      }
    };
    KA_TRY(
        std::visit([&](const auto& rows) { return for_each_row_array(rows, use); }, slab.rows[g]));
    assert(column == groups_[g].cend());
  }
  return {};
}

}  // namespace kinalign
