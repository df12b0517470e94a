// SPDX-License-Identifier: Apache-2.0
// A data set in which only the takes' summaries exist: lists and pages need no more.
#pragma once

#include "tests/folder.h"

#include "kinalign/dataset/index.h"
#include "kinalign/dataset/take_summary.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

namespace kinalign {

class SummarisedSet {
 public:
  SummarisedSet() {
    folder.write(
        "dataset.toml",
        "name = \"walks\"\ndescription = \"Walking *people*.\"\n[subject.01]\nsex = \"f\"\n"
        "height_cm = 165\nconsent = \"released\"\n[subject.02]\n[class.S1]\nname = "
        "\"walking\"\n[action.A]\nclass = \"S1\"\n[device.kinect]\nmodel = \"v2\"\n");
  }

  void put(const TakeName& name, const TakeSummary& take) const {
    std::filesystem::create_directories(folder / ("sub-" + name.subject));
    folder.write(path_of(name, TakeFile::summary), summary_json(take));
  }

  static TakeSummary summary(std::uint64_t errors, std::uint64_t warnings, double residual_m) {
    TakeSummary take;
    take.frames = 600;
    take.rate_hz = 60.0;
    take.errors = errors;
    take.warnings = warnings;
    take.quality = errors > 0 ? Quality::bad : warnings > 0 ? Quality::usable : Quality::good;
    take.residual_m = residual_m;
    take.sha256 = std::string(64, 'a');
    take.streams.resize(1);
    take.streams[0].name = "mocap";
    take.streams[0].columns = 59;
    return take;
  }

  DatasetIndex open() {
    auto index = DatasetIndex::open(files, folder.path());
    if (!index) FAIL(to_string(index.error()));
    return *std::move(index);
  }

  FreshFolder folder;
  PosixFiles files;
};

}  // namespace kinalign
