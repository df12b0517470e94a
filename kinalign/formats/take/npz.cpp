// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/npz.h"

#include "kinalign/core/crc.h"
#include "kinalign/core/utf8.h"

#include <algorithm>
#include <cassert>

namespace kinalign {

namespace {

constexpr std::uint64_t most32 = 0xffffffffU;  // as a size: look in the ZIP64 field
constexpr std::size_t local_size = 30;

/// Little-endian numbers, one behind the other.
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

constexpr bool large(std::uint64_t value) { return value >= most32; }
constexpr std::uint64_t cut(std::uint64_t value) { return std::min(value, most32); }

/// From "version needed" to "uncompressed size", the same in both headers of a member.
Record& facts(Record& record, std::uint32_t checksum, std::uint64_t size, bool zip64) {
  const std::uint64_t first_of_1980 = 0x21;
  record.u16(zip64 ? 45 : 20).u16(0).u16(0).u16(0).u16(first_of_1980).u32(checksum);
  return record.u32(cut(size)).u32(cut(size));
}

std::string local_header(const std::string& name, std::uint32_t checksum, std::uint64_t size) {
  Record record;
  facts(record.u32(0x04034b50), checksum, size, large(size));
  record.u16(name.size()).u16(large(size) ? 20 : 0).text(name);
  if (large(size)) record.u16(1).u16(16).u64(size).u64(size);
  return record.bytes();
}

struct Place {
  std::uint64_t at = 0;
  std::uint64_t size = 0;
};

std::string central_header(const std::string& name, std::uint32_t checksum, const Place& place) {
  Record extra;
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

std::string end_of_directory(std::uint64_t count, const Place& directory) {
  Record record;
  if (large(directory.at) || large(directory.size) || count >= 0xffff) {
    const std::uint64_t end = directory.at + directory.size;
    record.u32(0x06064b50).u64(44).u16(45).u16(45).u32(0).u32(0).u64(count).u64(count);
    record.u64(directory.size).u64(directory.at);
    record.u32(0x07064b50).u32(0).u64(end).u32(1);
  }
  const std::uint64_t cut_count = std::min<std::uint64_t>(count, 0xffff);
  record.u32(0x06054b50).u16(0).u16(0).u16(cut_count).u16(cut_count);
  return record.u32(cut(directory.size)).u32(cut(directory.at)).u16(0).bytes();
}

/// numpy/lib/format.py, version 1.0: values begin at a multiple of 64.
std::string npy_header(const NpzArray& array) {
  std::string shape;
  for (const std::uint64_t size : array.shape) shape += std::to_string(size) + ", ";
  if (array.shape.size() > 1) shape.erase(shape.size() - 2);
  if (array.shape.size() == 1) shape.pop_back();
  std::string text =
      "{'descr': '" + array.descr + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  constexpr std::size_t before = 10;
  text.append(63 - (before + text.size()) % 64, ' ');
  text += '\n';
  return Record().text("\x93NUMPY").u16(1).u16(text.size()).text(text).bytes();
}

/// A byte that begins no character stands for itself.
std::u32string characters(std::string_view text) {
  std::u32string out;
  while (!text.empty()) {
    const Character next = first_character(text);
    out += next.code.value_or(static_cast<unsigned char>(text.front()));
    text.remove_prefix(next.bytes);
  }
  return out;
}

}  // namespace

std::uint64_t NpzArray::bytes() const {
  std::uint64_t total = value_bytes;
  for (const std::uint64_t size : shape) total *= size;
  return total;
}

NpzArray npz_numbers(std::string name, Stored stored, std::vector<std::uint64_t> shape) {
  constexpr const char* descrs[] = {"<f4", "<f8", "<i8", "<i4", "|u1"};
  return {std::move(name), descrs[static_cast<std::size_t>(stored)], size_of(stored),
          std::move(shape)};
}

NpzTexts npz_texts(std::string name, const std::vector<std::string>& texts) {
  std::vector<std::u32string> all;
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
    at += local_size + member.name.size() + (large(member.size) ? 20 : 0);
    member.at = at;
    at += member.size;
    member.end = at;
    writer.members_.push_back(std::move(member));
  }
  KA_TRY(writer.file_.reserve(at));
  for (std::size_t i = 0; i < arrays.size(); ++i) KA_TRY(writer.append(i, npy_header(arrays[i])));
  return writer;
}

Result<void> NpzWriter::append(std::size_t array, std::string_view bytes) {
  Member& member = members_[array];
  assert(bytes.size() <= member.end - member.at);
  KA_TRY(file_.write_at(member.at, bytes));
  member.at += bytes.size();
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
  const std::uint64_t at = members_.empty() ? 0 : members_.back().end;
  KA_TRY(file_.write_at(at, directory + end_of_directory(members_.size(), {at, directory.size()})));
  return file_.commit();
}

}  // namespace kinalign
