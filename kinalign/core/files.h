// SPDX-License-Identifier: Apache-2.0
// Files: read in pieces, written beside and moved into place. Every call that opens, reads, writes,
// syncs or places a file goes through FileSystem, so that a test can make any one of them fail;
// questions about a file (fstat, lstat) do not.
#pragma once

#include "kinalign/core/error.h"

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The system calls on files; each behaves as its POSIX namesake, errno included.
class FileSystem {
 public:
  virtual ~FileSystem() = default;
  virtual int open(const char* path, int flags, mode_t mode) = 0;
  virtual ssize_t read(int fd, void* data, std::size_t size) = 0;
  virtual ssize_t write(int fd, const void* data, std::size_t size) = 0;
  virtual ssize_t read_at(int fd, void* data, std::size_t size, off_t at) = 0;         // pread
  virtual ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) = 0;  // pwrite
  virtual int allocate(int fd, off_t size) = 0;  // fallocate of all bytes up to `size`
  virtual int truncate(int fd, off_t size) = 0;
  virtual int sync(int fd) = 0;
  virtual int link(const char* from, const char* to) = 0;  // follows a /proc/self/fd link
  virtual int rename(const char* from, const char* to) = 0;
  virtual int remove(const char* path) = 0;
  virtual int close(int fd) = 0;
};

/// The machine's own. Has no state; the program's rim makes one and hands it down.
class PosixFiles : public FileSystem {
 public:
  int open(const char* path, int flags, mode_t mode) override;
  ssize_t read(int fd, void* data, std::size_t size) override;
  ssize_t write(int fd, const void* data, std::size_t size) override;
  ssize_t read_at(int fd, void* data, std::size_t size, off_t at) override;
  ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override;
  int allocate(int fd, off_t size) override;
  int truncate(int fd, off_t size) override;
  int sync(int fd) override;
  int link(const char* from, const char* to) override;
  int rename(const char* from, const char* to) override;
  int remove(const char* path) override;
  int close(int fd) override;
};

/// A regular file read from front to back in pieces of at most 256 KiB (which stay in the second
/// cache, where hashing and parsing find them).
class InputFile {
 public:
  static constexpr std::size_t piece_size = std::size_t{256} << 10;

  /// Refuses what is not a regular file: a pipe can't be read twice, a directory not at all.
  /// `piece`: bytes at most of a piece, for a caller that needs the beginning alone.
  static Result<InputFile> open(FileSystem& files, std::string path,
                                std::size_t piece = piece_size);
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// The next piece; empty at the end. Valid until the next call.
  Result<std::string_view> next();

  /// The same of what a bad disk can still give (not to be mixed with next()): of a page where it
  /// fails (EIO) the rest comes as zeros, a piece of its own.
  Result<std::string_view> next_or_zeros();
  std::uint64_t unread() const { return unread_; }  // bytes that are such zeros

  /// Fills `to` from byte `at` on, as far as the file reaches; returns how much that was. Does not
  /// move what next() reads.
  Result<std::size_t> read_at(std::uint64_t at, std::span<char> to) const;

  std::uint64_t size() const { return size_; }  // when it was opened: for progress, not for trust
  const std::string& path() const { return path_; }

 private:
  InputFile(FileSystem& files, std::string path, int fd, std::uint64_t size, std::size_t piece);

  FileSystem* files_;
  std::string path_;
  int fd_;
  std::uint64_t size_;
  std::vector<char> buffer_;
  std::uint64_t at_ = 0, unread_ = 0;  // of next_or_zeros()
};

/// All of a file at once: for small ones (manifests, layouts). Fails above `most` bytes.
Result<std::string> read_whole(FileSystem& files, const std::string& path, std::size_t most);

/// The folder and those above it, where they are not there yet.
Result<void> make_folders(const std::string& path);

/// A folder that was not there; the one above it is. Fails where anything has that name.
Result<void> make_new_folder(const std::string& path);

enum class Overwrite { no, yes };

/// A file that comes to be only when it is whole. Written without a name in the target's folder
/// (with a name that begins with a dot where the file system can't), synced and moved into place by
/// commit(); until then, and if the program is killed, nothing stands at `path` or what stood
/// there.
class OutputFile {
 public:
  /// Fails at once where `path` exists and may not be overwritten.
  static Result<OutputFile> create(FileSystem& files, std::string path, Overwrite overwrite);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  Result<void> write(std::string_view bytes);
  /// At any place, also behind the end: what lies between reads as zeros.
  Result<void> write_at(std::uint64_t at, std::string_view bytes);
  /// Takes room on the disk for a file of that length, so that a full disk shows before the work;
  /// the file then reads as zeros. Where the file system can't, nothing happens.
  Result<void> reserve(std::uint64_t size);
  /// What was written there; returns how much of `to` the file filled.
  Result<std::size_t> read_at(std::uint64_t at, std::span<char> to) const;
  Result<void> commit();

  const std::string& path() const { return path_; }

 private:
  OutputFile(FileSystem& files, std::string path, Overwrite overwrite);
  Result<void> place();
  void discard();
  Result<void> spoiled(const std::string& expected, int code);

  FileSystem* files_;
  std::string path_;
  Overwrite overwrite_;
  int fd_ = -1;
  std::string unfinished_;
  std::string beside_;  // the name with a dot; empty where the file has none
};

/// A file of these bytes.
Result<void> write_whole(FileSystem& files, const std::string& path, std::string_view bytes,
                         Overwrite overwrite);
/// Fails where anything stands at `to`.
Result<void> copy_file(FileSystem& files, const std::string& from, const std::string& to);

/// The part of a path behind its last '/'.
std::string_view file_name(std::string_view path);
/// The folder of a path: "" where it names none, else up to and with the last '/'.
std::string_view folder(std::string_view path);

}  // namespace kinalign
