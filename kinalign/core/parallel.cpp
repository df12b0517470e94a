// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace kinalign {

void parallel_for(std::size_t count, std::size_t jobs,
                  const std::function<void(std::size_t)>& body) {
  const std::size_t threads = std::min(count, std::max<std::size_t>(jobs, 1));
  // `next` gives each index to one thread, in rising order. If a call throws, its thread takes no
  // further index. The other threads continue.
  std::atomic<std::size_t> next{0};
  std::atomic_flag thrown;
  // Written by the one thread that set `thrown`, and read after all threads have ended.
  std::exception_ptr fault;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) body(i);
    } catch (...) {
      if (!thrown.test_and_set()) fault = std::current_exception();
    }
  };
  // The caller's thread works, too, so `jobs` - 1 threads are started. The destructor of
  // std::jthread joins, so the inner block ends when all threads have ended.
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
    } catch (const std::system_error&) {
      // The system can't start more threads. The threads that run already do all the work.
    }
    work();
  }
  if (fault) std::rethrow_exception(fault);
}

}  // namespace kinalign
