// SPDX-License-Identifier: Apache-2.0
// HDF5's "virtual file driver" over core's files (HDF5 1.10, H5FDpublic.h).
#include "kinalign/formats/take/hdf5_file.h"
#include "kinalign/formats/take/hdf5_start.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace kinalign::hdf5 {

namespace {

/// HDF5 casts between its own H5FD_t and this: the first member must be that.
struct Driven {
  H5FD_t base;
  Bytes* bytes;
  haddr_t end_of_addresses;
};

Bytes& bytes_of(const H5FD_t* file) { return *reinterpret_cast<const Driven*>(file)->bytes; }

H5FD_t* open_driven(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<Bytes* const*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  auto driven = std::make_unique<Driven>();
  driven->bytes = *info;
  return reinterpret_cast<H5FD_t*>(driven.release());
}

herr_t close_driven(H5FD_t* file) {
  const std::unique_ptr<Driven> driven(reinterpret_cast<Driven*>(file));
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE;
  return 0;
}

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
  const auto got =
      bytes.input != nullptr ? bytes.input->read_at(at, room) : bytes.output->read_at(at, room);
  if (!got) return -1;
  std::fill(room.begin() + static_cast<std::ptrdiff_t>(*got), room.end(), '\0');
  return 0;
}

// NOLINTNEXTLINE(readability-function-size)
herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* from) {
  Bytes& bytes = bytes_of(file);
  if (bytes.output == nullptr) return -1;
  if (bytes.failure) return 0;
  auto done = bytes.write(at, {static_cast<const char*>(from), size});
  if (!done) bytes.failure = std::move(done).error();
  return 0;
}

/// The file must reach as far as HDF5 has given out addresses.
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  const haddr_t end = reinterpret_cast<Driven*>(file)->end_of_addresses;
  const Bytes& bytes = bytes_of(file);
  if (bytes.output == nullptr || bytes.size >= end) return 0;
  const char zero = '\0';
  return write(file, H5FD_MEM_DEFAULT, H5P_DEFAULT, end - 1, 1, &zero);
}

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

/// The property list by which HDF5 opens `bytes`.
Handle access_to(Bytes& bytes) {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
  static const H5FD_class_t driver = driver_class();  // HDF5 keeps a pointer to it
  static const hid_t registered = H5FDregister(&driver);
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  Bytes* info = &bytes;
  if (H5Pset_driver(access.id(), registered, &info) < 0) return {};
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  H5Pset_small_data_block_size(access.id(), 0);
  H5Pset_alignment(access.id(), 32768, 4096);  // large arrays at pages: the system copies faster
  return access;
}

/// Of HDF5's stack of messages the one that was said first, in the innermost function.
herr_t keep_innermost(unsigned, const H5E_error2_t* said, void* into) {
  if (said->desc != nullptr) *static_cast<std::string*>(into) = said->desc;
  return 0;
}

}  // namespace

Result<void> Bytes::write(std::uint64_t at, std::string_view bytes) {
  KA_TRY(output->write_at(at, bytes));
  size = std::max(size, at + bytes.size());
  return {};
}

Failure failure(const Bytes& bytes, std::string expected) {
  if (bytes.failure) return Failure(*bytes.failure);
  std::string said;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &said);
  return Failure(Error{bytes.path(), 0, std::move(expected),
                       said.empty() ? "another thing" : "one of which HDF5 says: " + said});
}

Result<Handle> create(Bytes& bytes) {
  const Handle access = access_to(bytes);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), 0);
  Handle file(H5Fcreate(bytes.path().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  if (!file.good()) return failure(bytes, "a file that HDF5 can begin");
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

}  // namespace kinalign::hdf5
