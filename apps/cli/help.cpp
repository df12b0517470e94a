// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/help.h"

#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t meaning_column = 28;  // the column in which the meanings of flags begin

/// A name and its meaning in two columns. After a long name the meaning begins on the next line.
std::string line_of(const std::string& left, const std::string& meaning) {
  std::string line = "  " + left;
  if (line.size() + 2 > meaning_column) {
    line += "\n" + std::string(meaning_column, ' ');
  } else {
    line.resize(meaning_column, ' ');
  }
  return line + wrapped(meaning, meaning_column) + "\n";
}

/// One part of a help page: its heading and its flags. Empty if there are no flags.
std::string lines_of(const Fields& fields, const std::string& head) {
  if (fields.empty()) return "";
  std::string text = "\n" + head + "\n";
  for (const Field& field : fields) {
    const FlagText flag = flag_text(field);
    text += line_of(flag.flag, flag.meaning);
  }
  return text;
}

}  // namespace

// A word that is longer than a line stays whole.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string out;
  std::size_t at = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (at > indent && at + 1 + word.size() > width) {
      out += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (at > indent) {
      out += " ";
      ++at;
    }
    out += word;
    at += word.size();
  }
  return out;
}

std::string program_version() { return KINALIGN_VERSION; }

/// The flag as a help page lists it. The default follows in brackets unless the meaning already
/// states it.
FlagText flag_text(const Field& field) {
  FlagText text{flag_of(field.name), field.meaning};
  // The parser in command_line.cpp accepts these letters.
  if (field.name == "out") text.flag = "-o, --out";
  if (field.name == "quiet") text.flag = "-q, --quiet";
  if (field.name == "verbose") text.flag = "-v, --verbose";
  const std::string value = placeholder(field);
  if (!value.empty()) text.flag += " " + value;
  const std::string standard = field_text(field);
  const bool is_stated = field.meaning.find("default") != std::string::npos;
  if (!is_switch(field) && !standard.empty() && !is_stated) text.meaning += " [" + standard + "]";
  return text;
}

std::string usage_line(const Page& page, const Usage& usage) {
  std::string line = "kinalign " + page.name;
  for (const Positional& place : usage.positionals) {
    const bool many = place.most > 1;
    const std::string word = place.name + (many ? "..." : "");
    line += place.least == 0 ? " [" + word + "]" : " " + word;
  }
  return line + " [FLAGS]";
}

std::string group_page(const std::string& group, const std::vector<Verb>& verbs) {
  std::string text = fmt::format("usage  kinalign {} VERB ...\n\nverbs\n", group);
  for (const Verb& verb : verbs) {
    if (group_of(verb.page.name) == group) text += line_of(verb.page.name, verb.page.summary);
  }
  return text + "\n" +
         line_of(fmt::format("kinalign {} VERB --help", group), "help for a verb, with examples");
}

// The page begins with a command that works, before any explanation.
std::string overview(const std::vector<Verb>& verbs) {
  std::string text = "  kinalign align demo/recording.toml -o demo/mine.h5\n";
  const bool aligns = std::any_of(verbs.begin(), verbs.end(),
                                  [](const Verb& verb) { return verb.page.name == "align"; });
  // Tests make programs without the verb `align`, so those pages need another example.
  if (!aligns) text = "  kinalign config\n";
  text += "\nAligns motion capture, Kinect v2 and IMU recordings.\n\nverbs\n";
  std::string listed;  // the group of the previous verb
  for (const Verb& verb : verbs) {
    const std::string group = group_of(verb.page.name);
    if (group.empty()) text += line_of(verb.page.name, verb.page.summary);
    if (!group.empty() && group != listed) {
      text += line_of(group + " ...",
                      fmt::format("a group of verbs: {}", fmt::join(names_in(group, verbs), ", ")));
    }
    listed = group;
  }
  text += "\n";
  text += line_of("kinalign VERB --help", "help for a verb, with examples");
  text += line_of("kinalign --version", "the version");
  text +=
      "\nexit code  0 done, 1 findings, 2 wrong use, 3 input or output, 130 stopped by Ctrl-C\n";
  return text;
}

std::string help_page(const Page& page, const Usage& usage) {
  std::string text;
  // Examples stand first: most people want a command to copy.
  for (const Example& example : page.examples) {
    text += fmt::format("  {}\n      {}\n", example.command, wrapped(example.meaning, 6));
  }
  text += fmt::format("\n{}: {}\n", page.name, wrapped(page.summary, 0));
  if (!page.text.empty()) text += fmt::format("{}\n", wrapped(page.text, 0));
  text += fmt::format("\nusage  {}\n", usage_line(page, usage));
  for (const Positional& place : usage.positionals) {
    const std::string choices = place.choices.empty() ? "" : ": " + any_of(place.choices);
    text += line_of(place.name, place.meaning + choices);
  }
  text += lines_of(usage.flags, "flags");
  text += lines_of(
      usage.settings,
      fmt::format("settings (also KINALIGN_<NAME>, and [{}] in kinalign.toml)", page.name));
  Common common;
  return text + lines_of(common_fields(common, page), "flags of all verbs");
}

}  // namespace kinalign
