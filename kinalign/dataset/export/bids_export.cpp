// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/bids_export.h"

#include "kinalign/core/progress.h"
#include "kinalign/core/text_out.h"
#include "kinalign/formats/bids/check.h"
#include "kinalign/formats/bids/motion_write.h"
#include "kinalign/formats/bids/names.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace kinalign {

namespace {

/// 1990-01-01T00:00:00Z. Files without a date count their stamps from about 0, which would be 1970.
constexpr Time first_date = utc_time(631'152'000'000'000'000);

/// A stream's name without characters that a label can't have: "kinect_2" gives kinect2.
std::string label_of(const std::string& stream) {
  std::string out;
  for (const char c : stream) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) out += c;
  }
  return out.empty() ? "stream" : out;
}

/// The kind of a stream decides which columns its BIDS tracking system has.
BidsSource source_of(const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) return clip->skeleton;
  if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
    return PointHeader{points->joint_names};
  }
  const auto& nodes = std::get<ImuGroup>(group.kind);
  return ImuHeader{nodes.node_names, nodes.content};
}

/// A text about a device in dataset.toml; empty if the device or the text is missing.
std::string text_of(const Described* device, const char* key) {
  if (device == nullptr) return "";
  const auto found = device->texts.find(key);
  return found == device->texts.end() ? "" : found->second;
}

/// The facts about the device in dataset.toml whose id is the stream's name.
BidsSystemFacts facts_of(const Catalogue& catalogue, const ExportedTake& take,
                         const TakeGroup& group) {
  const Described* known = find_id(catalogue.devices, group.name);
  const Action* action = find_action(catalogue, take.name().action);
  BidsSystemFacts facts;
  facts.task_name = take.name().action;
  facts.task_description = action == nullptr ? "" : action->name;
  // The full name of the stream is kept here, because a BIDS label can't have all of its
  // characters.
  facts.system_name = group.name;
  facts.rate_hz = take.rate_hz();
  facts.manufacturer = text_of(known, "make");
  facts.model = text_of(known, "model");
  facts.software_versions = take_software();
  return facts;
}

/// An absent number gives an empty cell.
std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{:g}", *value) : "";
}

}  // namespace

/// Writes one file. The folder is new, so an existing file would be a mistake and is not replaced.
Result<void> BidsExport::write(const std::string& path, std::string_view text) {
  const std::string whole = folder_ + "/" + path;
  KA_TRY(make_folders(std::string(kinalign::folder(whole))));
  return write_whole(files_, whole, text, Overwrite::no);
}

/// Writes the rows of one stream and returns its sidecar files.
Result<BidsSidecars> BidsExport::write_motion(ExportedTake& take, std::size_t group,
                                              const std::string& path) {
  const TakeGroup& of = take.header().groups[group];
  KA_TRY(make_folders(std::string(kinalign::folder(path))));
  TextOut out = KA_TRY(TextOut::create(files_, path, Overwrite::no));
  BidsMotionWriter writer(source_of(of), out);
  const auto append = [&](const auto& rows) { return writer.append(rows); };
  // Exactly one of the three lines applies to the stream. Its rows are passed on slab by slab.
  if (std::holds_alternative<ClipGroup>(of.kind)) KA_TRY(take.clip_frames(group, append));
  if (std::holds_alternative<PointGroup>(of.kind)) KA_TRY(take.point_frames(group, append));
  if (std::holds_alternative<ImuGroup>(of.kind)) KA_TRY(take.node_samples(group, append));
  KA_TRY(out.commit());
  return writer.sidecars(facts_of(catalogue_, take, of));
}

