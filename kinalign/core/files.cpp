// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/files.h"

#include "kinalign/core/file_calls.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace kinalign {

namespace {

std::string kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a pipe; save it to a file first";
  if (S_ISSOCK(mode)) return "a socket";
  if (S_ISLNK(mode)) return "a symbolic link";
  return "a device";
}

/// A temporary name in the same folder. The name contains the process id, and ls hides it.
std::string hidden_name(const std::string& path) {
  return std::string(folder(path)) + "." + std::string(file_name(path)) + "." +
         std::to_string(::getpid()) + ".part";
}

}  // namespace

int PosixFiles::open(const char* path, int flags, mode_t mode) {
  // O_CLOEXEC: programs that this program starts don't inherit open files.
  return ::open(path, flags | O_CLOEXEC, mode);
}
ssize_t PosixFiles::read(int fd, void* data, std::size_t size) { return ::read(fd, data, size); }
ssize_t PosixFiles::write(int fd, const void* data, std::size_t size) {
  return ::write(fd, data, size);
}
ssize_t PosixFiles::read_at(int fd, void* data, std::size_t size, off_t at) {
  return ::pread(fd, data, size, at);
}
ssize_t PosixFiles::write_at(int fd, const void* data, std::size_t size, off_t at) {
  return ::pwrite(fd, data, size, at);
}
// posix_fallocate() is not used: it writes zeros if the file system can't allocate.
int PosixFiles::allocate(int fd, off_t size) { return ::fallocate(fd, 0, 0, size); }
int PosixFiles::truncate(int fd, off_t size) { return ::ftruncate(fd, size); }
int PosixFiles::sync(int fd) { return ::fsync(fd); }
int PosixFiles::link(const char* from, const char* to) {
  // AT_SYMLINK_FOLLOW links the open file and not the entry in /proc, see O_TMPFILE in open(2).
  return ::linkat(AT_FDCWD, from, AT_FDCWD, to, AT_SYMLINK_FOLLOW);
}
int PosixFiles::rename(const char* from, const char* to) { return std::rename(from, to); }
int PosixFiles::remove(const char* path) { return ::unlink(path); }
int PosixFiles::close(int fd) { return ::close(fd); }

Result<InputFile> InputFile::open(FileSystem& files, std::string path, std::size_t piece) {
  // Without O_NONBLOCK, opening a pipe without a writer would wait for ever. Regular files ignore
  // the flag.
  OpenFile file(files, files.open(path.c_str(), O_RDONLY | O_NONBLOCK, 0));
  struct stat status {};
  if (file.fd() < 0 || ::fstat(file.fd(), &status) != 0) return unreadable(path, errno);
  if (!S_ISREG(status.st_mode)) {
    const ErrorKind kind = S_ISDIR(status.st_mode) ? ErrorKind::directory : ErrorKind::other;
    return Failure(Error{path, 0, "a regular file", kind_of(status.st_mode), kind});
  }
  return InputFile(std::move(file), std::move(path), static_cast<std::uint64_t>(status.st_size),
                   piece);
}

Result<std::string_view> InputFile::next() {
  for (;;) {
    // Each piece is one read(2), so a piece may be shorter than the buffer before the end of the
    // file, too.
    const ssize_t got = file_.files().read(file_.fd(), buffer_.data(), buffer_.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {  // a disk may fail to read a single page
      Failure failure = unreadable(path_, errno);
      failure.value().found += " at byte " + std::to_string(at_);
      return failure;
    }
    at_ += static_cast<std::uint64_t>(got);
    return std::string_view(buffer_.data(), static_cast<std::size_t>(got));
  }
}

Result<std::size_t> InputFile::read_at(std::uint64_t at, std::span<char> to) const {
  return fill(file_.files(), path_, file_.fd(), at, to);
}

Result<void> make_new_folder(const std::string& path) {
  // mkdir(2) checks and creates in one step, so only one of two programs succeeds.
  if (::mkdir(path.c_str(), 0777) == 0) return {};
  if (errno == EEXIST) return refuse(path, "no file or folder of that name", "an existing one");
  return refuse(path, "a folder that can be made", std::strerror(errno));
}

Result<void> make_folders(const std::string& path) {
  std::error_code fault;
  std::filesystem::create_directories(path, fault);
  if (!fault) return {};
  return refuse(path, "a folder that can be made", fault.message());
}

Result<std::string> read_whole(FileSystem& files, const std::string& path, std::size_t most) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  std::string text;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    if (piece.empty()) return text;
    // The bytes that arrive are counted, because size() may be out of date.
    if (text.size() + piece.size() > most) {
      return refuse(path, "at most " + std::to_string(most) + " bytes", "more");
    }
    text += piece;
  }
}

Result<void> write_whole(FileSystem& files, const std::string& path, std::string_view bytes,
                         Overwrite overwrite) {
  OutputFile out = KA_TRY(OutputFile::create(files, path, overwrite));
  KA_TRY(out.write(bytes));
  return out.commit();
}

Result<void> copy_file(FileSystem& files, const std::string& from, const std::string& to) {
  InputFile in = KA_TRY(InputFile::open(files, from));
  OutputFile out = KA_TRY(OutputFile::create(files, to, Overwrite::no));
  for (;;) {
    const std::string_view piece = KA_TRY(in.next());
    if (piece.empty()) return out.commit();
    KA_TRY(out.write(piece));
  }
}

