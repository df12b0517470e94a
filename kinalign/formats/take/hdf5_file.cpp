// SPDX-License-Identifier: Apache-2.0
// This file has three parts. The first checks a file's first bytes without HDF5 (HDF5 File Format
// Specification, III.A). The second is a "virtual file driver", through which HDF5 reads and writes
// with the functions of kinalign/core (HDF5 1.10, H5FDpublic.h). The third creates objects in a
// file.
#include "kinalign/formats/take/hdf5_file.h"

#include "kinalign/formats/unknown_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>

namespace kinalign::hdf5 {

static_assert(std::is_same_v<Id, hid_t> && std::is_same_v<Size, hsize_t> &&
              std::is_same_v<int, herr_t>);

namespace {

constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";

/// This many first bytes contain a superblock (HDF5's file header) of any version.
constexpr std::size_t start_bytes = 128;

/// An integer of `size` bytes, little-endian. The result is empty if it extends beyond `head`.
std::optional<std::uint64_t> number_at(std::string_view head, std::size_t at, std::size_t size) {
  if (size == 0 || size > 8 || at + size > head.size()) return std::nullopt;
  std::uint64_t out = 0;
  for (std::size_t i = size; i-- > 0;) out = out << 8 | static_cast<unsigned char>(head[at + i]);
  return out;
}

/// The end of the file according to its own superblock. kinalign writes the superblock at the
/// beginning of every file.
std::optional<std::uint64_t> stated_end(std::string_view head) {
  const auto version = number_at(head, 8, 1);
  if (!version || *version > 3) return std::nullopt;
  // The positions depend on the version of the superblock.
  const std::size_t size_of_addresses = *version < 2 ? 13 : 9;
  const std::size_t addresses = *version == 0 ? 24 : *version == 1 ? 28 : 12;
  const auto width = number_at(head, size_of_addresses, 1);
  if (!width) return std::nullopt;
  // The addresses stand in this order: base address, free space or extension, end of file.
  return number_at(head, addresses + 2 * *width, *width);
}

/// Fails if a file of `size` bytes that begins with `head` is not an HDF5 file, or if it is shorter
/// than it states. The check does not use HDF5, so that a wrong or truncated file gets a clear
/// message.
Result<void> check_start(const std::string& path, std::string_view head, std::uint64_t size) {
  const std::string_view start = head.substr(0, signature.size());
  if (start != signature.substr(0, start.size()) || start.empty()) {
    return refuse(path, "a take, which is an HDF5 file", beginning_of(head));
  }
  const auto end = stated_end(head);
  if (end && *end <= size) return {};
  if (end) {
    return refuse(
        path, "a complete HDF5 file",
        "a truncated file: " + std::to_string(size) + " bytes of " + std::to_string(*end));
  }
  if (head.size() < start_bytes) {
    return refuse(path, "a complete HDF5 file",
                  "a truncated file: " + std::to_string(size) + " bytes");
  }
  return {};  // HDF5 reports all other faults
}

/// A file of the driver. HDF5 casts between H5FD_t and this structure, so `base` must be the first
/// member. open_driven() creates it, and close_driven() frees it.
struct Driven {
  H5FD_t base;
  Bytes* bytes;
  haddr_t end_of_addresses;
};

Bytes& bytes_of(const H5FD_t* file) { return *reinterpret_cast<const Driven*>(file)->bytes; }

// Ignores the name from HDF5, because the file is open already.
H5FD_t* open_driven(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<Bytes* const*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  // HDF5 owns the object from here on.
  auto driven = std::make_unique<Driven>();
  driven->bytes = *info;
  return reinterpret_cast<H5FD_t*>(driven.release());
}

herr_t close_driven(H5FD_t* file) {
  const std::unique_ptr<Driven> driven(reinterpret_cast<Driven*>(file));
  return 0;
}

// With these three flags, HDF5 joins small accesses into larger ones.
herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE;
  return 0;
}

// In HDF5, the end of addresses is the end of all assigned positions. The file may be shorter.
haddr_t end_of_addresses(const H5FD_t* file, H5FD_mem_t) {
  return reinterpret_cast<const Driven*>(file)->end_of_addresses;
}

herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  reinterpret_cast<Driven*>(file)->end_of_addresses = end;
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return bytes_of(file).size; }

// NOLINTNEXTLINE(readability-function-size): HDF5 prescribes the six parameters, of write too
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) {
  const Bytes& bytes = bytes_of(file);
  const std::span<char> room(static_cast<char*>(to), size);
  // HDF5 also reads from a file that is being written.
  const auto got =
      bytes.input != nullptr ? bytes.input->read_at(at, room) : bytes.output->read_at(at, room);
  if (!got) return -1;
  // HDF5 may read beyond the end of the file. The missing bytes are zeros.
  std::fill(room.begin() + static_cast<std::ptrdiff_t>(*got), room.end(), '\0');
  return 0;
}

// NOLINTNEXTLINE(readability-function-size)
herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* from) {
  Bytes& bytes = bytes_of(file);
  if (bytes.output == nullptr) return -1;
  // After a failure nothing more is written, and HDF5 gets no error.
  if (bytes.failure) return 0;
  auto done = bytes.write(at, {static_cast<const char*>(from), size});
  if (!done) bytes.failure = std::move(done).error();
  return 0;
}

/// Extends the file to the last address that HDF5 has assigned.
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  const haddr_t end = reinterpret_cast<Driven*>(file)->end_of_addresses;
  const Bytes& bytes = bytes_of(file);
  if (bytes.output == nullptr || bytes.size >= end) return 0;
  // One byte at the end gives the file its length.
  const char zero = '\0';
  return write(file, H5FD_MEM_DEFAULT, H5P_DEFAULT, end - 1, 1, &zero);
}

