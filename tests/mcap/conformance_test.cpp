// SPDX-License-Identifier: Apache-2.0
// The official conformance files. A JSON beside each file lists what a reader must find in it.
#include "tests/mcap/mcap_files.h"
#include "tests/shared_data.h"

#include "kinalign/mcap/reader.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace kinalign {

namespace {

using Json = nlohmann::json;

Json number(std::uint64_t value) { return std::to_string(value); }
Json bytes_of(std::string_view data) {
  Json list = Json::array();
  for (const char c : data) list.push_back(std::to_string(static_cast<std::uint8_t>(c)));
  return list;
}
Json numbers(const std::map<std::uint16_t, std::uint64_t>& map) {
  Json object = Json::object();
  for (const auto& [key, value] : map) object[std::to_string(key)] = number(value);
  return object;
}

Json fields(const McapHeader& r) { return {{"library", r.library}, {"profile", r.profile}}; }
Json fields(const McapSchema& r) {
  return {
      {"data", bytes_of(r.data)}, {"encoding", r.encoding}, {"id", number(r.id)}, {"name", r.name}};
}
Json fields(const McapChannel& r) {
  return {{"id", number(r.id)},
          {"message_encoding", r.message_encoding},
          {"metadata", Json(r.metadata)},
          {"schema_id", number(r.schema_id)},
          {"topic", r.topic}};
}
Json fields(const McapMessage& r) {
  return {{"channel_id", number(r.channel)},
          {"data", bytes_of(r.data)},
          {"log_time", number(r.log_time)},
          {"publish_time", number(r.publish_time)},
          {"sequence", number(r.sequence)}};
}
Json fields(const McapAttachment& r) {
  return {{"create_time", number(r.create_time)},
          {"data", bytes_of(r.data)},
          {"log_time", number(r.log_time)},
          {"media_type", r.media_type},
          {"name", r.name}};
}
Json fields(const McapMetadata& r) { return {{"metadata", Json(r.texts)}, {"name", r.name}}; }
Json fields(const McapChunkIndex& r) {
  return {{"chunk_length", number(r.chunk_length)},
          {"chunk_start_offset", number(r.chunk_offset)},
          {"compressed_size", number(r.compressed_size)},
          {"compression", r.compression},
          {"message_end_time", number(r.end)},
          {"message_index_length", number(r.message_index_length)},
          {"message_index_offsets", numbers(r.message_index_offsets)},
          {"message_start_time", number(r.start)},
          {"uncompressed_size", number(r.uncompressed_size)}};
}
Json fields(const McapAttachmentIndex& r) {
  return {{"create_time", number(r.create_time)},
          {"data_size", number(r.data_size)},
          {"length", number(r.length)},
          {"log_time", number(r.log_time)},
          {"media_type", r.media_type},
          {"name", r.name},
          {"offset", number(r.offset)}};
}
Json fields(const McapMetadataIndex& r) {
  return {{"length", number(r.length)}, {"name", r.name}, {"offset", number(r.offset)}};
}
Json fields(const McapStatistics& r) {
  return {{"attachment_count", number(r.attachments)},
          {"channel_count", number(r.channels)},
          {"channel_message_counts", numbers(r.channel_messages)},
          {"chunk_count", number(r.chunks)},
          {"message_count", number(r.messages)},
          {"message_end_time", number(r.end)},
          {"message_start_time", number(r.start)},
          {"metadata_count", number(r.metadata)},
          {"schema_count", number(r.schemas)}};
}
Json fields(const McapSummaryOffset& r) {
  return {{"group_length", number(r.length)},
          {"group_opcode", number(static_cast<std::uint8_t>(r.group))},
          {"group_start", number(r.start)}};
}
Json fields(const McapDataEnd& r) { return {{"data_section_crc", number(r.data_crc)}}; }
Json fields(const McapFooter& r) {
  return {{"summary_crc", number(r.summary_crc)},
          {"summary_offset_start", number(r.summary_offset_start)},
          {"summary_start", number(r.summary_start)}};
}

std::vector<Json> seen_in(std::string_view bytes) {
  McapReader reader;
  std::vector<Json> seen;
  reader.feed(bytes);
  reader.end();
  while (const auto record = reader.next()) {
    seen.push_back(std::visit([](const auto& r) { return fields(r); }, *record));
  }
  CHECK(reader.closed());
  for (const Finding& finding : reader.findings()) FAIL_CHECK(to_string(finding.what));
  return seen;
}

std::vector<Json> expected_in(const std::string& text) {
  std::vector<Json> expected;
  const Json json = Json::parse(text);
  for (const Json& record : json.at("records")) {
    Json object = Json::object();
    for (const Json& field : record.at("fields")) object[field[0]] = field[1];
    expected.push_back(std::move(object));
  }
  return expected;
}

}  // namespace

TEST_CASE("the conformance files read as they should" * doctest::skip(!shared_data())) {
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(shared_path("mcap/conformance"))) {
    if (entry.path().extension() != ".mcap") continue;
    CAPTURE(entry.path().string());
    auto json = entry.path();
    json.replace_extension(".json");
    CHECK(seen_in(bytes_in(entry.path())) == expected_in(bytes_in(json)));
    ++files;
  }
  CHECK(files == 66);
}

TEST_CASE("files of other writers read whole" * doctest::skip(!shared_data())) {
  const ReadMcap web = read_mcap(shared_text("mcap/example.mcap"));
  CHECK(web.messages.size() == 111);
  const ReadMcap logs = read_mcap(shared_text("mcap/example_logs.mcap"));
  CHECK(logs.messages.size() == 1111);
  CHECK((web.closed && logs.closed && web.findings.empty() && logs.findings.empty()));
}

}  // namespace kinalign
