// SPDX-License-Identifier: Apache-2.0
// A damaged take is an error or a take, which reads the same twice. The input is damage to a small
// whole take: a byte that says how much of it is left (255: all), then places of three bytes with
// the byte that is to stand there. Read in a child, where HDF5's own crashes are ordinary errors; a
// fault of ours that a sanitizer finds there ends the child by itself, and then this.
#include "fuzz/pieces.h"
#include "tests/formats/take/take_samples.h"

#include "kinalign/core/progress.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_layout.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <span>
#include <string>

using namespace kinalign;

namespace {

/// A file without a folder.
class MemoryFile {
 public:
  MemoryFile() : fd_(::memfd_create("take", MFD_CLOEXEC)) {}
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(fd_); }

  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }
  void write(const std::string& bytes) const {
    if (::pwrite(fd_, bytes.data(), bytes.size(), 0) < 0) std::abort();
  }

 private:
  int fd_;
};

std::string whole_take() {
  char folder[] = "/tmp/kinalign-fuzz-XXXXXX";
  if (::mkdtemp(folder) == nullptr) std::abort();
  const std::string path = std::string(folder) + "/take.h5";
  PosixFiles files;
  const Take take = sample_take(3);
  auto writer = TakeWriter::create(files, path, Overwrite::no, take.header);
  if (!writer || !writer->append(take.all) || !writer->finish(take.report)) std::abort();
  std::string bytes = *read_whole(files, path, std::size_t{1} << 24);
  files.remove(path.c_str());
  ::rmdir(folder);
  return bytes;
}

std::string damaged(const std::string& whole, std::string_view damage) {
  std::string out = whole;
  if (damage.empty()) return out;
  const auto byte = [&](std::size_t i) -> std::size_t {
    return static_cast<unsigned char>(damage[i]);
  };
  for (std::size_t i = 1; i + 4 <= damage.size(); i += 4) {
    const std::size_t place = byte(i) | byte(i + 1) << 8U | byte(i + 2) << 16U;
    out[place % out.size()] = damage[i + 3];
  }
  out.resize(out.size() * byte(0) / 255);
  return out;
}

/// The metadata of a take and every array of every slab, as bytes.
Result<std::string> contents(const std::string& path) {
  PosixFiles files;
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  std::string out = reader.software() + reader.header().subject;
  TakeSlab slab;
  while (KA_TRY(reader.next(slab))) {
    const auto add = [&out](std::string_view, const auto& values) -> Result<void> {
      const std::span given(values);
      using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
      if constexpr (std::is_same_v<Value, double>) {
        for (const double x : given) {
          if (x - x != 0.0) std::_Exit(1);  // not finite: a fault of the reader
        }
      }
      out += bytes_of(given);
      return {};
    };
    out += bytes_of(std::span<const Time>(slab.stamps));
    for (const auto& any : slab.rows) {
      KA_TRY(std::visit([&](const auto& rows) { return for_each_row_array(rows, add); }, any));
    }
  }
  return out + KA_TRY(reader.report_json());
}

}  // namespace

/// HDF5 allocates whatever size a file states. An allocation that is too large must return null, as
/// it does without a sanitizer.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }

/// The sanitizer also reports HDF5's own faults, where HDF5 calls memcpy and the like. They are
/// suppressed: at worst they crash the child, which is there for that.
extern "C" const char* __asan_default_suppressions();
extern "C" const char* __asan_default_suppressions() { return "interceptor_via_lib:libhdf5"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string whole = whole_take();
  const MemoryFile file;
  file.write(damaged(whole, text_of(data, size)));
  GuardLimits limits;
  limits.memory_bytes = std::uint64_t{1} << 30;
  limits.cpu_seconds = 10;
  const Error blame{"fuzz", 0, "a take", ""};
  const auto read = [&] {
    return run_guarded(limits, blame, [&] { return contents(file.path()); });
  };
  const auto first = read();
  if (!first && first.error().found == "a file that ended the program that read it") std::abort();
  if (!first) return 0;
  const auto second = read();
  // The fuzzer's own timer sends a signal, which counts as Ctrl-C.
  if (!second && second.error().found == interruption().found) return 0;
  if (!second || *second != *first) std::abort();
  return 0;
}
