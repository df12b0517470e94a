// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/take_pages.h"

#include "tests/dataset/report/summarised_set.h"

#include <mutex>
#include <set>

using namespace kinalign;

namespace {

const std::vector<std::string> three{"sub-01_task-A_run-01", "sub-01_task-A_run-02",
                                     "sub-02_task-A_run-01"};

class PagedSet : public SummarisedSet {
 public:
  PagedSet() {
    for (const std::string& name : three) put(*parse_take_name(name), summary(0, 0, 0.01));
  }

  /// Makes pages of a few bytes; making the page of the take `faulty` fails.
  Result<PagesMade> make(const std::string& software = "kinalign 1", const std::string& faulty = "",
                         const std::vector<std::string>& takes = three) {
    made.clear();
    const DatasetIndex index = open();
    TakePages pages(files, folder.path(), folder / "report", software);
    const MakePage make_page = [&](const PageJob& job) -> Result<void> {
      if (to_string(job.name) == faulty) return Failure(Error{job.take, 0, "a take", "none"});
      const std::lock_guard lock(mutex);
      made.insert(to_string(job.name));
      folder.write("report/" + to_string(job.name) + ".html",
                   "<meta name=\"generator\" content=\"kinalign 1\">" + job.sha256);
      return {};
    };
    return pages.make(index, takes, 2, make_page, {});
  }

  std::mutex mutex;
  std::set<std::string> made;
};

}  // namespace

TEST_CASE("only pages of takes that are new or changed are made, and those of an older kinalign") {
  PagedSet set;
  auto done = set.make();
  REQUIRE(done);
  CHECK(done->made == 3);
  done = set.make();
  REQUIRE(done);
  CHECK(done->made == 0);
  CHECK(done->up_to_date == 3);
  TakeSummary changed = SummarisedSet::summary(0, 0, 0.01);
  changed.sha256 = std::string(64, 'b');
  set.put({"01", "A", 2}, changed);
  std::filesystem::remove(set.folder / "report/sub-02_task-A_run-01.html");
  REQUIRE(set.make());
  CHECK(set.made == std::set<std::string>{three[1], three[2]});
  REQUIRE(set.make("kinalign 2"));
  CHECK(set.made.size() == 3);
  set.folder.write("report/pages.json", "{\"schema\": ");
  REQUIRE(set.make("kinalign 2"));
  CHECK(set.made.size() == 3);
}

TEST_CASE("a take that the index lacks is neither made nor up to date") {
  PagedSet set;
  const auto done = set.make("kinalign 1", "", {three[0], "sub-09_task-A_run-01"});
  REQUIRE(done);
  CHECK(done->made == 1);
  CHECK(done->up_to_date == 0);
}

TEST_CASE("a page that fails stops no other, and is made the next time") {
  PagedSet set;
  auto done = set.make("kinalign 1", three[0]);
  REQUIRE(done);
  CHECK(done->made == 2);
  REQUIRE(done->failed.size() == 1);
  CHECK(done->failed[0].file.ends_with("sub-01_task-A_run-01_take.h5"));
  REQUIRE(set.make());
  CHECK(set.made == std::set<std::string>{three[0]});
}

TEST_CASE("pages of takes that are gone go, and no file of another kind is replaced") {
  PagedSet set;
  REQUIRE(set.make());
  std::filesystem::remove_all(set.folder / "sub-02");
  auto done = set.make();
  REQUIRE(done);
  CHECK(done->removed == 1);
  CHECK(!std::filesystem::exists(set.folder / "report/sub-02_task-A_run-01.html"));
  std::filesystem::remove(set.folder / "report/pages.json");
  set.folder.write("report/sub-01_task-A_run-02.html", "<p>notes of my own</p>");
  done = set.make();
  REQUIRE(!done);
  CHECK(done.error().expected == "a page that kinalign wrote, or no file");
  CHECK(set.folder.read("report/sub-01_task-A_run-02.html") == "<p>notes of my own</p>");
}

TEST_CASE("a page is current for the bytes of its take alone") {
  PagedSet set;
  REQUIRE(set.make());
  const TakePages pages(set.files, set.folder.path(), set.folder / "report", "kinalign 1");
  CHECK(pages.page_of(three[0], std::string(64, 'a')) == three[0] + ".html");
  CHECK(pages.page_of(three[0], std::string(64, 'b')).empty());
  CHECK(pages.page_of("sub-09_task-A_run-01", std::string(64, 'a')).empty());
}
