// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/dataset_page/dataset_html.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

DatasetPage small_page() {
  DatasetPage page;
  page.name = "walks";
  page.software = "kinalign 0.1.0";
  page.folder = "walks";
  page.people = 2;
  page.takes = 3;
  page.mocap_frames = page.kinect_frames = 2400;
  page.seconds = 80.0;
  page.bad = 1;
  page.good = 2;
  DatasetTake take;
  take.name = "sub-03_task-S2A03_run-01";
  take.subject = "03";
  take.class_id = "S2";
  take.action = "S2A03";
  take.verdict = "bad";
  take.reason = "kinect: expected one, found another";
  take.frames = 3600;
  take.seconds = 60.0;
  take.has_mocap = take.has_kinect = true;
  take.residual_cm = 3.04;
  take.kinect_valid = 0.978;
  page.worst = {take};
  page.takes_without_page = 1;
  Table table;
  table.caption = "Frames by class";
  table.columns = {{"class", "class"}, {"mocap", "mocap"}};
  table.rows = {{std::string("S2"), std::int64_t{3600}}, {std::string("sum"), std::int64_t{3600}}};
  table.has_sum = true;
  page.tables = {table};
  return page;
}

bool has(const std::string& html, std::string_view text) {
  return html.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "the page has its verdicts, a row of each take, the tables and what the table leaves out") {
  const std::string html = dataset_html(small_page());
  CHECK(has(html, "<title>walks: 1 bad, 2 good</title>"));
  CHECK(has(html, dataset_page_mark));
  CHECK(has(html, "; print-color-adjust: exact"));  // colours of the legend, on paper
  CHECK(has(html,
            "<span>sub-03_task-S2A03_run-01</span><small>kinect: expected one, found "
            "another</small>"));
  CHECK(has(html,
            "<td>3,600</td><td>60.0</td><td class=\"text\">mocap, Kinect</td><td>3.0</td>"
            "<td>97.8</td><td>–</td></tr>"));
  CHECK(has(html, "<tr class=\"sum\"><td class=\"text\">sum</td><td>3,600</td></tr>"));
  CHECK(
      has(html, "The table has the 1 worst of 3 takes; <code>kinalign dataset list walks</code>"));
  CHECK(has(html, "<code>kinalign dataset report walks --pages</code> makes them."));
  CHECK(!has(html, "{{"));
  CHECK(html == dataset_html(small_page()));
}

TEST_CASE("a take with a page is a link, and a page of all takes mentions no others") {
  DatasetPage page = small_page();
  page.worst[0].page = "report/sub-03_task-S2A03_run-01.html";
  page.takes_without_page = 0;
  page.takes = 1;
  const std::string html = dataset_html(page);
  CHECK(has(html, "<a href=\"report/sub-03_task-S2A03_run-01.html\">sub-03_task-S2A03_run-01</a>"));
  CHECK(!has(html, "--pages"));
  CHECK(!has(html, "worst of"));
}

TEST_CASE("a data set without takes has a page that says so") {
  DatasetPage page;
  page.not_built = 1;
  page.folder = "walks";
  const std::string html = dataset_html(page);
  CHECK(has(html, "no takes yet"));
  CHECK(
      has(html,
          "1 take is not built and not in the table: <code>kinalign dataset build walks</code>."));
}

TEST_CASE("texts of dataset.toml and of takes are text on the page, and no address is in it") {
  const std::string attack = "</script><script>alert(1)</script><b a='\">&";
  DatasetPage page = small_page();
  for (std::string* text :
       {&page.name, &page.licence, &page.contact, &page.description, &page.citation, &page.folder,
        &page.worst[0].reason, &page.worst[0].action_name, &page.worst[0].class_id,
        &page.worst[0].verdict, &page.tables[0].caption, &page.tables[0].columns[0].title}) {
    *text = attack;
  }
  page.tables[0].rows[0][0] = attack;
  const std::string html = dataset_html(page);
  CHECK(!has(html, "<script>alert"));
  CHECK(!has(html, "<b a="));
  CHECK(has(html, "&lt;script&gt;alert(1)&lt;/script&gt;&lt;b a=&#39;&quot;&gt;&amp;"));
  CHECK(!has(html, "http:"));
  CHECK(!has(html, "https:"));
}
