// SPDX-License-Identifier: Apache-2.0
// Reads files in pieces. Writes files under a temporary name and moves them into place. Every call
// that opens, reads, writes, syncs or moves a file goes through FileSystem, so that a test can make
// each of them fail. Queries (fstat, lstat) do not.
#pragma once

#include "kinalign/core/error.h"

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The system calls on files. Each behaves like the POSIX function of the same name, including
/// errno.
class FileSystem {
 public:
  virtual ~FileSystem() = default;
  virtual int open(const char* path, int flags, mode_t mode) = 0;
  virtual ssize_t read(int fd, void* data, std::size_t size) = 0;
  virtual ssize_t write(int fd, const void* data, std::size_t size) = 0;
  virtual ssize_t read_at(int fd, void* data, std::size_t size, off_t at) = 0;  // calls pread
  virtual ssize_t write_at(int fd, const void* data, std::size_t size,
                           off_t at) = 0;        // calls pwrite
  virtual int allocate(int fd, off_t size) = 0;  // fallocate for bytes 0 to `size`
  virtual int truncate(int fd, off_t size) = 0;
  virtual int sync(int fd) = 0;
  virtual int link(const char* from, const char* to) = 0;  // follows a /proc/self/fd link
  virtual int rename(const char* from, const char* to) = 0;
  virtual int remove(const char* path) = 0;
  virtual int close(int fd) = 0;
};

/// The real file system. It has no state. The outermost part of a program creates it and passes it
/// to the other parts.
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

/// Owns a descriptor of a file, and closes it.
class OpenFile {
 public:
  OpenFile(FileSystem& files, int fd) : files_(&files), fd_(fd) {}
  OpenFile(OpenFile&& other) noexcept : files_(other.files_), fd_(std::exchange(other.fd_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(files_, other.files_);
    std::swap(fd_, other.fd_);
    return *this;
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { close(); }

  void close() {
    if (fd_ >= 0) files_->close(std::exchange(fd_, -1));
  }
  FileSystem& files() const { return *files_; }
  /// -1 after close(), after the object was moved from, or if the file could not be opened.
  int fd() const { return fd_; }

 private:
  FileSystem* files_;
  int fd_;
};

/// A regular file, read from front to back in pieces of at most 256 KiB. Such a piece stays in the
/// second-level cache while it is hashed and parsed.
class InputFile {
 public:
  static constexpr std::size_t piece_size = std::size_t{256} << 10;

  /// Refuses files that are not regular, because a pipe can't be read twice and a directory not at
  /// all. `piece`: the size of a piece, for a caller that needs only the beginning.
  static Result<InputFile> open(FileSystem& files, std::string path,
                                std::size_t piece = piece_size);

  /// The next piece; empty at the end of the file. It is valid until the next call.
  Result<std::string_view> next();

  /// Fills `to` from byte `at` on. Returns the number of bytes, which is smaller at the end of the
  /// file. The call does not change the position of next().
  Result<std::size_t> read_at(std::uint64_t at, std::span<char> to) const;

  /// The size when the file was opened. It may have changed since, so it serves for progress only.
  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  InputFile(OpenFile file, std::string path, std::uint64_t size, std::size_t piece)
      : file_(std::move(file)), path_(std::move(path)), size_(size), buffer_(piece) {}

  // next() returns views of buffer_. The size of buffer_ is the size of a piece.
  OpenFile file_;
  std::string path_;
  std::uint64_t size_;
  std::vector<char> buffer_;
  std::uint64_t at_ = 0;  // position of next()
};

/// Reads a whole small file, such as a manifest or a layout. Fails above `most` bytes.
Result<std::string> read_whole(FileSystem& files, const std::string& path, std::size_t most);

/// Makes the folder and its parents if they do not exist.
Result<void> make_folders(const std::string& path);

/// Makes a folder in an existing folder. Fails if the name exists already.
Result<void> make_new_folder(const std::string& path);

enum class Overwrite { no, yes };

/// A file that appears only when it is complete. It is written into the target's folder without a
/// name. If the file system does not support this, its name begins with a dot. commit() syncs the
/// file and moves it to `path`. Until then, and if the program is killed, `path` is unchanged.
class OutputFile {
 public:
  /// Fails at once if `path` exists and may not be overwritten.
  static Result<OutputFile> create(FileSystem& files, std::string path, Overwrite overwrite);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  Result<void> write(std::string_view bytes);
  /// Writes at any position, also after the end. Bytes that were never written read as zeros.
  Result<void> write_at(std::uint64_t at, std::string_view bytes);
  /// Allocates disk space for a file of that length, so that a full disk is reported before the
  /// work begins. The file then reads as zeros. Does nothing if the file system can't allocate.
  Result<void> reserve(std::uint64_t size);
  /// Reads bytes that were written before. Returns the number of bytes, which is smaller at the end
  /// of the file.
  Result<std::size_t> read_at(std::uint64_t at, std::span<char> to) const;
  Result<void> commit();

  const std::string& path() const { return path_; }

 private:
  OutputFile(FileSystem& files, std::string path, Overwrite overwrite);
  Result<void> place();
  void discard();
  Result<void> spoiled(const std::string& expected, int code);

  // fd_ is open until a successful commit() or a failed write, and -1 afterwards. An object that is
  // destroyed without commit() leaves neither a file nor a hidden name.
  FileSystem* files_;
  std::string path_;
  Overwrite overwrite_;
  int fd_ = -1;
  // Path of the file before commit(). It is /proc/self/fd/N for a file without a name, else
  // hidden_path_.
  std::string unfinished_;
  std::string hidden_path_;  // the name with a dot; empty if the file has no name
};

/// Writes a file with these bytes.
Result<void> write_whole(FileSystem& files, const std::string& path, std::string_view bytes,
                         Overwrite overwrite);
/// Fails if anything exists at `to`.
Result<void> copy_file(FileSystem& files, const std::string& from, const std::string& to);

/// The part of a path after its last '/'.
std::string_view file_name(std::string_view path);
/// The folder of a path, up to and including the last '/'; "" if the path names no folder.
std::string_view folder(std::string_view path);

}  // namespace kinalign
