// SPDX-License-Identifier: Apache-2.0
// The messages about files that are no takes.
#include "tests/folder.h"
#include "tests/witness.h"

#include "kinalign/formats/take/take_hdf5.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

Result<TakeReader> opened(const std::string& path) {
  PosixFiles files;
  return TakeReader::open(files, path);
}

}  // namespace

TEST_CASE("what is no HDF5 is refused with what it is") {
  const FreshFolder folder;
  const auto said = [&](const std::string& bytes) {
    const auto read = opened(folder.write("x.h5", bytes));
    REQUIRE_FALSE(read);
    CHECK(read.error().file == folder / "x.h5");
    return read.error().expected + ", found " + read.error().found;
  };
  const std::string wanted = "a take, which is an HDF5 file, found ";
  CHECK(said("") == wanted + "an empty file");
  CHECK(said("HIERARCHY\nROOT Hips\n") == wanted + "'HIERARCHY'");
  CHECK(said(std::string(5000, '\0')) == wanted + "bytes that are no plain text");
}

TEST_CASE("HDF5 of another program is distinguished from a take, whatever version wrote it") {
  const FreshFolder folder;
  REQUIRE(run_witness("hdf5_kinds.py", folder.path()) == 0);
  for (const std::string libver : {"earliest", "v108", "v110", "latest"}) {
    CAPTURE(libver);
    const std::string path = folder / (libver + ".h5");
    const auto read = opened(path);
    REQUIRE_FALSE(read);
    CHECK(to_string(read.error()) ==
          path + ": expected a take that kinalign wrote, found HDF5 of another kind");
    const std::string whole = folder.read(libver + ".h5");
    const auto cut = opened(folder.write("cut.h5", whole.substr(0, whole.size() - 1)));
    REQUIRE_FALSE(cut);
    CHECK(to_string(cut.error()) ==
          (folder / "cut.h5") + ": expected a complete HDF5 file, found a truncated file: " +
              std::to_string(whole.size() - 1) + " bytes of " + std::to_string(whole.size()));
    const auto stump = opened(folder.write("cut.h5", whole.substr(0, 20)));
    REQUIRE_FALSE(stump);
    CHECK(stump.error().found == "a truncated file: 20 bytes");
  }
}
