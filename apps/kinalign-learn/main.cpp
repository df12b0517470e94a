// SPDX-License-Identifier: Apache-2.0
// Trains one model: kinalign-learn JOB.json. `kinalign train` writes the job and starts this.
#include "apps/kinalign-learn/job.h"

#include <nlohmann/json.hpp>
#include <torch/torch.h>

#include <csignal>
#include <fstream>
#include <iostream>
#include <iterator>

namespace {

int fail(const kinalign::Error& error) {
  std::cout << nlohmann::ordered_json{{"error",
                                       {{"file", error.file},
                                        {"expected", error.expected},
                                        {"found", error.found}}}}
                   .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            << std::endl;
  std::cerr << "kinalign-learn: " << kinalign::to_string(error) << "\n";
  return 3;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: kinalign-learn JOB.json\n"
                 "Trains one model. kinalign train writes the job and starts this program.\n";
    return 2;
  }
  std::signal(SIGPIPE, SIG_IGN);  // a parent that is gone shows when a line can't be written
  // First of all: threads that start later inherit it. Numbers near zero cost a hundredfold.
  at::globalContext().setFlushDenormal(true);
  at::globalContext().setDeterministicAlgorithms(true, true);
  std::ifstream in(argv[1], std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  try {
    auto job = kinalign::read_job(text, argv[1]);
    if (!job) return fail(job.error());
    torch::set_num_threads(static_cast<int>(job->threads));
    const auto done = kinalign::run_job(*job);
    return done ? 0 : fail(done.error());
  } catch (const std::exception& fault) {  // of LibTorch
    return fail({argv[1], 0, "a job that LibTorch can do", fault.what()});
  }
}
