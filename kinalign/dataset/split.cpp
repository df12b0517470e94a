// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/split.h"

#include "kinalign/core/nearest_name.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view split_schema = "kinalign.split/1";

/// SplitMix64 (Steele, Lea, Flood 2014). It gives the same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t below(std::uint64_t end) {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    // The remainder makes small numbers slightly more likely, which does not matter for so few
    // units.
    return (z ^ (z >> 31U)) % end;
  }

 private:
  std::uint64_t state_;
};

/// Takes that must be in the same part: one take, or all takes of a person.
struct Unit {
  std::vector<const SplitTake*> takes;
  std::uint64_t frames = 0;
};

using Units = std::vector<Unit>;

/// Groups the takes into units.
Units units_of(const std::vector<const SplitTake*>& takes, bool by_subject) {
  std::map<std::string, Unit> units;
  for (const SplitTake* take : takes) {
    Unit& unit = units[by_subject ? take->name.subject : to_string(take->name)];
    unit.takes.push_back(take);
    unit.frames += take->summary.frames;
  }
  // The map sorts the units by name, so the order of the takes does not matter.
  Units out;
  for (auto& [key, unit] : units) out.push_back(std::move(unit));
  return out;
}

/// Shuffles the units (Fisher and Yates): each order is equally likely.
void shuffle(Units& units, Random& random) {
  for (std::size_t i = units.size(); i > 1; --i) std::swap(units[i - 1], units[random.below(i)]);
}

/// Moves units from the end of `from` to `to`, until they have about that number of frames.
void move_share(Units& from, std::uint64_t frames, std::vector<TakeName>& to) {
  std::uint64_t moved = 0;
  // A unit is moved if more than half of it fits. The error is then at most half a unit.
  while (!from.empty() && moved + from.back().frames / 2 < frames) {
    moved += from.back().frames;
    for (const SplitTake* take : from.back().takes) to.push_back(take->name);
    from.pop_back();
  }
}

/// Divides the units at random into the parts.
void divide(Units units, const SplitOptions& options, Random& random,
            std::vector<SplitPart>& parts) {
  std::uint64_t frames = 0;
  for (const Unit& unit : units) frames += unit.frames;
  // The units are in the order of their names, so the result depends only on the seed.
  shuffle(units, random);
  const auto share = [frames](double of) {
    return static_cast<std::uint64_t>(of * static_cast<double>(frames));
  };
  // The test part is drawn first, so it stays the same if only the share of the validation changes.
  move_share(units, share(options.test), parts[2].takes);
  move_share(units, share(options.validation), parts[1].takes);
  for (const Unit& unit : units) {
    for (const SplitTake* take : unit.takes) parts[0].takes.push_back(take->name);
  }
}

/// The class of a take's action; empty if dataset.toml lacks the action.
std::string class_of(const SplitTake& take, const Catalogue& catalogue) {
  const Action* action = find_action(catalogue, take.name.action);
  return action == nullptr ? "" : action->class_id;
}

using Wanted = std::function<bool(const SplitTake&)>;

/// The takes that a method uses.
std::vector<const SplitTake*> chosen(const std::vector<SplitTake>& takes, const Wanted& wanted) {
  std::vector<const SplitTake*> out;
  for (const SplitTake& take : takes) {
    if (wanted(take)) out.push_back(&take);
  }
  return out;
}

/// Divides the takes at random. If `stratified`, each class is divided separately.
std::vector<SplitPart> random_parts(const std::vector<const SplitTake*>& takes,
                                    const Catalogue& catalogue, const SplitOptions& options,
                                    bool by_subject) {
  // divide() expects the parts in this order.
  std::vector<SplitPart> parts{{"train", {}}, {"validation", {}}, {"test", {}}};
  Random random(static_cast<std::uint64_t>(options.seed));
  std::map<std::string, std::vector<const SplitTake*>> strata;
  for (const SplitTake* take : takes) {
    // A person does actions of many classes, so people are not divided by class.
    const bool apart = options.stratified && !by_subject;
    strata[apart ? class_of(*take, catalogue) : ""].push_back(take);
  }
  for (const auto& [key, of_class] : strata) {
    divide(units_of(of_class, by_subject), options, random, parts);
  }
  // A share of 0 gives an empty part, which make_split() would refuse.
  if (options.validation == 0.0) parts.erase(parts.begin() + 1);
  return parts;
}

/// A part for each person, with all takes of the person.
std::vector<SplitPart> a_part_each(const std::vector<SplitTake>& takes) {
  std::map<std::string, SplitPart> parts;
  for (const SplitTake& take : takes) {
    SplitPart& part = parts[take.name.subject];
    part.name = take.name.subject;
    part.takes.push_back(take.name);
  }
  std::vector<SplitPart> out;
  out.reserve(parts.size());
  for (auto& [id, part] : parts) out.push_back(std::move(part));
  return out;
}

