// SPDX-License-Identifier: Apache-2.0
// Files in memory that remember every write and every sync. From that a test can build the state
// after a kill or a power cut at any moment.
#pragma once

#include "kinalign/core/files.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

class MemoryFiles final : public FileSystem {
 public:
  /// A change to a file; a write has bytes.
  struct Change {
    std::string path;
    enum class Kind { create, write, truncate } kind{};
    std::uint64_t at = 0;  // offset of a write; for a truncation the new size
    std::string bytes;
  };
  /// The changes in the order in which they were made.
  std::vector<Change> changes;
  /// By path: the number of its changes that are certainly on the disk.
  std::map<std::string, std::size_t> synced;
  /// The number of changes when the last sync began: a sync covers those. Each sync resets it.
  std::size_t sync_began = SIZE_MAX;
  /// The next sync fails. The kernel may forget the changes that this sync was to write, so no
  /// later sync of the file proves that they are on the disk.
  bool next_sync_fails = false;

  int open(const char* path, int flags, mode_t) override {
    const bool is_folder = (flags & O_DIRECTORY) != 0;
    if ((flags & O_CREAT) != 0) {
      if (contents_.contains(path)) return fail(EEXIST);
      change({path, Change::Kind::create, 0, ""});
    } else if (!is_folder && !contents_.contains(path)) {
      return fail(ENOENT);
    }
    open_.push_back({is_folder ? "" : path, 0});
    return static_cast<int>(open_.size()) - 1;
  }
  ssize_t read(int fd, void* data, std::size_t size) override {
    const ssize_t got = read_at(fd, data, size, static_cast<off_t>(file(fd).at));
    file(fd).at += static_cast<std::size_t>(got);
    return got;
  }
  ssize_t write(int, const void*, std::size_t) override { return fail(EBADF); }
  ssize_t read_at(int fd, void* data, std::size_t size, off_t at) override {
    const std::string& bytes = contents_.at(file(fd).path);
    const auto begin = std::min(static_cast<std::size_t>(at), bytes.size());
    const std::size_t some = std::min(size, bytes.size() - begin);
    std::memcpy(data, bytes.data() + begin, some);
    return static_cast<ssize_t>(some);
  }
  ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
    change({file(fd).path, Change::Kind::write, static_cast<std::uint64_t>(at),
            std::string(static_cast<const char*>(data), size)});
    return static_cast<ssize_t>(size);
  }
  int allocate(int, off_t) override { return fail(EOPNOTSUPP); }
  int truncate(int fd, off_t size) override {
    change({file(fd).path, Change::Kind::truncate, static_cast<std::uint64_t>(size), ""});
    return 0;
  }
  int sync(int fd) override {
    const std::size_t covered = std::min(std::exchange(sync_began, SIZE_MAX), changes.size());
    const std::string& path = file(fd).path;
    if (std::exchange(next_sync_fails, false)) {
      doubtful_.insert(path);
      return fail(EIO);
    }
    if (!path.empty() && !doubtful_.contains(path)) synced[path] = covered;
    return 0;
  }
  int link(const char*, const char*) override { return fail(EPERM); }
  int rename(const char*, const char*) override { return fail(EPERM); }
  int remove(const char* path) override { return contents_.erase(path) > 0 ? 0 : fail(ENOENT); }
  int close(int) override { return 0; }

  const std::string& content(const std::string& path) const { return contents_.at(path); }

  static void apply(std::string& content, const Change& change) {
    if (change.kind == Change::Kind::truncate) content.resize(change.at);
    if (change.kind != Change::Kind::write) return;
    content.resize(std::max<std::size_t>(content.size(), change.at + change.bytes.size()));
    content.replace(change.at, change.bytes.size(), change.bytes);
  }

 private:
  struct Open {
    std::string path;
    std::size_t at = 0;
  };
  Open& file(int fd) { return open_.at(static_cast<std::size_t>(fd)); }
  static int fail(int code) {
    errno = code;
    return -1;
  }
  void change(Change change) {
    apply(contents_[change.path], change);
    changes.push_back(std::move(change));
  }

  std::vector<Open> open_;
  std::map<std::string, std::string> contents_;
  std::set<std::string> doubtful_;  // the files of which a sync failed
};

}  // namespace kinalign
