// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/xdf/xdf.h"

#include "tests/formats/xdf/xdf_cases.h"
#include "tests/page_bytes.h"
#include "tests/seeds.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <limits>

using namespace kinalign;

namespace {

using Integers = std::vector<std::int64_t>;
using Doubles = std::vector<double>;
using Texts = std::vector<std::string>;
using Strings = std::vector<std::string>;

const Integers& integers(const XdfRead& read, std::uint32_t id) {
  return std::get<Integers>(read.samples.at(id).values);
}

std::string text_value(const std::string& text, unsigned width = 1) {
  return xdf_length(text.size(), width) + text;
}

}  // namespace

TEST_CASE("xdf: the page's file is what is read") {
  const auto bytes = bytes_of_page("xdf.md", "file");
  const auto read = read_xdf(std::string(bytes.begin(), bytes.end()));
  CHECK(read.error.empty());
  CHECK(read.findings.empty());
  REQUIRE(read.streams.size() == 1);
  CHECK(read.streams[0].id == 7);
  CHECK(read.streams[0].name == "A");
  CHECK(read.streams[0].nominal_rate_hz == 4.0);
  CHECK(read.samples.at(7) == XdfSamples{7, {5.5, 5.75}, {0, 1}, Integers{192, -1, 12, 22}});
  CHECK(read.offsets == std::vector{XdfClockOffset{7, 6.0, -0.125}});
}

// The values are those in the README of xdf-modules/example-files @ 76a6be7.
TEST_CASE("xdf: minimal.xdf holds what its README lists" * doctest::skip(!shared_data())) {
  const auto read = read_xdf(shared_text("xdf/minimal.xdf"));
  CHECK(read.error.empty());
  REQUIRE(read.streams.size() == 2);
  CHECK(read.streams[0].name == "SendDataC");
  CHECK(read.streams[0].type == "EEG");
  CHECK(read.streams[0].channel_count == 3);
  CHECK(read.streams[0].format == XdfFormat::int16);
  CHECK(read.streams[0].created_at == "50942.723319709003");
  CHECK(read.streams[1].id == 0x02c0ffee);
  CHECK(read.streams[1].format == XdfFormat::string);
  const auto& samples = read.samples.at(0);
  CHECK(samples.size() == 9);
  for (std::size_t k = 0; k < 9; ++k) {
    CHECK(samples.stamps[k] == doctest::Approx(5.1 + 0.1 * static_cast<double>(k)).epsilon(1e-12));
  }
  CHECK(samples.deduced == std::vector<std::uint8_t>{0, 0, 1, 1, 0, 0, 1, 1, 1});
  CHECK(integers(read, 0) == Integers{192, 255, 238, 12, 22, 32, 13, 23, 33, 14, 24, 34, 15, 25,
                                      35,  12,  22,  32, 13, 23, 33, 14, 24, 34, 15, 25, 35});
  const auto& texts = std::get<Texts>(read.samples.at(0x02c0ffee).values);
  CHECK(texts.size() == 9);
  CHECK(texts[0].starts_with("<?xml"));
  CHECK(Texts(texts.begin() + 1, texts.begin() + 5) == Texts{"Hello", "World", "from", "LSL"});
  // The chunks hold -0.1 both times; the footers, which are skipped, hold -0.01 and -0.02.
  CHECK(read.offsets == std::vector{XdfClockOffset{0, 6.1, -0.1}, XdfClockOffset{0, 7.1, -0.1}});
  CHECK(read.findings.empty());
}

