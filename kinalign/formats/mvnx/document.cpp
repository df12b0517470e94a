// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/mvnx/document.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/cells.h"

#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_things = 20'000;  // segments, points, sensors and joints in a head

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The numbers in a text, separated by blanks. The result is empty if the text contains anything
/// else.
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> out;
  // A copy is needed, because parse_number() reads the character after a number.
  const std::string ended(text);
  const char* at = ended.data();
  const char* end = at + ended.size();
  for (;;) {
    while (at < end && is_blank(*at)) ++at;
    if (at == end) return out;
    double value = 0.0;
    // After a wrong word, the positions of all further numbers are uncertain, so the array is not
    // used.
    at = parse_number(at, end, value);
    if (at == nullptr || !(std::abs(value) < largest_number)) return {};
    out.push_back(value);
  }
}

std::optional<double> number_of(std::optional<std::string_view> text) {
  double value = 0.0;
  if (!text || !parse_number(trimmed(*text), value)) return std::nullopt;
  return value;
}

/// Splits "Pelvis/jL5S1" into the names of a segment and a point. Text without a slash names a
/// segment only.
std::pair<std::string, std::string> place_of(std::string_view text) {
  text = trimmed(text);
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return {std::string(text), ""};
  return {std::string(text.substr(0, slash)), std::string(text.substr(slash + 1))};
}

/// The elements of a frame that are read, and their arrays. Other elements are skipped.
struct Quantity {
  std::string_view name;
  std::vector<double> MvnxFrame::*array;
};

constexpr std::array<Quantity, 6> quantities{
    {{"orientation", &MvnxFrame::orientation},
     {"position", &MvnxFrame::position},
     {"sensorOrientation", &MvnxFrame::sensor_orientation},
     {"sensorAcceleration", &MvnxFrame::sensor_acceleration},
     {"sensorFreeAcceleration", &MvnxFrame::sensor_free_acceleration},
     {"sensorAngularVelocity", &MvnxFrame::sensor_angular_velocity}}};

}  // namespace

MvnxDocument::MvnxDocument(std::string_view file, UseFrame use)
    : file_(file), use_(std::move(use)), xml_(std::string(file)) {}

Result<void> MvnxDocument::feed(std::string_view piece) {
  if (piece.empty()) return {};
  // A gzip file begins with 0x1f, which no XML file does.
  if (!begun_) {
    begun_ = true;
    // The first byte decides, because the second one may arrive in the next piece.
    if (piece.front() == '\x1f') gunzip_.emplace();
  }
  if (!gunzip_) return xml_.feed(piece, *this);
  // Errors about XML already contain the file's name. Errors about gzip do not.
  auto fed = gunzip_->feed(piece, [this](std::string_view text) { return xml_.feed(text, *this); });
  if (!fed && fed.error().file.empty()) fed.error().file = file_;
  return fed;
}

Result<void> MvnxDocument::finish(Findings& findings) {
  // All subjects are counted first, so the finding is made at the end.
  if (subjects_ > 1) {
    add_warning(findings, {file_, 0, "one subject", std::to_string(subjects_)},
                "the first one was read", "export a file for each subject");
  }
  Result<void> ended = xml_.finish(*this);
  // Expat keeps an incomplete token, so other errors may appear only at the end.
  if (!ended && !xml_.ends_too_early()) return ended;
  // The XML may be complete although the checksum of the gzip file is missing.
  if (ended && gunzip_ && !gunzip_->complete()) {
    ended = refuse(file_, "a whole gzip archive", "the end of the file");
  }
  if (ended) return {};
  // A truncated file without a frame is an error.
  if (frames_ == 0) return ended;
  add_warning(findings, std::move(ended).error(), "the file was cut: the frames before were read");
  return {};
}

Result<void> MvnxDocument::begin(std::string_view name, const XmlAttributes& attributes) {
  // The document is another XML format if it begins with another element.
  if (!std::exchange(root_, true) && name != "mvnx") {
    return refuse("the element mvnx", shown(name));
  }
  subjects_ += name == "subject" ? 1 : 0;
  // Only the first subject is read.
  if (subjects_ != 1) return {};
  if (name == "frame") {
    begin_frame(attributes);
    return {};
  }
  // Within a frame, elements are handled at their end, when their text is known.
  return in_frame_ ? Result<void>{} : begin_in_head(name, attributes);
}

/// Adds an element of the head. The number of elements is limited.
Result<void> MvnxDocument::begin_in_head(std::string_view name, const XmlAttributes& attributes) {
  const std::string label(attributes.find("label").value_or(""));
  if (name == "subject") head_.rate_hz = number_of(attributes.find("frameRate")).value_or(0.0);
  if (name == "segment") head_.segments.push_back({label, {}});
  if (name == "sensor") head_.sensors.push_back(label);
  if (name == "joint") head_.joints.emplace_back();
  // A point belongs to the last segment.
  if (name == "point" && !head_.segments.empty()) {
    head_.segments.back().points.push_back({label, Vec3::Zero()});
  }
  // The head stays in memory, so the number of its elements is limited.
  if (++things_ <= most_things) return {};
  return refuse("at most 20,000 elements before the first frame", "more");
}

void MvnxDocument::begin_frame(const XmlAttributes& attributes) {
  in_frame_ = true;
  // Arrays that this frame does not have must not keep the values of the previous frame.
  frame_ = {};
  frame_.type = attributes.find("type").value_or("normal");
  frame_.index = number_of(attributes.find("index"));
  frame_.ms = number_of(attributes.find("time"));
  frame_.unix_ms = number_of(attributes.find("ms"));
  // The line of the frame is kept for errors that use_() returns.
  line_ = xml_.line();
}

Result<void> MvnxDocument::end(std::string_view name, std::string_view text) {
  if (subjects_ != 1) return {};
  if (!in_frame_) return end_in_head(name, text);
  if (name != "frame") {
    end_in_frame(name, text);
    return {};
  }
  in_frame_ = false;
  // A frame is counted when it is complete.
  ++frames_;
  auto used = use_(head_, frame_);
  // The receiver of the frame does not know the line, so file and line are added here.
  if (!used && used.error().file.empty()) {
    used.error().file = file_;
    used.error().line = line_;
  }
  return used;
}

/// Handles the text of an element in the head: a point's position or one end of a joint. pos_b is
/// the position of the last point.
Result<void> MvnxDocument::end_in_head(std::string_view name, std::string_view text) {
  if (name == "pos_b" && !head_.segments.empty() && !head_.segments.back().points.empty()) {
    const auto numbers = numbers_of(text);
    if (numbers.size() != 3) {
      return refuse("three numbers in pos_b", shown(trimmed(text)));
    }
    head_.segments.back().points.back().place = Vec3(numbers[0], numbers[1], numbers[2]);
  }
  // Both connectors stand inside the element of their joint.
  if (head_.joints.empty()) return {};
  MvnxJoint& joint = head_.joints.back();
  if (name == "connector1") std::tie(joint.parent, joint.parent_point) = place_of(text);
  if (name == "connector2") std::tie(joint.child, joint.child_point) = place_of(text);
  return {};
}

void MvnxDocument::end_in_frame(std::string_view name, std::string_view text) {
  for (const Quantity& quantity : quantities) {
    if (quantity.name == name) frame_.*quantity.array = numbers_of(text);
  }
}

}  // namespace kinalign
