// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/take_npz.h"

#include "kinalign/core/crc.h"
#include "kinalign/core/utf8.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace kinalign {

namespace {

constexpr std::uint64_t most32 = 0xffffffffU;  // the real size is in the ZIP64 field
constexpr std::size_t local_size = 30;

/// Collects little-endian numbers, one after the other.
class Record {
 public:
  Record& u16(std::uint64_t value) { return put(value, 2); }
  Record& u32(std::uint64_t value) { return put(value, 4); }
  Record& u64(std::uint64_t value) { return put(value, 8); }
  Record& text(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Record& put(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
    return *this;
  }
  std::string bytes_;
};

// True for numbers that need a ZIP64 field.
constexpr bool large(std::uint64_t value) { return value >= most32; }
constexpr std::uint64_t cut(std::uint64_t value) { return std::min(value, most32); }

/// Adds the fields from "version needed" to "uncompressed size". Both headers of a member contain
/// them.
Record& facts(Record& record, std::uint32_t checksum, std::uint64_t size, bool zip64) {
  // 1 January 1980 is the first date that a ZIP file can contain.
  const std::uint64_t first_of_1980 = 0x21;
  record.u16(zip64 ? 45 : 20).u16(0).u16(0).u16(0).u16(first_of_1980).u32(checksum);
  return record.u32(cut(size)).u32(cut(size));
}

std::string local_header(const std::string& name, std::uint32_t checksum, std::uint64_t size) {
  Record record;
  facts(record.u32(0x04034b50), checksum, size, large(size));
  // The ZIP64 field and its head have 20 bytes.
  record.u16(name.size()).u16(large(size) ? 20 : 0).text(name);
  if (large(size)) record.u16(1).u16(16).u64(size).u64(size);
  return record.bytes();
}

struct Place {
  std::uint64_t at = 0;
  std::uint64_t size = 0;
};

/// A member's entry in the central directory. Numbers that are too large are stored in the ZIP64
/// field.
std::string central_header(const std::string& name, std::uint32_t checksum, const Place& place) {
  Record extra;
  // The field must contain only the numbers that are too large (APPNOTE 4.5.3).
  if (large(place.size)) extra.u64(place.size).u64(place.size);
  if (large(place.at)) extra.u64(place.at);
  const std::size_t more = extra.bytes().size();
  Record record;
  facts(record.u32(0x02014b50).u16(45), checksum, place.size, more > 0);
  record.u16(name.size()).u16(more > 0 ? more + 4 : 0).u16(0).u16(0).u16(0).u32(0);
  record.u32(cut(place.at)).text(name);
  if (more > 0) record.u16(1).u16(more).text(extra.bytes());
  return record.bytes();
}

/// The end record. If a number is too large for it, the ZIP64 records come first.
std::string end_of_directory(std::uint64_t count, const Place& directory) {
  Record record;
  if (large(directory.at) || large(directory.size) || count >= 0xffff) {
    // The ZIP64 record follows the directory. Its locator contains its position.
    const std::uint64_t end = directory.at + directory.size;
    record.u32(0x06064b50).u64(44).u16(45).u16(45).u32(0).u32(0).u64(count).u64(count);
    record.u64(directory.size).u64(directory.at);
    record.u32(0x07064b50).u32(0).u64(end).u32(1);
  }
  const std::uint64_t cut_count = std::min<std::uint64_t>(count, 0xffff);
  record.u32(0x06054b50).u16(0).u16(0).u16(cut_count).u16(cut_count);
  return record.u32(cut(directory.size)).u32(cut(directory.at)).u16(0).bytes();
}

/// The characters of a text in UTF-8. A byte that does not belong to a valid character becomes the
/// character with its value.
std::u32string characters(std::string_view text) {
  std::u32string out;
  while (!text.empty()) {
    const Character next = first_character(text);
    out += next.code.value_or(static_cast<unsigned char>(text.front()));
    text.remove_prefix(next.bytes);
  }
  return out;
}

/// Content that is known before the rows, and the index of its array in the file.
struct Fixed {
  std::size_t array;
  std::string bytes;
};

/// Collects the members of the file in order.
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
    // The vectors are written in the same form as in memory.
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
  members.add_numbers(prefix + "parents", Stored::int32, {joints}, skeleton.parents);
  members.add_vectors(prefix + "rest_offsets", skeleton.rest_offsets);
  const EndSiteArrays sites = end_site_arrays(skeleton);
  members.add_numbers(prefix + "end_sites_parents", Stored::int32, {sites.parents.size()},
                      sites.parents);
  members.add_vectors(prefix + "end_sites_offsets", sites.offsets);
}

/// Fails if two members have the same name. This can happen, because a name joins the names of
/// stream and array.
Result<void> check_names(const std::vector<NpzArray>& arrays, const std::string& path) {
  std::set<std::string_view> seen;
  for (const NpzArray& array : arrays) {
    if (seen.insert(array.name).second) continue;
    return refuse(path, "streams whose array names differ (STREAM_ARRAY.npy): rename a stream",
                  "'" + shown(array.name) + "' twice");
  }
  return {};
}

}  // namespace

