// SPDX-License-Identifier: Apache-2.0
// Divides takes into parts for training and test, and checks that no data are in two parts.
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

/// A take, with the facts that a split needs.
struct SplitTake {
  TakeName name;
  TakeSummary summary;
};

struct SplitOptions {
  std::string by = "subject";           // a name in split_methods()
  double test = 0.2, validation = 0.0;  // shares of the frames
  std::int64_t seed = 1;
  /// True: each class has about the same shares, as far as whole takes or people allow it.
  bool stratified = false;
  /// The people of the test part, instead of shares and seed; all other people are used for
  /// training. Only with `by` = "subject".
  std::vector<std::string> test_people{};
};

/// The methods. subject: no person is in two parts. take: whole takes at random. leave-one-out: a
/// part for each person, and each part in turn is the test. Two methods are those of the HFUT-MMD
/// paper (README.md). hfut-denoise (section 4.1): takes of the 175 cm men with a Kinect, at random.
/// hfut-imu (section 4.2): takes with nodes; classes S2, S3 and S5 against the others.
std::vector<std::string> split_methods();

/// The takes of one part, sorted by name.
struct SplitPart {
  std::string name;  // "train", "validation", "test"; for leave-one-out the person's id
  std::vector<TakeName> takes;
};

/// A division of takes into parts, with the options from which it was made. Takes that are in no
/// part are not used.
struct Split {
  SplitOptions options;
  std::vector<SplitPart> parts;
  /// Hashes of the takes when the split was made; only in a split from a file.
  std::map<TakeName, std::string> sha256;
};

/// Makes a split. The same takes, options and seed give the same split. Fails if a part would be
/// empty, or if a test person has no take.
Result<Split> make_split(const std::vector<SplitTake>& takes, const Catalogue& catalogue,
                         const SplitOptions& options);

/// Checks a split. Errors: a take in two parts, found by its name, its bytes, or the bytes of a raw
/// file with samples; a person in two parts if the method forbids it; a take that does
/// not exist.
/// One warning states how many takes have changed since the split was made. Notes name other people
/// in two parts. The most severe findings come first.
Findings check_split(const Split& split, const std::vector<SplitTake>& takes,
                     const std::string& file);

/// The JSON of schema kinalign.split/1, with the SHA-256 of each take.
std::string split_json(const Split& split, const std::vector<SplitTake>& takes);
Result<Split> parse_split_json(std::string_view json, const std::string& file);
/// Reads a split from a file of at most 64 MiB.
Result<Split> read_split(FileSystem& files, const std::string& path);
/// Reads a split that is to be used. Fails with the first error of check_split(), because a network
/// would be tested on data that it was trained on.
Result<Split> read_good_split(FileSystem& files, const std::string& path,
                              const std::vector<SplitTake>& takes);

}  // namespace kinalign
