// SPDX-License-Identifier: Apache-2.0
// Trains one model: kinalign-learn JOB.json. `kinalign train` writes the job and starts this
// program.
#include "apps/kinalign-learn/job.h"

#include <nlohmann/json.hpp>
#include <torch/torch.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

namespace {

// The warning appears below this speed. docs/training.md names this limit.
constexpr double least_gflops = 20.0;  // one core of 2015 or later is faster

/// Measures the speed of the product of two 256 x 256 matrices, in GFLOP/s. It shows how fast the
/// BLAS library is. The best of ten products counts, because other work on the machine slows single
/// ones.
double product_gflops() {
  using Clock = std::chrono::steady_clock;
  constexpr int size = 256;
  const auto a = torch::ones({size, size}), b = torch::ones({size, size});
  auto out = torch::mm(a, b);  // starts the library's threads
  double best = 0.0;
  for (int i = 0; i < 10; ++i) {
    const auto begin = Clock::now();
    torch::mm_out(out, a, b);
    const std::chrono::duration<double> took = Clock::now() - begin;
    best = std::max(best, 2e-9 * size * size * size / std::max(took.count(), 1e-9));
  }
  return best;
}

/// Warns about a slow BLAS library. Debian's LibTorch uses the installed BLAS, and the reference
/// BLAS takes ten times as long as OpenBLAS.
void warn_of_slow_products() {
  const double gflops = product_gflops();
  if (gflops >= least_gflops) return;
  std::ostringstream text;
  text.precision(2);
  text << "the BLAS library of this machine reaches only " << gflops
       << " GFLOP/s, so training takes much longer than needed; install a faster one: sudo apt-get "
          "install libopenblas0-pthread";
  std::cout << nlohmann::ordered_json{{"warning", text.str()}}.dump() << std::endl;
}

/// Prints the error and returns the exit code: as JSON on stdout for the parent program, as text on
/// stderr for people who run this program themselves. Exit code 4 means that another process of the
/// training has ended; that process states the reason.
int fail(const kinalign::Error& error) {
  std::cout << nlohmann::ordered_json{{"error",
                                       {{"file", error.file},
                                        {"expected", error.expected},
                                        {"found", error.found}}}}
                   .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            << std::endl;
  std::cerr << "kinalign-learn: " << kinalign::to_string(error) << "\n";
  return error.kind == kinalign::ErrorKind::lost_process ? 4 : 3;
}

}  // namespace

// The program has one argument and no flags, because people use `kinalign train`, which writes the
// job.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: kinalign-learn JOB.json\n"
                 "Trains one model. kinalign train writes the job and starts this program.\n";
    return 2;
  }
  std::signal(SIGPIPE, SIG_IGN);  // if the parent has ended, the next print fails
  // Denormal numbers make computations up to a hundred times slower, so they are set to 0. The call
  // must come first, because threads inherit the setting when they start.
  at::globalContext().setFlushDenormal(true);
  // With deterministic algorithms the same seed gives the same weights (docs/training.md). For
  // operations without such an algorithm, LibTorch only warns.
  at::globalContext().setDeterministicAlgorithms(true, true);
  std::ifstream in(argv[1], std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  try {
    auto job = kinalign::read_job(text, argv[1]);
    if (!job) return fail(job.error());
    // The GPU is checked here, because LibTorch would fail only at the first tensor.
    if (job->device == "cuda" && !torch::cuda::is_available()) {
      return fail({"--device", 0, "a GPU and a LibTorch with CUDA (docs/training.md)",
                   "no GPU that LibTorch can use"});
    }
    torch::set_num_threads(static_cast<int>(job->threads));
    if (job->device == "cpu") warn_of_slow_products();
    const auto done = kinalign::run_job(*job);
    return done ? 0 : fail(done.error());
  } catch (const std::exception& fault) {  // LibTorch reports errors as exceptions
    return fail({argv[1], 0, "a job that LibTorch can run", fault.what()});
  }
}
