// SPDX-License-Identifier: Apache-2.0
// Makes the man page kinalign(1) with the man macros of roff (groff_man(7)).
#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"
#include "apps/cli/help.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// The text with the special characters of roff escaped.
std::string literal(std::string_view text) {
  std::string out;
  // A line that begins with a dot or an apostrophe would be a command for roff.
  if (text.starts_with('.') || text.starts_with('\'')) out += "\\&";
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      // roff may print a plain "-" as a typographic hyphen, which does not work when copied into a
      // shell.
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

/// A flag or an exit code, with its meaning indented below it.
std::string item(std::string_view head, std::string_view text) {
  return fmt::format(".TP\n.B {}\n{}\n", literal(head), literal(text));
}

std::string items(const Fields& fields) {
  std::string text;
  for (const Field& field : fields) {
    const FlagText flag = flag_text(field);
    text += item(flag.flag, flag.meaning);
  }
  return text;
}

/// The section of one verb. The flags that all verbs share are left out, because they have their
/// own section.
std::string verb_section(const Page& page, const Usage& usage) {
  std::string text =
      fmt::format(".SS \"{}\"\n{}\n", literal(usage_line(page, usage)), literal(page.summary));
  if (!page.text.empty()) text += fmt::format(".PP\n{}\n", literal(page.text));
  for (const Example& example : page.examples) {
    text += fmt::format(".PP\n{}:\n.PP\n.RS\n.EX\n{}\n.EE\n.RE\n", literal(example.meaning),
                        literal(example.command));
  }
  for (const Positional& place : usage.positionals) text += item(place.name, place.meaning);
  Common common;
  const Page bare{page.name, "", "", {}, {}};
  Fields own = common_fields(common, page);
  // common_fields() returns the flags that this verb chose first, then the flags of all verbs.
  own.resize(own.size() - common_fields(common, bare).size());
  return text + items(usage.flags) + items(usage.settings) + items(own);
}

}  // namespace

std::string man_page(const std::vector<Verb>& verbs) {
  std::string text = fmt::format(
      ".TH KINALIGN 1 \"\" \"kinalign {}\" \"User Commands\"\n.SH NAME\n"
      "kinalign \\- align motion capture, Kinect v2 and IMU recordings\n"
      ".SH SYNOPSIS\n.B kinalign\n.I VERB\n[\\fIFLAGS\\fR]\n.SH VERBS\n",
      program_version());
  for (const Verb& verb : verbs) {
    describe_verb(verb, [&](const Usage& usage) { text += verb_section(verb.page, usage); });
  }
  Common common;
  text += ".SH FLAGS OF EVERY VERB\n" + items(common_fields(common, Page{}));
  text += item("-h, --help", "help for the verb");
  text +=
      ".SH SETTINGS\nThe first of these places that sets an option decides: a flag; "
      "KINALIGN_<NAME> in the environment;\nthe manifest; the nearest kinalign.toml in the current "
      "folder or above it;\n.I ~/.config/kinalign/config.toml.\n.B kinalign config\nprints all "
      "settings in use and where each comes from.\n"
      ".SH EXIT STATUS\n";
  text += item("0", "done") +
          item("1", "done, with warnings or errors found; rebuild: the bytes differ") +
          item("2", "wrong use");
  text +=
      item("3", "input or output") + item("130", "stopped by Ctrl-C; no unfinished file is left");
  return text;
}

}  // namespace kinalign
