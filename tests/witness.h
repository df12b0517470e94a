// SPDX-License-Identifier: Apache-2.0
// Independent computations by NumPy and SciPy. A script of tests/witness/ gets named arrays and
// returns named arrays (tests/witness/arrays.py is the script's side).
#pragma once

#include "tests/folder.h"

#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace kinalign {

using Arrays = std::map<std::string, std::vector<double>>;

/// Runs a script of tests/witness with Debian's Python; gives its exit status.
inline int run_witness(const std::string& script, const std::string& path) {
  const std::string command = "OPENBLAS_NUM_THREADS=1 /usr/bin/python3 " KINALIGN_SOURCE_DIR
                              "/tests/witness/" +
                              script + " '" + path + "'";
  return std::system(command.c_str());
}

/// Runs a script on arrays. Throws if it fails, which fails the test: NumPy and SciPy are in
/// packages.txt, so they must be there.
inline Arrays run_python(const std::string& script, const Arrays& given) {
  const FreshFolder folder;
  for (const auto& [name, values] : given) {
    folder.write(name + ".in",
                 {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  }
  if (run_witness(script, folder.path()) != 0) throw std::runtime_error(script + " has failed");
  Arrays found;
  for (const auto& name : folder.names()) {
    if (!name.ends_with(".out")) continue;
    const std::string bytes = folder.read(name);
    auto& values = found[name.substr(0, name.size() - 4)];
    values.resize(bytes.size() / sizeof(double));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  }
  return found;
}

}  // namespace kinalign