std::string npy_header(const NpzArray& array) {
  std::string shape;
  for (const std::uint64_t size : array.shape) shape += std::to_string(size) + ", ";
  // Python writes (3, 4) and (3,): a comma follows a single length.
  if (array.shape.size() > 1) shape.erase(shape.size() - 2);
  if (array.shape.size() == 1) shape.pop_back();
  std::string text =
      "{'descr': '" + array.descr + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  // The length of the header is a multiple of 64, and its last byte is a line end.
  constexpr std::size_t before = 10;
  text.append(63 - (before + text.size()) % 64, ' ');
  text += '\n';
  return Record().text("\x93NUMPY").u16(1).u16(text.size()).text(text).bytes();
}

std::uint64_t NpzArray::bytes() const {
  std::uint64_t total = value_bytes;
  for (const std::uint64_t size : shape) total *= size;
  return total;
}

NpzArray npz_numbers(std::string name, Stored stored, std::vector<std::uint64_t> shape) {
  // The types in the order of Stored.
  constexpr const char* descrs[] = {"<f4", "<f8", "<i8", "<i4", "|u1"};
  return {std::move(name), descrs[static_cast<std::size_t>(stored)], size_of(stored),
          std::move(shape)};
}

/// Extends all texts with zeros to the length of the longest text, as numpy does.
NpzTexts npz_texts(std::string name, const std::vector<std::string>& texts) {
  std::vector<std::u32string> all;
  // numpy does not allow texts of length 0.
  std::size_t width = 1;
  for (const std::string& text : texts) {
    all.push_back(characters(text));
    width = std::max(width, all.back().size());
  }
  NpzTexts out{{std::move(name), "<U" + std::to_string(width), 4 * width, {texts.size()}}, {}};
  for (std::u32string& one : all) {
    one.resize(width);
    out.bytes += bytes_of(std::span<const char32_t>(one));
  }
  return out;
}

Result<NpzWriter> NpzWriter::create(FileSystem& files, std::string path, Overwrite overwrite,
                                    const std::vector<NpzArray>& arrays) {
  NpzWriter writer(KA_TRY(OutputFile::create(files, std::move(path), overwrite)));
  std::uint64_t at = 0;
  for (const NpzArray& array : arrays) {
    const std::string header = npy_header(array);
    Member member;
    member.name = array.name + ".npy";
    member.size = header.size() + array.bytes();
    member.header_at = at;
    // The space for the local header stays free here. The header is written at the end, when its
    // checksum is known.
    at += local_size + member.name.size() + (large(member.size) ? 20 : 0);
    member.at = at;
    at += member.size;
    member.end = at;
    writer.members_.push_back(std::move(member));
  }
  // A full disk is reported before the rows are computed.
  KA_TRY(writer.file_.reserve(at));
  for (std::size_t i = 0; i < arrays.size(); ++i) KA_TRY(writer.append(i, npy_header(arrays[i])));
  return writer;
}

Result<void> NpzWriter::append(std::size_t array, std::string_view bytes) {
  Member& member = members_[array];
  assert(bytes.size() <= member.end - member.at);
  KA_TRY(file_.write_at(member.at, bytes));
  member.at += bytes.size();
  // The CRC-32 continues from its earlier value, so each member may grow in pieces.
  member.checksum = crc_of(bytes, member.checksum);
  return {};
}

Result<void> NpzWriter::finish() {
  std::string directory;
  for (const Member& member : members_) {
    assert(member.at == member.end);
    const std::string local = local_header(member.name, member.checksum, member.size);
    KA_TRY(file_.write_at(member.header_at, local));
    directory += central_header(member.name, member.checksum, {member.header_at, member.size});
  }
  // The directory follows the last member.
  const std::uint64_t at = members_.empty() ? 0 : members_.back().end;
  KA_TRY(file_.write_at(at, directory + end_of_directory(members_.size(), {at, directory.size()})));
  return file_.commit();
}

Result<TakeNpzWriter> TakeNpzWriter::create(FileSystem& files, std::string path,
                                            Overwrite overwrite, const TakeHeader& header,
                                            NpzNames names) {
  assert(names == NpzNames::by_stream || header.groups.size() == 1);
  KA_TRY(validate(header));
  const Precision precision = precision_of(header);
  Members members;
  // append() relies on the stamps being member 0.
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
    members.add_texts(prefix + names_key(group), names_of(group));
    const auto* clip = std::get_if<ClipGroup>(&group.kind);
    if (clip != nullptr) add_skeleton(members, prefix, clip->skeleton);
  }
  KA_TRY(check_names(members.arrays, path));
  TakeNpzWriter out(KA_TRY(NpzWriter::create(files, std::move(path), overwrite, members.arrays)),
                    std::move(groups));
  // Names and skeletons are written before the rows.
  for (const Fixed& fixed : members.fixed) {
    KA_TRY(out.writer_.append(fixed.array, fixed.bytes));
  }
  return out;
}

Result<void> TakeNpzWriter::append(const TakeSlab& slab) {
  KA_TRY(writer_.append(0, bytes_of(std::span<const Time>(slab.stamps))));
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    auto column = groups_[g].cbegin();
    // The columns are handled in the same order as in TakeWriter::append().
    const auto use = [&](std::string_view name, const auto& values) -> Result<void> {
      if (column == groups_[g].cend() || column->name != name) return {};
      const Column& to = *column++;
      const auto put = [&](std::string_view bytes) { return writer_.append(to.array, bytes); };
      return numbers_.store(std::span(values), to.stored, put);
    };
    KA_TRY(
        std::visit([&](const auto& rows) { return for_each_row_array(rows, use); }, slab.rows[g]));
    assert(column == groups_[g].cend());
  }
  return {};
}

}  // namespace kinalign
