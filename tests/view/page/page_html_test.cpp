// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/page_html.h"

#include "tests/view/page/page_takes.h"

#include "kinalign/view/page/assets.h"
#include "kinalign/view/page/page_json.h"
#include "kinalign/view/page/take_figures.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace kinalign;

namespace {

bool built_without_script() { return !page_parts_missing().empty(); }

TakePage page_of(const PageTake& take) {
  TakeFigures figures(take.header, take.report, {});
  figures.add(take.slab);
  TakePage page = figures.finish();
  page.file = "take.h5";
  page.software = "kinalign 0.1.0";
  return page;
}

std::string html_of(const PageTake& take) {
  const auto html = page_html(page_of(take));
  REQUIRE(html);
  return *html;
}

/// A take in which every text that comes from a file tries to inject HTML.
PageTake hostile_take() {
  const std::string attack = "</script><script>alert(1)</script><b a='\">&";
  PageTake take = walking_take(30);
  take.header.subject = take.header.action = attack;
  for (TakeGroup& group : take.header.groups) {
    group.name = attack + group.name;
    for (InputFacts& file : group.files) file.name = file.sha256 = attack;
  }
  std::get<ClipGroup>(take.header.groups[0].kind).skeleton.joint_names[0] = attack;
  std::get<PointGroup>(take.header.groups[1].kind).joint_names[0] = attack;
  for (StreamReport& stream : take.report.streams) stream.stream = attack + stream.stream;
  take.report.reference = attack + "mocap";
  SpaceReport& space = take.report.spaces[0];
  space.stream = attack + "kinect";
  space.onto = attack + "mocap";
  for (JointResidual& joint : space.joints) joint.joint = joint.onto = attack;
  take.report.findings = {{Severity::error, {attack, 1, attack, attack}, attack, attack}};
  take.report.marks = {{take.report.begin, attack, attack, {}, attack}};
  return take;
}

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("text is escaped for elements and attributes, and what is no UTF-8 is shown as such") {
  CHECK(escaped("<a href=\"x\">'&'</a>") ==
        "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  CHECK(escaped("H\xc3\xa4nde \xff") == "H\xc3\xa4nde \xEF\xBF\xBD");
}

TEST_CASE("names with <script> start no script" * doctest::skip(built_without_script())) {
  const std::string plain = html_of(walking_take(30)), html = html_of(hostile_take());
  CHECK(html.find("alert(1)</script>") == std::string::npos);
  CHECK(html.find("<b a=") == std::string::npos);
  CHECK(count_of(html, "<script") == count_of(plain, "<script"));
  CHECK(count_of(html, "</script") == count_of(plain, "</script"));
}

TEST_CASE("the data of a page is JSON that holds no <") {
  const std::string json = page_json(page_of(hostile_take()));
  CHECK(json.find('<') == std::string::npos);
  const auto read = nlohmann::json::parse(json);
  CHECK(read["bodies"].size() == 2);
  CHECK(read["spaces"][0]["pairs"].size() == 2);
  CHECK(read["bodies"][1]["joint_names"][0] == "</script><script>alert(1)</script><b a='\">&");
}

TEST_CASE("the same take gives the same page" * doctest::skip(built_without_script())) {
  CHECK(html_of(walking_take(100)) == html_of(walking_take(100)));
}

TEST_CASE("a page loads nothing and runs its own script alone" *
          doctest::skip(built_without_script())) {
  const std::string html = html_of(walking_take(30));
  CHECK(html.find("default-src 'none'") != std::string::npos);
  CHECK(html.find("script-src 'sha256-") != std::string::npos);
  for (const char* what : {"<link", "<img", "<iframe", " src=", "@import", "url(http"}) {
    CAPTURE(what);
    CHECK(html.substr(0, html.find("<script")).find(what) == std::string::npos);
  }
}

TEST_CASE("a page shows the contents of its take, and no more" *
          doctest::skip(built_without_script())) {
  const std::string html = html_of(walking_take(30));
  CHECK(html.find("kinect was moved onto mocap by one rotation and translation") !=
        std::string::npos);
  CHECK(html.find("id=\"figure7\"") != std::string::npos);
  CHECK(html.find("id=\"nodes\"") == std::string::npos);
  CHECK(html.find("{{") == std::string::npos);
  PageTake alone = walking_take(30);
  alone.header.groups.pop_back();
  alone.slab.rows.pop_back();
  alone.report.spaces.clear();
  alone.report.streams.pop_back();
  const std::string mocap = html_of(alone);
  CHECK(mocap.find("id=\"space\"") == std::string::npos);
  CHECK(mocap.find("<h2 class=\"good\">Good</h2>") != std::string::npos);
}
