// SPDX-License-Identifier: Apache-2.0
// Takes divided into parts for training and test, and whether the parts leak into each other.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_summary.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A take as a split knows it.
struct SplitTake {
  TakeName name;
  TakeSummary summary;
};

struct SplitOptions {
  std::string by = "subject";           // a name in split_methods()
  double test = 0.2, validation = 0.0;  // shares of the frames
  std::int64_t seed = 1;
  bool stratified =
      false;  // each class has the same shares, as near as whole takes or people allow
  /// In place of shares and seed: who is tested; all others are trained on. By subject alone.
  std::vector<std::string> test_people{};
};

/// subject: nobody is in two parts. take: whole takes at random. leave-one-out: a part for each
/// person, of which each in turn is the test. hfut-denoise (paper, 4.1): takes of the 175 cm men
/// with a Kinect, at random. hfut-imu (paper, 4.2): takes with nodes, S2, S3 and S5 against the
/// rest.
std::vector<std::string> split_methods();

struct SplitPart {
  std::string name;  // "train", "validation", "test"; of leave-one-out the person's id
  std::vector<TakeName> takes;
};

struct Split {
  SplitOptions options;
  std::vector<SplitPart> parts;
  std::map<TakeName, std::string> sha256;  // of takes, when the split was made; of a file alone
};

/// The same takes, options and seed give the same split. Fails where a part would be empty,
/// or where no take is of one of the test people.
Result<Split> make_split(const std::vector<SplitTake>& takes, const Catalogue& catalogue,
                         const SplitOptions& options);

/// Errors: a take in two parts, by its name, or by its bytes or those of a raw file that holds
/// samples; where people shall not be in two parts, a person who is; a take that is not there. One
/// warning says how many takes have other bytes than when the split was made, notes who else is in
/// two parts. The worst come first.
Findings check_split(const Split& split, const std::vector<SplitTake>& takes,
                     const std::string& file);

/// Schema kinalign.split/1, with the SHA-256 of each take.
std::string split_json(const Split& split, const std::vector<SplitTake>& takes);
Result<Split> parse_split_json(std::string_view json, const std::string& file);
/// Reads one from a file of at most 64 MiB.
Result<Split> read_split(FileSystem& files, const std::string& path);
/// The same of a split that is used: fails with the first error that check_split() finds, since a
/// network would be tested on what it has seen.
Result<Split> read_good_split(FileSystem& files, const std::string& path,
                              const std::vector<SplitTake>& takes);

}  // namespace kinalign
