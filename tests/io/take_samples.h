// SPDX-License-Identifier: Apache-2.0
// Takes of random contents, and a file system that fails, for the tests of this room.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/take/take.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>

namespace kinalign {

/// A folder that goes when the test ends.
struct ScratchFolder {
  ScratchFolder() {
    std::string form = (std::filesystem::temp_directory_path() / "kinalign-XXXXXX").string();
    path = ::mkdtemp(form.data());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  bool empty() const { return std::filesystem::is_empty(path); }

  std::filesystem::path path;
};

inline std::string bytes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Runs a witness of tests/witness with Debian's Python; its exit status.
inline int run_witness(const std::string& script, const std::string& arguments) {
  const std::string command =
      "/usr/bin/python3 " KINALIGN_SOURCE_DIR "/tests/witness/" + script + " " + arguments;
  return std::system(command.c_str());
}

/// Does as the machine's, until the call number `fail_at` (from 0), which fails with `code`.
class FailingFiles final : public FileSystem {
 public:
  FailingFiles(int fail_at, int code) : left_(fail_at), code_(code) {}
  bool failed() const { return left_ < 0; }

  int open(const char* path, int flags, mode_t mode) override {
    return fails() ? -1 : real_.open(path, flags, mode);
  }
  ssize_t read(int fd, void* data, std::size_t size) override {
    return fails() ? -1 : real_.read(fd, data, size);
  }
  ssize_t write(int fd, const void* data, std::size_t size) override {
    return fails() ? -1 : real_.write(fd, data, size);
  }
  ssize_t read_at(int fd, void* data, std::size_t size, off_t at) override {
    return fails() ? -1 : real_.read_at(fd, data, size, at);
  }
  ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
    return fails() ? -1 : real_.write_at(fd, data, size, at);
  }
  int allocate(int fd, off_t size) override { return fails() ? -1 : real_.allocate(fd, size); }
  int sync(int fd) override { return fails() ? -1 : real_.sync(fd); }
  int link(const char* from, const char* to) override {
    return fails() ? -1 : real_.link(from, to);
  }
  int rename(const char* from, const char* to) override {
    return fails() ? -1 : real_.rename(from, to);
  }
  int remove(const char* path) override { return real_.remove(path); }
  int close(int fd) override { return real_.close(fd); }

 private:
  bool fails() {
    if (left_-- != 0) return false;
    errno = code_;
    return true;
  }

  PosixFiles real_;
  int left_;
  int code_;
};

/// A take of three streams; numbers are floats, so that storing them loses nothing.
inline Take sample_take(std::size_t frames, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  const auto numbers = [&](std::size_t count) {
    std::vector<double> out(count);
    std::uniform_real_distribution<float> range(-2.0F, 2.0F);
    for (double& x : out) x = static_cast<double>(range(random));
    return out;
  };
  const auto flags = [&](std::size_t count) {
    std::vector<std::uint8_t> out(count);
    for (auto& x : out) x = static_cast<std::uint8_t>(random() % 2);
    return out;
  };
  const auto times = [&](std::size_t count) {
    std::vector<std::int64_t> out(count);
    for (auto& x : out) x = static_cast<std::int64_t>(random() % 50'000'000);
    return out;
  };
  Take take;
  take.header.subject = "03";
  take.header.action = "S1A02";
  take.header.frames = frames;
  Skeleton skeleton{{"Hips", "Spine", "H\xc3\xa4nde"},
                    {-1, 0, 1},
                    {{0, 0.95, 0}, {0, 0.1, 0}, {0.2, 0.1, 1.0 / 3}},
                    {{2, {0, 0.1, 0}}}};
  take.header.groups = {
      {"mocap", ClipGroup{skeleton}, false, false, {{"walk.bvh", std::string(64, 'a'), 12345}}},
      {"kinect",
       PointGroup{{"SpineBase", "Head"}},
       true,
       true,
       {{"k.csv", std::string(64, 'b'), 9}}},
      {"imu",
       ImuGroup{{"waist", "wrist_left"}, {true, true, false, true}, "waist"},
       true,
       false,
       {{"w.csv", std::string(64, 'c'), 1}, {"wl.csv", std::string(64, 'd'), 2}}}};
  take.header.parameters.subject = "03";
  StreamOptions stream;
  stream.name = "mocap";
  stream.files = {{"/home/someone/walk.bvh", ""}};
  take.header.parameters.streams = {stream};
  for (std::size_t t = 0; t < frames; ++t) {
    const auto step = static_cast<std::int64_t>(t) * 16'666'667;
    take.all.stamps.push_back(utc_time(1'700'000'000'000'000'000 + step));
  }
  std::vector<Tracking> state;
  for (std::size_t i = 0; i < frames * 2; ++i) state.push_back(static_cast<Tracking>(random() % 3));
  const auto n = frames;
  take.all.rows = {ClipRows{numbers(n * 9), numbers(n * 9), numbers(n * 12), {}, {}},
                   PointRows{numbers(n * 6), state, flags(n * 2), {times(n), times(n)}},
                   ImuRows{numbers(n * 8), numbers(n * 6), {}, flags(n * 2), {times(n * 2), {}}}};
  take.report.frames = frames;
  take.report.reference = "mocap";
  return take;
}

}  // namespace kinalign
