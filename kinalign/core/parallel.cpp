// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace kinalign {

namespace {

/// `next_` gives each index to one thread, in rising order. A thread whose call threw takes no
/// further index; the others continue.
/// The state shared by the threads of one call.
class Shared {
 public:
  Shared(std::size_t count, const std::function<void(std::size_t)>& body)
      : count_(count), body_(body) {}

  void work() {
    try {
      for (std::size_t i = next_++; i < count_; i = next_++) body_(i);
    } catch (...) {
      if (!thrown_.test_and_set()) fault_ = std::current_exception();
    }
  }

  /// Call after all threads have ended.
  void rethrow() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  std::size_t count_;
  const std::function<void(std::size_t)>& body_;
  std::atomic<std::size_t> next_{0};
  std::atomic_flag thrown_;
  // Written by the one thread that set thrown_, and read after all threads have ended.
  std::exception_ptr fault_;
};

}  // namespace

void parallel_for(std::size_t count, std::size_t jobs,
                  const std::function<void(std::size_t)>& body) {
  const std::size_t threads = std::min(count, std::max<std::size_t>(jobs, 1));
  // The caller's thread works, too, so one thread less is started. The inner block ends when all
  // threads have ended, because std::jthread joins in its destructor.
  Shared shared(count, body);
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t i = 1; i < threads; ++i) others.emplace_back([&shared] { shared.work(); });
    } catch (const std::system_error&) {
      // No more threads are available; the threads already started do all the work.
    }
    shared.work();
  }
  shared.rethrow();
}

}  // namespace kinalign
