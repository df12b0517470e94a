// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/shard_export.h"

#include "kinalign/dataset/export/csv_write.h"
#include "kinalign/formats/take/take_npz.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// A member of a sample: the end of its name, and its bytes.
struct Npy {
  std::string ending, bytes;
};

/// The members of a sample with their headers, but without values.
std::vector<Npy> heads_of(const TakeHeader& header) {
  std::vector<Npy> out;
  const auto add = [&](const std::string& name, Stored stored, std::vector<std::uint64_t> shape) {
    // The number of rows is known in advance, so the headers can be written before the values.
    shape.insert(shape.begin(), header.frames);
    out.push_back({name + ".npy", npy_header(npz_numbers(name, stored, shape))});
  };
  add("time_ns", Stored::int64, {});
  for (const TakeGroup& group : header.groups) {
    for (const TakeColumn& column : columns_of(group, precision_of(header))) {
      add(group.name + "_" + column.name, column.stored, column.shape);
    }
  }
  return out;
}

/// Appends the values of a slab. Arrays that the stream does not have have no member.
Result<void> add_values(const TakeHeader& header, const TakeSlab& slab, NumberStore& numbers,
                        std::vector<Npy>& members) {
  members.front().bytes += bytes_of(std::span<const Time>(slab.stamps));
  auto member = members.begin() + 1;
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    // The members were made from these columns, in the same order.
    const auto columns = columns_of(header.groups[g], precision_of(header));
    auto column = columns.begin();
    const auto use = [&](std::string_view name, const auto& values) -> Result<void> {
      // Arrays and members are in the same order; an array without a member is skipped.
      if (column == columns.end() || column->name != name) return {};
      // The values follow the header of their member; slabs are appended in order.
      std::string& bytes = (member++)->bytes;
      const Stored stored = (column++)->stored;
      const std::span given(values);
      if constexpr (std::is_same_v<typename decltype(given)::value_type, double>) {
        return numbers.store(given, stored, [&bytes](std::string_view piece) -> Result<void> {
          bytes += piece;
          return {};
        });
      } else {
        bytes += bytes_of(given);
        return {};
      }
    };
    KA_TRY(
        std::visit([&](const auto& rows) { return for_each_row_array(rows, use); }, slab.rows[g]));
  }
  return {};
}

/// The JSON member of a sample.
std::string sample_json(const ExportedTake& take, const SampleFacts& facts) {
  Json out{{"name", to_string(take.name())},
           {"class", facts.class_id},
           {"part", facts.part},
           {"rate_hz", take.rate_hz()}};
  out.update(Json::parse(streams_json(take.header())));
  // Subject and action are the ids in the take's name, so that samples can be grouped by them.
  out["subject"] = take.name().subject;
  out["action"] = take.name().action;
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

/// An open shard. The writer refers to this object to count the bytes, so the object must not move.
struct ShardExport::Shard {
  explicit Shard(OutputFile file) : out(std::move(file)) {}

  OutputFile out;
  std::uint64_t bytes = 0;
  ShardWriter writer{[this](std::string_view piece) {
    bytes += piece.size();
    return out.write(piece);
  }};
};

/// The open shard of a part. If none is open, a new shard with the next number is begun.
Result<ShardExport::Shard*> ShardExport::shard_of(const std::string& part) {
  auto& shard = open_[part];
  if (!shard) {
    const std::string path = folder_ + "/" + shard_name(part, numbers_[part]++);
    shard = std::make_shared<Shard>(KA_TRY(OutputFile::create(files_, path, Overwrite::no)));
  }
  return shard.get();
}

/// Writes the last block of the shard. The file gets its final name only here.
Result<void> ShardExport::end(Shard& shard, FilesMade& made) {
  KA_TRY(shard.writer.finish());
  KA_TRY(shard.out.commit());
  made.paths.push_back(shard.out.path());
  return {};
}

Result<FilesMade> ShardExport::add(ExportedTake& take, const SampleFacts& facts) {
  std::vector<Npy> members = heads_of(take.header());
  NumberStore numbers;
  KA_TRY(take.rows(
      [&](const TakeSlab& slab) { return add_values(take.header(), slab, numbers, members); }));
  members.push_back({"json", sample_json(take, facts)});
  // The members stay in `members` until the sample is written.
  std::vector<ShardMember> views;
  views.reserve(members.size());
  for (const Npy& one : members) views.push_back({one.ending, one.bytes});
  Shard* shard = KA_TRY(shard_of(facts.part));
  KA_TRY(shard->writer.add(to_string(take.name()), views));
  FilesMade made;
  // A shard is only ended between samples, so that a sample is never divided.
  if (shard->bytes >= shard_bytes_) {
    KA_TRY(end(*shard, made));
    open_.erase(facts.part);
  }
  return made;
}

Result<FilesMade> ShardExport::finish() {
  FilesMade made;
  for (auto& [part, shard] : open_) KA_TRY(end(*shard, made));
  open_.clear();
  return made;
}

}  // namespace kinalign
