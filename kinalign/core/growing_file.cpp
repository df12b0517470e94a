// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/growing_file.h"

#include "kinalign/core/file_calls.h"

#include <sys/stat.h>

#include <utility>

namespace kinalign {

Result<GrowingFile> GrowingFile::create(FileSystem& files, std::string path) {
  if (file_name(path).empty()) return refuse(path, "the name of a file", "the name of a folder");
  int fd = -1;
  do {
    fd = files.open(path.c_str(), O_RDWR | O_CREAT | O_EXCL, 0644);
  } while (fd < 0 && errno == EINTR);
  if (fd < 0) {
    if (errno == EEXIST) return refuse(path, "no file of that name", "an existing file");
    return failed(path, "a folder that can be written", errno);
  }
  return GrowingFile(OpenFile(files, fd), std::move(path));
}

// The bytes are written at size_ instead of the file's end. Bytes of a failed append after size_
// are overwritten.
Result<void> GrowingFile::append(std::string_view bytes) {
  if (ragged_) KA_TRY(cut(size_));
  const int code = put_all(bytes, [&, end = size_ + bytes.size()](std::string_view rest) {
    return file_.files().write_at(file_.fd(), rest.data(), rest.size(),
                                  static_cast<off_t>(end - rest.size()));
  });
  if (code != 0) {
    ragged_ = true;
    // If the cut fails, too, ragged_ stays true and the next append() tries the cut again.
    (void)cut(size_);
    return failed(path_, "room to write", code);
  }
  size_ += bytes.size();
  return {};
}

Result<void> GrowingFile::cut(std::uint64_t size) {
  while (file_.files().truncate(file_.fd(), static_cast<off_t>(size)) != 0) {
    if (errno != EINTR) return failed(path_, "a file that can be truncated", errno);
  }
  size_ = size;
  ragged_ = false;
  return {};
}

Result<void> GrowingFile::read_at(std::uint64_t at, std::span<char> to) const {
  const std::size_t got = KA_TRY(fill(file_.files(), path_, file_.fd(), at, to));
  if (got == to.size()) return {};
  return refuse(path_, "the bytes that were written", "the file's end");
}

Result<void> GrowingFile::sync() const {
  while (file_.files().sync(file_.fd()) != 0) {
    if (errno != EINTR) return failed(path_, "data that reach the disk", errno);
  }
  // Some file systems can't sync a folder. The result is ignored, because the data are synced.
  if (!std::exchange(named_, true)) sync_folder(file_.files(), path_);
  // Writes to a removed file succeed, but the system deletes the data when the file is closed.
  struct stat status {};
  const bool removed =
      ::fstat(file_.fd(), &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 0;
  if (removed) return refuse(path_, "a file that exists until the end", "no file: it was removed");
  return {};
}

void GrowingFile::close() {
  if (file_.fd() < 0) return;
  // Bytes of a failed append must not remain in the finished file.
  if (ragged_) (void)cut(size_);
  file_.close();
}

}  // namespace kinalign