/// Writes a stream as a tracking system with its sidecar files, and notes it for scans.tsv.
Result<void> BidsExport::add_system(ExportedTake& take, std::size_t group, FilesMade& made) {
  const BidsEntities entities{take.name().subject, take.name().action,
                              label_of(take.header().groups[group].name),
                              fmt::format("{}", take.name().run)};
  const std::string motion = bids_path(entities, "motion.tsv");
  const BidsSidecars sidecars = KA_TRY(write_motion(take, group, folder_ + "/" + motion));
  KA_TRY(write(bids_path(entities, "channels.tsv"), sidecars.channels_tsv));
  KA_TRY(write(bids_path(entities, "channels.json"), sidecars.channels_json));
  KA_TRY(write(bids_path(entities, "motion.json"), sidecars.motion_json));
  // scans.tsv names files by their paths below the subject's folder.
  const std::string below = bids_subject_folder(entities);
  // A date is left out if the set is released or if the stamps do not count from 1970.
  const bool is_dated = !released_ && sidecars.onset >= first_date;
  scans_[entities.subject].emplace_back(motion.substr(below.size()),
                                        is_dated ? std::optional(sidecars.onset) : std::nullopt);
  // Sidecar files are not counted, because the result lists one file for each stream.
  made.paths.push_back(folder_ + "/" + motion);
  return {};
}

Result<FilesMade> BidsExport::add(ExportedTake& take) {
  FilesMade made;
  for (std::size_t g = 0; g < take.header().groups.size(); ++g) {
    const auto done = add_system(take, g, made);
    // A stream that fails does not stop the others. A stop by the user stops all.
    if (!done && is_interruption(done.error())) return Failure(done.error());
    if (!done) made.failed.push_back(done.error());
  }
  return made;
}

/// The participants; a released data set has only their ids.
BidsParticipants BidsExport::participants() const {
  BidsParticipants out;
  if (!released_) {
    out.columns = {
        {"sex", "sex of the participant", "", {{"F", "female"}, {"M", "male"}, {"O", "other"}}},
        {"height", "body height", "cm", {}},
        {"weight", "body weight", "kg", {}},
        {"handedness",
         "handedness of the participant",
         "",
         {{"left", "left"}, {"right", "right"}, {"both", "ambidextrous"}}}};
  }
  // Only people with an exported take are listed.
  for (const auto& [id, scans] : scans_) {
    std::vector<std::string> cells;
    // If the set is released, it has no columns about the body.
    if (!released_) {
      const Subject* person = find_subject(catalogue_, id);
      const Subject known = person == nullptr ? Subject{} : *person;
      const std::string sex = known.sex == "f"   ? "F"
                              : known.sex == "m" ? "M"
                              : known.sex == "x" ? "O"
                                                 : "";
      cells = {sex, number_text(known.height_cm), number_text(known.weight_kg), known.handedness};
    }
    out.rows.emplace_back(id, std::move(cells));
  }
  return out;
}

Result<Findings> BidsExport::finish() {
  // The description states kinalign as the program that made the data set.
  BidsDataset description;
  description.name = catalogue_.name;
  description.license = catalogue_.licence;
  description.how_to_acknowledge = catalogue_.citation;
  // This text contains the program's name and its version.
  const std::string software = take_software();
  // BIDS wants the name and the version separately.
  description.generated_by = software.substr(0, software.find(' '));
  description.generated_by_version = software.substr(software.find(' ') + 1);
  KA_TRY(write("dataset_description.json", dataset_description_json(description)));
  KA_TRY(write("README", fmt::format("{}\n\n{}\n\nAligned and exported by {}.\n", catalogue_.name,
                                     catalogue_.description, software)));
  const BidsParticipants people = participants();
  KA_TRY(write("participants.tsv", participants_tsv(people)));
  KA_TRY(write("participants.json", participants_json(people)));
  for (auto& [subject, scans] : scans_) {
    // Takes are added in the order of the job, and the file is sorted.
    std::sort(scans.begin(), scans.end());
    KA_TRY(write(bids_scans_path({subject, "", "", ""}), scans_tsv(scans)));
  }
  return check_bids(KA_TRY(list_bids_folder(files_, folder_)));
}

}  // namespace kinalign
