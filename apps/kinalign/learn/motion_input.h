// SPDX-License-Identifier: Apache-2.0
// Opens the inputs of denoise and pose that are not takes.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/verbs/inputs.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The wanted stream. Without a name, the only one that fits is used. Errors name `flag`.
struct WantedStream {
  std::string name{};
  std::string_view flag = "--stream";
};

/// A stream that can be chosen by its name. `is_usual`: it can also be chosen without a name.
struct StreamChoice {
  std::string name;
  std::size_t index = 0;  // in the take or in the file
  bool is_usual = true;
};

/// The index of the wanted stream. Fails if none or several fit; the error lists all names.
/// `kind`: "joints".
Result<std::size_t> choose_stream(const std::vector<StreamChoice>& all, const WantedStream& wanted,
                                  std::string_view kind, const std::string& path);

/// The streams of a manifest, of a recording (all devices of which rows can be made) or of a single
/// stream's file.
/// A device of a recording that can't be read is left out. If it is the wanted one, its name is
/// missing among the streams.
Result<Input> open_motion(const std::string& path, Call& call);

/// The warnings and errors that the reader found in a stream that was read to its end, one line
/// each, in the words of `kinalign check`.
std::vector<std::string> warnings_of(const RecordedStream& stream);

}  // namespace kinalign
