// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/vicon_trigger.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

using Refusal = ViconRefusal;

ViconTrigger read(const std::string& datagram) {
  ViconTrigger trigger;
  REQUIRE(decode_vicon_trigger(datagram, trigger) == Refusal::none);
  return trigger;
}

Refusal refusal_of(const std::string& datagram) {
  ViconTrigger trigger;
  const Refusal refusal = decode_vicon_trigger(datagram, trigger);
  if (refusal != Refusal::none) CHECK(trigger == ViconTrigger{});
  return refusal;
}

std::string start_of(const std::string& elements) {
  return "<CaptureStart>" + elements + "</CaptureStart>";
}

/// The n-th document in the page, which is from Vicon's manual.
std::string of_page(int n) {
  const std::string page = bytes_in(KINALIGN_SOURCE_DIR "/docs/formats/marks.md");
  std::size_t at = 0;
  for (int i = 0; i <= n; ++i) at = page.find("```xml\n", at) + 7;
  return page.substr(at, page.find("```", at) - at);
}

}  // namespace

TEST_CASE("the manual's start and stop are marks") {
  const ViconTrigger start = read(of_page(0));
  CHECK(start == ViconTrigger{true, "dance", "The pets ants crime deer jump. ",
                              "The crowd pencil pets alert fold deer.",
                              "D:/Jeremy/Susan/Captures/Take", "", 33ms, 33360});
  const ViconTrigger stop = read(of_page(1));
  CHECK(stop == ViconTrigger{false, "dance", "", "", "D:/Jeremy/Susan/Captures/Take", "SUCCESS",
                             33ms, 33363});
  CHECK(mark_of(start) == Mark{Mark::Kind::start, "dance", 33ms, "start 33360 dance"});
  CHECK(mark_of(stop) == Mark{Mark::Kind::stop, "dance", 33ms, "stop 33363 dance"});
}

TEST_CASE("entities are characters") {
  const ViconTrigger trigger =
      read(start_of("<Name VALUE='&lt;&gt;&amp;&quot;&apos;&#65;&#x42;&#xe4;"
                    "&#x20ac;&#x1f600;&#9;&#13;&#10;'/>"));
  CHECK(trigger.name == "<>&\"'AB\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80\t\r\n");
}

TEST_CASE("zeros behind the document are no part of it") {
  CHECK(read(of_page(0) + '\0') == read(of_page(0)));
  CHECK(refusal_of(start_of(std::string("<Name VALUE='a\0'/>", 18))) == Refusal::bad_xml);
}

TEST_CASE("other programs' documents are read: order, more elements, blanks, other quotes") {
  const ViconTrigger trigger = read(
      "\n<?xml version=\"1.0\" encoding=\"utf-8\" standalone=\"no\"?>\n<CaptureStart>\n"
      "<PacketID VALUE='42' ></PacketID ><Name\n VALUE = \"CAST 01\" /><HostName VALUE=\"QTM-PC\"/>"
      "<Name2/></CaptureStart >\n\0");
  CHECK(trigger.name == "CAST 01");
  CHECK(trigger.packet_id == 42);
  CHECK(read("<CaptureStart Name=\"x\"></CaptureStart>").name.empty());
  CHECK(read("<CaptureStart/>") == read(start_of("")));
  CHECK(!trigger.delay);
  CHECK(mark_of(read(start_of(""))) == Mark{Mark::Kind::start, "", {}, ""});
}

TEST_CASE("each fault of a broadcast has its name") {
  CHECK(refusal_of(std::string(1501, ' ')) == Refusal::too_long);
  for (const char* bad :
       {"", "<", "<CaptureStart", "<CaptureStart>", "<CaptureStart></CaptureStop>", "<?xml",
        "CaptureStart", "<CaptureStart></CaptureStart", "<CaptureStart></CaptureStart>x",
        "<!DOCTYPE a><CaptureStart></CaptureStart>", "<CaptureStart RESULT></CaptureStart>",
        "< ></ >", "<CaptureStart RESULT=\"></CaptureStart>"}) {
    CAPTURE(bad);
    CHECK(refusal_of(bad) == Refusal::bad_xml);
  }
  for (const char* bad :
       {"x", "<Name VALUE=dance/>", "<Name VALUE=\"dance\">", "<Name VALUE=\"dance\"></Nam>",
        "<Name><b/></Name>", "<Name VALUE=\"a<b\"/>", "<Name VALUE=\"&nbsp;\"/>",
        "<Name VALUE=\"&lt\"/>", "<Name VALUE=\"&#x110000;\"/>", "<Name VALUE=\"&#;\"/>",
        "<Name VALUE=\"&#-5;\"/>", "<Name VALUE=\"&#6 ;\"/>", "<!-- -->", "< Name/>", "< />",
        // Characters that XML 1.0 forbids, and bytes that are not UTF-8.
        "<Name VALUE=\"&#27;[2J\"/>", "<Notes VALUE=\"\xff\"/>", "<Notes VALUE=\"&#xd800;\"/>"}) {
    CAPTURE(bad);
    CHECK(refusal_of(start_of(bad)) == Refusal::bad_xml);
  }
  CHECK(refusal_of("<CaptureComplete></CaptureComplete>") == Refusal::not_capture);
  for (const char* bad :
       {"<Delay VALUE=\"\"/>", "<Delay VALUE=\"-1\"/>", "<Delay VALUE=\"1.5\"/>",
        "<Delay VALUE=\"60001\"/>", "<Delay/>", "<PacketID VALUE=\"9223372036854775808\"/>",
        "<PacketID VALUE=\"x\"/>", "<PacketID VALUE=\"-1\"/>"}) {
    CAPTURE(bad);
    CHECK(refusal_of(start_of(bad)) == Refusal::wrong_number);
  }
  CHECK(refusal_of(start_of("<Delay VALUE=\"60000\"/>")) == Refusal::none);
  CHECK(refusal_of(start_of("<PacketID VALUE=\"9223372036854775807\"/>")) == Refusal::none);
  CHECK(refusal_of(start_of("<Name VALUE=\"a\"/><Name VALUE=\"b\"/>")) == Refusal::twice);
  CHECK(refusal_of(start_of("<Name VALUE=\"&#127;\"/>")) == Refusal::wrong_text);
  CHECK(std::string(name_of(Refusal::twice)) == "twice");
}

TEST_CASE("a broadcast can define no entities, so none expands") {
  CHECK(refusal_of("<!DOCTYPE a [<!ENTITY b \"bbbb\"><!ENTITY c \"&b;&b;&b;&b;\">]>" +
                   start_of("<Name VALUE=\"&c;\"/>")) == Refusal::bad_xml);
}
