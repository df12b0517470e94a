// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/built_in_motion.h"

#include "kinalign/simulate/person/built_in_body.h"

#include <fmt/format.h>

namespace kinalign {

Result<Motion> built_in_motion(const BuiltInOptions& options) {
  if (!(options.height_m >= 0.5 && options.height_m <= 2.5)) {
    return Failure(Error{"", 0, "a height of 0.5 to 2.5 m", fmt::format("{} m", options.height_m)});
  }
  double length = options.programme.empty() ? options.length_s : 0.0;
  for (const ProgrammePiece& piece : options.programme) {
    // A negative length, or a length that is not a number, makes the sum invalid.
    length = piece.length_s >= 0.0 ? length + piece.length_s : -1e9;
  }
  if (!(length >= 0.0 && length <= 1e6)) {
    return Failure(Error{"", 0, "pieces of 0 s or more, together at most 1000000 s", "others"});
  }
  const Programme programme = options.programme.empty()
                                  ? default_programme(options.length_s, options.seed)
                                  : options.programme;
  BuiltInBody body(options.height_m, options.person.value_or(options.seed), options.seed,
                   acts_of(programme, options.seed));
  Skeleton skeleton = body.skeleton();
  return Motion{std::move(skeleton), length,
                [body = std::move(body)](double t, Pose& pose) { body.pose_at(t, pose); }};
}

}  // namespace kinalign