/// The named people are the test part, all others the training part.
Result<std::vector<SplitPart>> parts_of_people(const std::vector<SplitTake>& takes,
                                               const std::vector<std::string>& test_people) {
  // An unknown person is an error, because the test part would be smaller than the user thinks.
  const std::set<std::string> tested(test_people.begin(), test_people.end());
  std::vector<SplitPart> parts{{"train", {}}, {"test", {}}};
  std::set<std::string> known;
  for (const SplitTake& take : takes) {
    known.insert(take.name.subject);
    parts[tested.contains(take.name.subject) ? 1 : 0].takes.push_back(take.name);
  }
  for (const std::string& id : test_people) {
    if (known.contains(id)) continue;
    return Failure(unknown_name(id, "a subject that has takes", {known.begin(), known.end()}));
  }
  return parts;
}

/// Divides by the classes of section 4.2 of the HFUT-MMD paper. Takes without nodes are in no part.
std::vector<SplitPart> imu_parts(const std::vector<SplitTake>& takes, const Catalogue& catalogue) {
  std::vector<SplitPart> parts{{"train", {}}, {"test", {}}};
  for (const SplitTake& take : takes) {
    if (!take.summary.has(Modality::imu)) continue;
    const std::string of = class_of(take, catalogue);
    parts[of == "S2" || of == "S3" || of == "S5" ? 0 : 1].takes.push_back(take.name);
  }
  return parts;
}

/// True for a take of the people in section 4.1 of the HFUT-MMD paper: men of 175 cm.
bool is_man_of_175(const SplitTake& take, const Catalogue& catalogue) {
  const Subject* subject = find_subject(catalogue, take.name.subject);
  return subject != nullptr && subject->sex == "m" && subject->height_cm == 175.0;
}

using TakesByName = std::map<TakeName, const SplitTake*>;

/// The takes by name. The pointers point into `takes`.
TakesByName by_name(const std::vector<SplitTake>& takes) {
  TakesByName out;
  for (const SplitTake& take : takes) out.emplace(take.name, &take);
  return out;
}

/// The parts in which a take, a person or a file occurs.
using Places = std::map<std::string, std::set<std::string>>;

/// The facts about the parts that check_split() needs, collected in one pass.
struct Seen {
  Places names, subjects;
  /// By the SHA-256 of a take or of a raw file: for each part, a take with that content.
  std::map<std::string, std::map<std::string, std::string>> contents;
  std::set<std::string> unknown;  // takes that the data set lacks
  std::set<std::string> changed;  // takes with other bytes when the split was made
};

/// Notes in which parts each take, person and content occurs.
Seen seen_in(const Split& split, const TakesByName& known) {
  Seen seen;
  for (const SplitPart& part : split.parts) {
    for (const TakeName& name : part.takes) {
      const auto found = known.find(name);
      if (found == known.end()) {
        seen.unknown.insert(to_string(name));
        continue;
      }
      seen.names[to_string(name)].insert(part.name);
      seen.subjects[name.subject].insert(part.name);
      const TakeSummary& summary = found->second->summary;
      // The same bytes under two names in two parts are also an error.
      seen.contents[summary.sha256].emplace(part.name, to_string(name));
      for (const InputFacts& input : summary.inputs) {
        // Files without samples, such as a layout or a list of channels, may be the same for all
        // takes.
        if (!summary.sample_files.contains(input.name)) continue;
        seen.contents[input.sha256].emplace(part.name, to_string(name));
      }
      // The hash of the take at the time when the split was made.
      const auto then = split.sha256.find(name);
      // Without such a hash, a change of the take can't be noticed.
      if (then != split.sha256.end() && then->second != summary.sha256) {
        seen.changed.insert(to_string(name));
      }
    }
  }
  return seen;
}

/// The names of parts as text: "test and train".
std::string listed(const std::set<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, " and "));
}

}  // namespace

std::vector<std::string> split_methods() {
  return {"subject", "take", "leave-one-out", "hfut-denoise", "hfut-imu"};
}

Result<Split> make_split(const std::vector<SplitTake>& takes, const Catalogue& catalogue,
                         const SplitOptions& options) {
  Split out{options, {}, {}};
  if (!options.test_people.empty()) {
    out.parts = KA_TRY(parts_of_people(takes, options.test_people));
  } else if (options.by == "leave-one-out") {
    out.parts = a_part_each(takes);
  } else if (options.by == "hfut-imu") {
    out.parts = imu_parts(takes, catalogue);
  } else {
    const bool denoise = options.by == "hfut-denoise";
    const auto wanted = [&](const SplitTake& take) {
      return !denoise || (is_man_of_175(take, catalogue) && take.summary.has(Modality::kinect));
    };
    out.parts = random_parts(chosen(takes, wanted), catalogue, options, options.by == "subject");
  }
  for (SplitPart& part : out.parts) {
    // The takes are sorted, so that the file of a split does not depend on their order.
    std::sort(part.takes.begin(), part.takes.end());
    if (!part.takes.empty()) continue;
    return Failure(Error{
        "", 0,
        "takes for the part " + part.name + " (a larger --test or --validation, or --by take)",
        "no take (of " + std::to_string(takes.size()) + " takes in all)"});
  }
  if (out.parts.size() < 2)
    return Failure(Error{"", 0, "takes of at least two people", "takes of fewer people"});
  return out;
}