TEST_CASE("xdf: streams without samples are streams" * doctest::skip(!shared_data())) {
  const auto read = read_xdf(shared_text("xdf/empty_streams.xdf"));
  CHECK(read.findings.empty());
  CHECK(read.streams.size() == 4);
  CHECK(read.streams[0].hostname == "kassia");
  CHECK(read.streams[0].source_id == "test_stream.py:191790:0");
  CHECK(!read.samples.contains(2));
  CHECK(!read.samples.contains(3));
  CHECK(integers(read, 4) == Integers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(std::get<Texts>(read.samples.at(1).values) == Texts{"{\"state\": 2}"});
  CHECK(read.offsets.size() == 28);  // chunks of kind 4, counted by a Python script
}

TEST_CASE("xdf: every format keeps its values exactly") {
  std::string file = xdf_begin;
  file += xdf_header(1, "int8", 2) + xdf_samples(1, 1, xdf_sample(1.0, "\x80\x7f"));
  file += xdf_header(2, "int16", 1) +
          xdf_samples(2, 1, xdf_sample(1.0, little_text(std::uint16_t{0x8000})));
  file += xdf_header(3, "int32", 1) +
          xdf_samples(3, 1, xdf_sample(1.0, little_text(std::uint32_t{0x80000000})));
  // 2^53 + 1, which no double can hold.
  const auto large = static_cast<std::int64_t>(9'007'199'254'740'993);
  file += xdf_header(4, "int64", 1) +
          xdf_samples(4, 1, xdf_sample(1.0, little_text(static_cast<std::uint64_t>(large))));
  file += xdf_header(5, "float32", 1) +
          xdf_samples(5, 1, xdf_sample(1.0, little_text(std::bit_cast<std::uint32_t>(0.1F))));
  file += xdf_header(6, "double64", 1) + xdf_samples(6, 1, xdf_sample(1.0, little_text(0.1)));
  file +=
      xdf_header(7, "string", 2) +
      xdf_samples(7, 1, xdf_sample(1.0, text_value("", 1) + text_value("\xc3\xa9t\xc3\xa9", 8)));
  file += xdf_header(8, "double", 1) + xdf_header(9, "float", 1);
  const auto read = read_xdf(file);
  CHECK(read.findings.empty());
  CHECK(integers(read, 1) == Integers{-128, 127});
  CHECK(integers(read, 2) == Integers{-32768});
  CHECK(integers(read, 3) == Integers{-2147483648LL});
  CHECK(integers(read, 4) == Integers{large});
  CHECK(std::get<Doubles>(read.samples.at(5).values) == Doubles{0.1F});
  CHECK(std::get<Doubles>(read.samples.at(6).values) == Doubles{0.1});
  CHECK(std::get<Texts>(read.samples.at(7).values) == Texts{"", "\xc3\xa9t\xc3\xa9"});
  CHECK(read.streams.size() == 9);
}

TEST_CASE("xdf: lengths have 1, 4 or 8 bytes, as writers like") {
  for (const unsigned width : {1U, 4U, 8U}) {
    const std::string samples = xdf_sample(2.0, "a") + xdf_sample("b");
    const std::string file = xdf_begin + xdf_header(1, "int8", 1, "2") +
                             xdf_chunk(3, little_text(1U) + xdf_length(2, width) + samples, width);
    const auto read = read_xdf(file);
    CHECK(read.findings.empty());
    CHECK(read.samples.at(1).stamps == Doubles{2.0, 2.5});
  }
}

TEST_CASE("xdf: a stamp is deduced over the ends of chunks, and stands still where no rate is") {
  const std::string file = xdf_begin + xdf_header(1, "int8", 1, "4") + xdf_header(2, "int8", 1) +
                           xdf_samples(1, 1, xdf_sample(3.0, "a")) +
                           xdf_samples(2, 1, xdf_sample(9.0, "a")) +
                           xdf_samples(1, 1, xdf_sample("b")) + xdf_samples(2, 1, xdf_sample("b"));
  const auto read = read_xdf(file);
  CHECK(read.samples.at(1).stamps == Doubles{3.0, 3.25});
  CHECK(read.samples.at(2).stamps == Doubles{9.0, 9.0});
  CHECK(read.samples.at(2).deduced == std::vector<std::uint8_t>{0, 1});
}

TEST_CASE("xdf: channels are named where all are described") {
  const std::string one =
      "<channel><label>hand_X</label><unit>meters</unit>"
      "<type>PositionX</type></channel>";
  const std::string both = "<desc><channels>" + one +
                           "<channel><label>b &amp; c</label></channel>" + "</channels></desc>";
  auto read = read_xdf(xdf_begin + xdf_header(1, "int8", 2, "0", both));
  REQUIRE(read.streams.size() == 1);
  CHECK(read.streams[0].channels ==
        std::vector<XdfChannel>{{"hand_X", "meters", "PositionX"}, {"b & c", "", ""}});
  read = read_xdf(xdf_begin + xdf_header(1, "int8", 3, "0", both));
  CHECK(read.streams[0].channels.empty());
  CHECK(
      read.findings ==
      Strings{"rec.xdf: expected 3 channels described in the header of stream 1, found 2 at byte " +
              std::to_string(xdf_begin.size())});
}

TEST_CASE("xdf: where the file is cut into pieces changes nothing, damaged or not") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string file = xdf_begin + xdf_header(1, "int16", 2, "10") + xdf_header(2, "string", 1);
    for (int k = 0; k < 12; ++k) {
      file += xdf_samples(1, 2, xdf_sample(1.0 * k, "abcd") + xdf_sample("efgh"));
      file += xdf_samples(2, 1, xdf_sample(1.0 * k, text_value("word", 4)));
      file += xdf_offset(1, k, 0.5);
      if (k % 3 == 2) file += xdf_boundary();
    }
    for (auto n = random() % 4; n > 0; --n) {
      file[4 + random() % (file.size() - 4)] = static_cast<char>(random());
    }
    const auto whole = read_xdf(file);
    for (const std::size_t most : {1, 7, 100}) {
      const auto cut = read_xdf(file, most, seed);
      // NaN is unequal to itself, but rows with sane stamps have none, so they can be compared.
      CHECK(cut.findings == whole.findings);
      CHECK(cut.samples.size() == whole.samples.size());
      for (const auto& [id, samples] : whole.samples) {
        CHECK(cut.samples.at(id).values == samples.values);
        CHECK(cut.samples.at(id).deduced == samples.deduced);
      }
      CHECK(cut.offsets.size() == whole.offsets.size());
    }
  }
}

