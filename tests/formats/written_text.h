// SPDX-License-Identifier: Apache-2.0
// The text that a writer puts into a file.
#pragma once

#include "tests/folder.h"

#include "kinalign/core/text_out.h"

#include <stdexcept>
#include <string>

namespace kinalign {

/// `write(out)` returns Result<void>. Gives the text, or the error if it fails.
template <class Write>
Result<std::string> written_text(const Write& write) {
  const FreshFolder folder;
  PosixFiles files;
  auto out = TextOut::create(files, folder / "text", Overwrite::no);
  if (!out) throw std::runtime_error("no file for the test");
  KA_TRY(write(*out));
  KA_TRY(out->commit());
  return folder.read("text");
}

}  // namespace kinalign
