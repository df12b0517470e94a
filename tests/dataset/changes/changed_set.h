// SPDX-License-Identifier: Apache-2.0
// A data set of three takes with raw files. The takes are arbitrary bytes that are never read. The
// files stop after some calls, like those of a killed program.
#pragma once

#include "tests/folder.h"

#include "kinalign/core/files.h"
#include "kinalign/dataset/changes/toml_text.h"
#include "kinalign/dataset/take_name.h"

#include <cerrno>
#include <filesystem>
#include <map>
#include <string>

namespace kinalign {

/// After `last` changing calls every further one fails to change anything.
class StoppingFiles final : public PosixFiles {
 public:
  explicit StoppingFiles(int last) : left_(last) {}
  bool stopped() const { return left_ < 0; }

  int link(const char* from, const char* to) override {
    return stops() ? -1 : PosixFiles::link(from, to);
  }
  int rename(const char* from, const char* to) override {
    return stops() ? -1 : PosixFiles::rename(from, to);
  }
  int remove(const char* path) override { return stops() ? -1 : PosixFiles::remove(path); }

 private:
  bool stops() {
    if (left_ >= 0 && left_-- > 0) return false;
    errno = EIO;
    return true;
  }
  int left_;
};

class ChangedSet {
 public:
  ChangedSet() {
    folder.write("dataset.toml",
                 "# ours\n[subject.01]  # tall\nsex = \"f\"\n[subject.01.segments_m]\nshin = 0.4\n"
                 "[subject.02]\n[class.S1]\n[action.S1A01]  # a walk\nclass = \"S1\"\n"
                 "[action.S1A02]\nclass = \"S1\"\n");
    put({"01", "S1A01", 1});
    put({"01", "S1A02", 1});
    put({"02", "S1A01", 1});
  }

  void put(const TakeName& name) const {
    const std::string raw = raw_folder(name) + "mocap.bvh";
    folder.write(raw, "raw of " + to_string(name));
    folder.write(path_of(name, TakeFile::manifest),
                 "# by hand\nsubject = \"" + name.subject + "\"  # who\naction = \"" + name.action +
                     "\"\n\n[stream.mocap]\nfile = \"../" + raw + "\"  # suit\n");
    folder.write(path_of(name, TakeFile::take), "take " + to_string(name));
    folder.write(path_of(name, TakeFile::summary), "summary " + to_string(name));
  }

  /// Every file below the folder with its bytes.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      if (!entry.is_regular_file()) continue;
      const std::string path = entry.path().lexically_relative(folder.path()).string();
      out[path] = folder.read(path);
    }
    return out;
  }

  /// A later process would use other names for unfinished files (OutputFile), so these are removed.
  void drop_unfinished_files() const {
    for (const auto& [path, bytes] : contents()) {
      if (path.ends_with(".part")) std::filesystem::remove(folder / path);
    }
  }

  FreshFolder folder;
  PosixFiles files;
};

}  // namespace kinalign