TEST_CASE("xdf: a file cut anywhere gives what stands whole before the cut") {
  std::string file = xdf_begin + xdf_header(1, "int8", 1);
  std::vector<std::size_t> ends;
  for (int k = 0; k < 10; ++k) {
    file += xdf_samples(1, 1, xdf_sample(k, "x"));
    ends.push_back(file.size());
  }
  for (std::size_t cut = ends[0]; cut < file.size(); ++cut) {
    const auto read = read_xdf(std::string_view(file).substr(0, cut));
    const auto whole =
        std::count_if(ends.begin(), ends.end(), [&](auto end) { return end <= cut; });
    CHECK(read.error.empty());
    CHECK(read.samples.at(1).size() == static_cast<std::size_t>(whole));
    const bool at_end = std::find(ends.begin(), ends.end(), cut) != ends.end();
    CHECK(read.findings.size() == (at_end ? 0 : 1));
  }
}

TEST_CASE("xdf: a chunk that claims more than the file holds is a finding") {
  std::string file = xdf_begin + xdf_header(1, "int8", 1);
  file += xdf_length(std::uint64_t{1} << 60, 8) + little_text(std::uint16_t{3}) + "rest";
  CHECK(read_xdf(file).findings ==
        Strings{
            "rec.xdf: expected a last chunk of 1152921504606846976 bytes, found 6 bytes at byte " +
            std::to_string(file.size() - 15)});
}

TEST_CASE("xdf: damage ends at the next boundary, whatever was damaged") {
  const std::string before =
      xdf_begin + xdf_header(1, "int8", 1) + xdf_samples(1, 1, xdf_sample(1.0, "a"));
  const std::string damaged = xdf_samples(1, 1, xdf_sample(2.0, "b"));
  const std::string after = xdf_boundary() + xdf_samples(1, 1, xdf_sample(3.0, "c"));
  for (const char byte : {'\0', '\2', '\4', '\10', '\377'}) {
    for (std::size_t at = 0; at < 5; ++at) {
      CAPTURE(at);
      std::string bad = damaged;
      if (bad[at] == byte) continue;
      bad[at] = byte;
      const auto read = read_xdf(before + bad + after);
      const auto& stamps = read.samples.at(1).stamps;
      CHECK(stamps.front() == 1.0);
      CHECK(stamps.back() == 3.0);
      CHECK(!read.findings.empty());
    }
  }
}