/// The driver's functions in the form that HDF5 requires.
H5FD_class_t driver_class() {
  H5FD_class_t c{};
  c.name = "kinalign_files";
  c.maxaddr = (haddr_t{1} << 62);
  c.fc_degree = H5F_CLOSE_STRONG;
  c.fapl_size = sizeof(void*);
  c.open = open_driven;
  c.close = close_driven;
  c.query = query;
  c.get_eoa = end_of_addresses;
  c.set_eoa = set_end_of_addresses;
  c.get_eof = end_of_file;
  c.read = read;
  c.write = write;
  c.truncate = truncate;
  const H5FD_mem_t one_kind[] = H5FD_FLMAP_SINGLE;
  std::copy(std::begin(one_kind), std::end(one_kind), std::begin(c.fl_map));
  return c;
}

/// The property list with which HDF5 opens `bytes`. It is made for each file. The driver itself is
/// registered only once.
Handle access_to(Bytes& bytes) {
  // Without this call, HDF5 would run its own cleanup at the end of the program.
  H5dont_atexit();
  // HDF5 prints no errors. They are returned as values instead.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  // Plug-ins are disabled, so that a file can't choose code to run.
  H5PLset_loading_state(0);
  static const H5FD_class_t driver = driver_class();  // HDF5 keeps a pointer to it
  static const hid_t registered = H5FDregister(&driver);
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  Bytes* info = &bytes;
  if (H5Pset_driver(access.id(), registered, &info) < 0) return {};
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  // HDF5 does not collect small arrays in a common block, so every array has its own position.
  H5Pset_small_data_block_size(access.id(), 0);
  // Large arrays begin at pages, because the system copies whole pages faster.
  H5Pset_alignment(access.id(), 32768, 4096);
  return access;
}

/// Keeps the message of the innermost function. It is the first one in HDF5's list of errors.
herr_t keep_innermost(unsigned, const H5E_error2_t* reason, void* into) {
  if (reason->desc != nullptr) *static_cast<std::string*>(into) = reason->desc;
  return 0;
}

}  // namespace

// Writes bytes. `size` becomes the end of all written bytes.
Result<void> Bytes::write(std::uint64_t at, std::string_view bytes) {
  KA_TRY(output->write_at(at, bytes));
  size = std::max(size, at + bytes.size());
  return {};
}

Failure failure(const Bytes& bytes, std::string expected) {
  // If a read or write failed, that failure is the cause and not HDF5's message.
  if (bytes.failure) return Failure(*bytes.failure);
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  return refuse(bytes.path(), std::move(expected),
                reason.empty() ? "something of another kind" : "an HDF5 error: " + reason);
}

Result<Handle> create(Bytes& bytes) {
  const Handle access = access_to(bytes);
  // Old versions of HDF5 and MATLAB can read this version of the format.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  // Times are not stored, so that the same take gives the same bytes.
  H5Pset_obj_track_times(creation.id(), 0);
  Handle file(H5Fcreate(bytes.path().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  if (!file.good()) return failure(bytes, "a file that HDF5 can create");
  return file;
}

Result<Handle> open(Bytes& bytes) {
  std::string head(start_bytes, '\0');
  head.resize(KA_TRY(bytes.input->read_at(0, head)));
  KA_TRY(check_start(bytes.path(), head, bytes.size));
  const Handle access = access_to(bytes);
  Handle file(H5Fopen(bytes.path().c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file.good()) return failure(bytes, "a file that HDF5 can read");
  return file;
}

Handle text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  // HDF5 does not allow texts of length 0.
  H5Tset_size(type.id(), std::max<std::size_t>(bytes, 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle space(const std::vector<hsize_t>& sizes) {
  if (sizes.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), 0);
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose};
}

Handle create_dataset(hid_t parent, const std::string& name, const Shape& shape) {
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), 0);
  H5Pset_layout(creation.id(), H5D_CONTIGUOUS);
  // With early allocation, the array gets its position now.
  H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
  // The array is not filled with zeros, because rows will be written to it.
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  return {H5Dcreate2(parent, name.c_str(), shape.type, space(shape.sizes).id(), H5P_DEFAULT,
                     creation.id(), H5P_DEFAULT),
          H5Dclose};
}

bool put_attribute(hid_t object, const char* name, const Shape& shape, const void* value) {
  const Handle attribute(
      H5Acreate2(object, name, shape.type, space(shape.sizes).id(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  return attribute.good() && H5Awrite(attribute.id(), shape.type, value) >= 0;
}

bool put_text(hid_t object, const char* name, std::string_view text) {
  // An empty text is stored as a single NUL.
  const std::string bytes = text.empty() ? std::string(1, '\0') : std::string(text);
  return put_attribute(object, name, {text_type(bytes.size()).id(), {}}, bytes.data());
}

bool put_texts(hid_t object, const char* name, const std::vector<std::string>& texts) {
  // HDF5 can't store an empty list. Readers treat an absent list as empty.
  if (texts.empty()) return true;
  const PackedTexts packed = pack(texts);
  return put_attribute(object, name, {text_type(packed.width).id(), {texts.size()}},
                       packed.bytes.data());
}

PackedTexts pack(const std::vector<std::string>& texts) {
  PackedTexts packed;
  for (const std::string& text : texts) packed.width = std::max(packed.width, text.size());
  for (const std::string& text : texts) {
    packed.bytes += text;
    packed.bytes.append(packed.width - text.size(), '\0');
  }
  return packed;
}

std::vector<std::string> unpack(std::string_view bytes, std::size_t width) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at + width <= bytes.size(); at += width) {
    const std::string_view text = bytes.substr(at, width);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

}  // namespace kinalign::hdf5
