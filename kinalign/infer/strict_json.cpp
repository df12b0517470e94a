// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/strict_json.h"

#include <nlohmann/json.hpp>

#include <set>
#include <vector>

namespace kinalign {

namespace {

using Json = nlohmann::json;

/// Observes the parser and records the first fault that the parser itself accepts.
class Watch {
 public:
  // Called by the parser for each event. Returning false drops the value.
  bool see(int depth, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys_.emplace_back();
    if (event == Json::parse_event_t::object_end) keys_.pop_back();
    if (event == Json::parse_event_t::key && !keys_.back().insert(parsed).second &&
        duplicate_.empty()) {
      duplicate_ = "\"" + shown(parsed.get<std::string>()) + "\" twice";
    }
    if (depth > most_json_depth) deep_ = true;
    return !deep_;  // false: deeper values are not stored
  }
  bool deep() const { return deep_; }
  const std::string& duplicate() const { return duplicate_; }

 private:
  std::vector<std::set<std::string>> keys_;  // keys of the open objects
  std::string duplicate_;
  bool deep_ = false;
};

}  // namespace

Result<Json> parse_strict_json(std::string_view text, const std::string& name) {
  Watch watch;
  const auto see = [&watch](int depth, Json::parse_event_t event, const Json& parsed) {
    return watch.see(depth, event, parsed);
  };
  Json json;
  // The library throws; the exceptions end here, and callers get an error as a value.
  try {
    json = Json::parse(text, see);
  } catch (const Json::parse_error& error) {
    return Failure(Error{name, 0, "JSON", "a syntax error at byte " + std::to_string(error.byte)});
  } catch (const Json::exception&) {
    return Failure(Error{name, 0, "JSON", "a number beyond the range of a double"});
  }
  if (watch.deep()) {
    return Failure(Error{name, 0, "JSON of at most " + std::to_string(most_json_depth) + " levels",
                         "more levels"});
  }
  if (!watch.duplicate().empty()) {
    return Failure(Error{name, 0, "each key of a JSON object once", watch.duplicate()});
  }
  return json;
}

}  // namespace kinalign