TEST_CASE("xdf: rubbish without a boundary is not kept") {
  XdfReader reader("rec.xdf");
  std::vector<XdfItem> items;
  REQUIRE(reader.feed(xdf_begin + "\x07", items));
  for (int k = 0; k < 1000; ++k) REQUIRE(reader.feed(std::string(10'000, '\x43'), items));
  REQUIRE(reader.feed(xdf_boundary() + xdf_header(1, "int8", 1), items));
  REQUIRE(reader.finish(items));
  CHECK(items.size() == 1);
}

TEST_CASE("xdf: samples that are fewer or more than stated are those that are whole") {
  const std::string begin = xdf_begin + xdf_header(1, "int16", 2);
  auto read = read_xdf(begin + xdf_samples(1, 9, xdf_sample(1.0, "abcd") + xdf_sample(2.0, "ab")));
  CHECK(read.samples.at(1).size() == 1);
  CHECK(integers(read, 1).size() == 2);
  CHECK(read.findings ==
        Strings{"rec.xdf: expected as many whole samples in a chunk as it states, found 1 of 9 "
                "(stream 1) at byte " +
                std::to_string(begin.size())});
  read = read_xdf(begin + xdf_samples(1, 1, xdf_sample(1.0, "abcd") + "xyz"));
  CHECK(read.samples.at(1).size() == 1);
  CHECK(read.findings[0].find("found 3 bytes") != std::string::npos);
  // The length of a stamp may be 0 or 8.
  read = read_xdf(begin + xdf_samples(1, 1, "\x05" + std::string(12, 'x')));
  CHECK(read.samples.empty());
}

TEST_CASE("xdf: numbers of channels and samples are believed only as far as there are bytes") {
  const std::string huge = "4294967295";
  for (const std::string format : {"int8", "double64", "string"}) {
    std::string header = xdf_header(1, format, 1);
    header = xdf_chunk(2, little_text(1U) + "<info><channel_count>" + huge +
                              "</channel_count><nominal_srate>0</nominal_srate><channel_format>" +
                              format + "</channel_format></info>");
    const auto read = read_xdf(xdf_begin + header +
                               xdf_samples(1, ~std::uint64_t{0}, xdf_sample(1.0, "abcd"), 8));
    CHECK(read.samples.empty());
    CHECK(read.findings.size() == 1);
  }
}

TEST_CASE("xdf: a text that claims more than its chunk holds ends the chunk") {
  const auto read =
      read_xdf(xdf_begin + xdf_header(1, "string", 2) +
               xdf_samples(1, 2,
                           xdf_sample(1.0, text_value("a") + text_value("b")) +
                               xdf_sample(2.0, text_value("c") + "\x01\x7f" + "short")));
  CHECK(std::get<Texts>(read.samples.at(1).values) == Texts{"a", "b"});
}

TEST_CASE("xdf: headers that can't be used are named, and their samples are none") {
  for (const auto& [xml, finding] : std::vector<std::pair<std::string, std::string>>{
           {"<info><channel_format>int8</channel_format></info>",
            "expected a channel_count in the header of stream 1, found none: its samples can't be "
            "read"},
           {"<info><channel_count>-1</channel_count></info>",
            "expected a channel_count in the header of stream 1, found '-1': its samples can't be "
            "read"},
           {"<info><channel_count>1</channel_count><channel_format>int7</channel_format></info>",
            "expected a known channel_format in the header of stream 1, found 'int7': its "
            "samples can't be read"}}) {
    const auto read = read_xdf(xdf_begin + xdf_chunk(2, little_text(1U) + xml) +
                               xdf_samples(1, 1, xdf_sample(1.0, "a")));
    CHECK(read.streams.empty());
    CHECK(read.samples.empty());
    CHECK(read.findings ==
          Strings{"rec.xdf: " + finding + " at byte " + std::to_string(xdf_begin.size())});
  }
}

TEST_CASE("xdf: what breaks a rule and can be read all the same is counted") {
  std::string file = xdf_begin + xdf_header(1, "int8", 1);
  file += xdf_header(1, "int16", 1);
  file += xdf_chunk(9, "new") + xdf_chunk(9, "newer");
  file += xdf_samples(3, 1, xdf_sample(1.0, "a"));
  file += xdf_offset(1, 1.0, std::numeric_limits<double>::quiet_NaN());
  file += xdf_offset(1, 1e15, 0.0);
  file += xdf_chunk(4, "short");
  file += xdf_samples(1, 1, xdf_sample(1.0, "a"));
  const auto read = read_xdf(file);
  CHECK(integers(read, 1) == Integers{'a'});
  CHECK(read.offsets.empty());
  REQUIRE(read.findings.size() == 5);
  CHECK(read.findings[1].find("expected chunks of kinds 1 to 6, found a chunk of kind 9 at byte") !=
        std::string::npos);
  CHECK(read.findings[1].ends_with(", 2 times"));
}

TEST_CASE("xdf: other files are refused, packed ones with what to do") {
  CHECK(read_xdf("XDG:").error == "rec.xdf: expected XDF: at the beginning, found 'XDG:'");
  CHECK(read_xdf("XD").error ==
        "rec.xdf: expected XDF: at the beginning, found the end of the file");
  CHECK(read_xdf("\x1f\x8b\x08").error ==
        "rec.xdf: expected an XDF file, unpacked (gzip -d), found a file packed by gzip");
  CHECK(looks_like_xdf("XDF:..."));
  CHECK(!looks_like_xdf("XD"));
}