Result<OutputFile> OutputFile::create(FileSystem& files, std::string path, Overwrite overwrite) {
  // A path such as "takes/" names a folder only.
  if (file_name(path).empty()) return refuse(path, "the name of a file", "the name of a folder");
  struct stat status {};
  // lstat() does not follow links. A link is refused, because commit() would replace the link and
  // not its target.
  if (::lstat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) {
      return refuse(path, "a regular file or no file", kind_of(status.st_mode));
    }
    if (overwrite == Overwrite::no) {
      return refuse(path, "no file of that name (--force overwrites)", "an existing file");
    }
  }
  OutputFile file(files, std::move(path), overwrite);
  // O_TMPFILE makes a file without a name. If the program is killed, the system removes the file.
  file.fd_ = files.open(place_of(file.path_).c_str(), O_TMPFILE | O_RDWR, 0644);
  if (file.fd_ >= 0) {
    file.unfinished_ = "/proc/self/fd/" + std::to_string(file.fd_);
    return file;
  }
  // These three errors mean that O_TMPFILE is not supported. Any other error concerns the folder.
  if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) {
    return failed(file.path_, "a folder that can be written", errno);
  }
  file.hidden_path_ = hidden_name(file.path_);
  file.unfinished_ = file.hidden_path_;
  file.fd_ = files.open(file.hidden_path_.c_str(), O_RDWR | O_CREAT | O_EXCL, 0644);
  if (file.fd_ < 0) {
    const int code = errno;
    file.hidden_path_.clear();
    return failed(file.path_, "a folder that can be written", code);
  }
  return file;
}

OutputFile::OutputFile(FileSystem& files, std::string path, Overwrite overwrite)
    : files_(&files), path_(std::move(path)), overwrite_(overwrite) {}

// After the move the source has neither descriptor nor hidden name, so its destructor can't remove
// the file.
OutputFile::OutputFile(OutputFile&& other) noexcept
    : files_(other.files_),
      path_(std::move(other.path_)),
      overwrite_(other.overwrite_),
      fd_(std::exchange(other.fd_, -1)),
      unfinished_(std::move(other.unfinished_)),
      hidden_path_(std::exchange(other.hidden_path_, {})) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(files_, other.files_);
  std::swap(path_, other.path_);
  std::swap(overwrite_, other.overwrite_);
  std::swap(fd_, other.fd_);
  std::swap(unfinished_, other.unfinished_);
  std::swap(hidden_path_, other.hidden_path_);
  return *this;
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() {
  if (fd_ >= 0) files_->close(fd_);
  if (!hidden_path_.empty()) files_->remove(hidden_path_.c_str());
  fd_ = -1;
  hidden_path_.clear();
}

// After a failed write the file contains an unknown part of the bytes.
Result<void> OutputFile::spoiled(const std::string& expected, int code) {
  discard();  // an incomplete file is never committed
  return failed(path_, expected, code);
}

Result<void> OutputFile::write(std::string_view bytes) {
  const int code = put_all(bytes, [this](std::string_view rest) {
    return files_->write(fd_, rest.data(), rest.size());
  });
  return code == 0 ? Result<void>{} : spoiled("room to write", code);
}

Result<void> OutputFile::write_at(std::uint64_t at, std::string_view bytes) {
  // `rest` always ends at `end`, so its length gives its position.
  const int code = put_all(bytes, [&, end = at + bytes.size()](std::string_view rest) {
    return files_->write_at(fd_, rest.data(), rest.size(), static_cast<off_t>(end - rest.size()));
  });
  return code == 0 ? Result<void>{} : spoiled("room to write", code);
}

Result<void> OutputFile::reserve(std::uint64_t size) {
  while (size > 0 && files_->allocate(fd_, static_cast<off_t>(size)) != 0) {
    if (errno == EINTR) continue;
    // The program continues without reserved space. A later write() reports a full disk.
    if (errno == EOPNOTSUPP || errno == ENOSYS) return {};
    return spoiled("room for " + std::to_string(size) + " bytes", errno);
  }
  return {};
}

Result<std::size_t> OutputFile::read_at(std::uint64_t at, std::span<char> to) const {
  return fill(*files_, path_, fd_, at, to);
}

Result<void> OutputFile::place() {
  // link() is used instead of rename(), because it fails if another program has taken the name
  // meanwhile.
  const std::string from = hidden_path_.empty() ? unfinished_ : hidden_path_;
  if (files_->link(from.c_str(), path_.c_str()) == 0) return {};
  if (errno != EEXIST) return failed(path_, "a folder that can be written", errno);
  if (overwrite_ == Overwrite::no) {
    return refuse(path_, "no file of that name (--force overwrites)", "an existing file");
  }
  // The name is taken and may be overwritten.
  if (hidden_path_.empty()) {
    // A nameless file can only be linked to a free name. It is linked to a temporary name, which is
    // then renamed over the old file. If the program is killed between both steps, the complete new
    // file remains under the temporary name.
    hidden_path_ = hidden_name(path_);
    if (files_->link(unfinished_.c_str(), hidden_path_.c_str()) != 0) {
      const int code = errno;
      hidden_path_.clear();
      return failed(path_, "a folder that can be written", code);
    }
  }
  if (files_->rename(hidden_path_.c_str(), path_.c_str()) != 0) {
    return failed(path_, "a file that can be replaced", errno);
  }
  hidden_path_.clear();
  return {};
}

Result<void> OutputFile::commit() {
  // The data are synced before the file gets its name. A file with a name is therefore complete
  // even after a power cut.
  if (files_->sync(fd_) != 0) return failed(path_, "data that reach the disk", errno);
  KA_TRY(place());
  sync_folder(*files_, path_);  // may fail; the data are synced already
  discard();
  return {};
}

std::string_view file_name(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

std::string_view folder(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash + 1);
}

}  // namespace kinalign
