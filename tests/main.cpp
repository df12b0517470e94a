// SPDX-License-Identifier: Apache-2.0
// The main function of all test programs. Beside doctest's own output it writes one line for each
// case to the file named by KINALIGN_TEST_LOG: passed, failed or skipped, a tab, the case. ./dev
// test counts these lines. A case that needs ../shared/data and can't find it is skipped, and its
// line says so. A case that is skipped for another reason says it in its doctest::description,
// which follows after a second tab. Each line is written at once, because several programs share
// the file.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace {

class CaseLog : public doctest::IReporter {
 public:
  explicit CaseLog(const doctest::ContextOptions& options) : options_(options) {
    if (const char* path = std::getenv("KINALIGN_TEST_LOG")) log_.open(path, std::ios::app);
  }
  void test_case_start(const doctest::TestCaseData& data) override { name_ = data.m_name; }
  void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
    if (log_.is_open())
      log_ << (stats.testCaseSuccess ? "passed\t" : "failed\t") << name_ << std::endl;
  }
  void test_case_skipped(const doctest::TestCaseData& data) override {
    if (!log_.is_open() || !data.m_skip) return;
    log_ << "skipped\t" << data.m_name;
    if (data.m_description != nullptr) log_ << '\t' << data.m_description;
    log_ << std::endl;
  }
  void report_query(const doctest::QueryData&) override {}
  void test_run_start() override {}
  void test_run_end(const doctest::TestRunStats&) override {}
  void test_case_reenter(const doctest::TestCaseData&) override {}
  void test_case_exception(const doctest::TestCaseException&) override {}
  void subcase_start(const doctest::SubcaseSignature&) override {}
  void subcase_end() override {}
  void log_assert(const doctest::AssertData&) override {}
  void log_message(const doctest::MessageData&) override {}

 private:
  const doctest::ContextOptions& options_;
  std::ofstream log_;
  std::string name_;
};

REGISTER_LISTENER("case_log", 1, CaseLog);

}  // namespace

int main(int argc, char** argv) { return doctest::Context(argc, argv).run(); }