Findings check_split(const Split& split, const std::vector<SplitTake>& takes,
                     const std::string& file) {
  Findings out;
  const auto report = [&](Severity severity, std::string expected, std::string found) {
    out.push_back({severity, Error{file, 0, std::move(expected), std::move(found)}, "", ""});
  };
  const Seen seen = seen_in(split, by_name(takes));
  for (const auto& [name, parts] : seen.names) {
    if (parts.size() > 1)
      report(Severity::error, "each take in one part", name + " in " + listed(parts));
  }
  for (const auto& [hash, parts] : seen.contents) {
    if (parts.size() < 2) continue;
    // The message names two parts as an example.
    const auto& [one, take] = *parts.begin();
    const auto& [other, second] = *parts.rbegin();
    report(Severity::error, "the same bytes in one part only",
           fmt::format("{} in {} and {} in {} (SHA-256 {}...)", take, one, second, other,
                       hash.substr(0, 12)));
  }
  // Only these methods divide people. With other methods a person may be in two parts.
  const bool apart = split.options.by == "subject" || split.options.by == "leave-one-out";
  for (const auto& [subject, parts] : seen.subjects) {
    if (parts.size() < 2) continue;
    report(apart ? Severity::error : Severity::note, "each person in one part",
           "subject " + subject + " in " + listed(parts));
  }
  for (const std::string& name : seen.unknown)
    report(Severity::error, "takes of the data set", name);
  if (!seen.changed.empty()) {
    report(Severity::warning, "takes that did not change since the split was made",
           fmt::format("{} made again: {}{}", seen.changed.size(), *seen.changed.begin(),
                       seen.changed.size() > 1 ? ", ..." : ""));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return out;
}

std::string split_json(const Split& split, const std::vector<SplitTake>& takes) {
  const SplitOptions& o = split.options;
  const TakesByName known = by_name(takes);
  Json out = {{"schema", split_schema}, {"by", o.by}};
  // If test people are named, the file has their names and no share of the test part.
  if (o.test_people.empty()) {
    out["test"] = o.test;
  } else {
    out["test_people"] = o.test_people;
  }
  out.update({{"validation", o.validation},
              {"seed", o.seed},
              {"stratified", o.stratified},
              {"parts", Json::array()}});
  for (const SplitPart& part : split.parts) {
    Json one = {{"name", part.name}, {"takes", Json::array()}};
    for (const TakeName& name : part.takes) {
      const auto take = known.find(name);
      one["takes"].push_back({{"name", to_string(name)},
                              {"sha256", take == known.end() ? "" : take->second->summary.sha256}});
    }
    out["parts"].push_back(std::move(one));
  }
  return out.dump(1) + "\n";
}

/// Reads a split. It has either "test_people" or the share of the test part.
Result<Split> parse_split_json(std::string_view json, const std::string& file) {
  const auto wrong = [&](const std::string& found) {
    return Failure(Error{file, 0, "a split (" + std::string(split_schema) + ")", shown(found)});
  };
  try {
    const Json parsed = Json::parse(json);
    if (parsed.at("schema").get<std::string>() != split_schema)
      return wrong(parsed["schema"].get<std::string>());
    Split out;
    // A split by named people has no share of the test part.
    const bool has_people = parsed.contains("test_people");
    out.options = {parsed.at("by").get<std::string>(),
                   has_people ? 0.0 : parsed.at("test").get<double>(),
                   parsed.at("validation").get<double>(),
                   parsed.at("seed").get<std::int64_t>(),
                   parsed.at("stratified").get<bool>(),
                   parsed.value("test_people", std::vector<std::string>())};
    for (const Json& part : parsed.at("parts")) {
      SplitPart& made = out.parts.emplace_back();
      made.name = part.at("name").get<std::string>();
      for (const Json& take : part.at("takes")) {
        const auto name = parse_take_name(take.at("name").get<std::string>());
        if (!name) return wrong(take["name"].get<std::string>());
        made.takes.push_back(*name);
        const auto hash = take.value("sha256", std::string());
        if (!hash.empty()) out.sha256[*name] = hash;
      }
    }
    return out;
  } catch (const Json::exception& fault) {
    return wrong(fault.what());
  }
}

Result<Split> read_split(FileSystem& files, const std::string& path) {
  // The size is limited before the file is read.
  constexpr std::size_t longest = std::size_t{64} << 20;
  return parse_split_json(KA_TRY(read_whole(files, path, longest)), path);
}

Result<Split> read_good_split(FileSystem& files, const std::string& path,
                              const std::vector<SplitTake>& takes) {
  Split split = KA_TRY(read_split(files, path));
  // check_split() returns the most severe findings first.
  for (const Finding& one : check_split(split, takes, path)) {
    if (one.severity == Severity::error) return Failure(one.what);
  }
  return split;
}

}  // namespace kinalign
