// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/verb.h"

#include "apps/cli/field_text.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace kinalign {

namespace {

// Copies the value of an option to the same option of another copy of the structure, so both have
// one type.
void copy_value(const Field& from, const Field& onto) {
  assert(from.value.index() == onto.value.index());
  std::visit(
      [&](auto* source) { *std::get<std::remove_const_t<decltype(source)>>(onto.value) = *source; },
      from.value);
}

}  // namespace

Result<void> check_out(const Common& common, std::initializer_list<std::string_view> endings,
                       std::string expected) {
  const std::string& out = common.out;
  const bool fits = std::any_of(endings.begin(), endings.end(),
                                [&](std::string_view ending) { return out.ends_with(ending); });
  if (fits || (endings.size() == 0 && !out.empty())) return {};
  return Failure(Error{"-o", 0, std::move(expected), out.empty() ? "none" : shown(out)});
}

Field text_flag(std::string name, std::string meaning, decltype(Field::value) value,
                std::string stands_for) {
  return {.name = std::move(name),
          .meaning = std::move(meaning),
          .value = value,
          .stands_for = std::move(stands_for)};
}

Field choice_flag(std::string name, std::string meaning, decltype(Field::value) value,
                  std::vector<std::string> choices) {
  return {.name = std::move(name),
          .meaning = std::move(meaning),
          .value = value,
          .choices = std::move(choices)};
}

std::string group_of(const std::string& verb_name) {
  const auto blank = verb_name.find(' ');
  return blank == std::string::npos ? "" : verb_name.substr(0, blank);
}

// Verbs that share their first word form a group.
std::vector<std::string> groups_of(const std::vector<Verb>& verbs) {
  std::vector<std::string> groups;
  for (const Verb& verb : verbs) {
    const std::string group = group_of(verb.page.name);
    if (group.empty() || std::find(groups.begin(), groups.end(), group) != groups.end()) continue;
    groups.push_back(group);
  }
  return groups;
}

std::vector<std::string> names_in(const std::string& group, const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    if (group_of(verb.page.name) == group) names.push_back(verb.page.name.substr(group.size() + 1));
  }
  return names;
}

// `fill` returns false here, so the verb is not run and `call` is never called.
void describe_verb(const Verb& verb, const std::function<void(const Usage&)>& use) {
  const auto look = [&](const Usage& usage) {
    use(usage);
    return false;
  };
  (void)verb.enter(look, [&]() -> Call { std::abort(); });
}

void copy_given(const Fields& from, const Fields& onto, const Sources& sources, Source least) {
  for (const Field& field : from) {
    const auto source = sources.find(field.name);
    // An option that no source has set must not overwrite the value from the manifest.
    if (source == sources.end() || source->second < least) continue;
    for (const Field& other : onto) {
      if (other.name == field.name) copy_value(field, other);
    }
  }
}

}  // namespace kinalign
