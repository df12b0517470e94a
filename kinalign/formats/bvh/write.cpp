// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bvh/write.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

constexpr std::array<std::string_view, 6> channel_words{"Xposition", "Yposition", "Zposition",
                                                        "Xrotation", "Yrotation", "Zrotation"};

void put(std::string& text, double value, int decimals) {
  std::array<char, number_room> room{};
  const char* end = put_number(room.data(), value, std::min(decimals, 15));
  text.append(room.data(), static_cast<std::size_t>(end - room.data()));
}

void put_offset(std::string& text, const std::string& indent, const Vec3& offset, int decimals) {
  text += indent + "OFFSET";
  for (int i = 0; i < 3; ++i) {
    text += ' ';
    put(text, offset[i], decimals);
  }
  text += '\n';
}

/// Joint `first` and all below it, without recursion: a chain may be deep.
class HierarchyText {
 public:
  explicit HierarchyText(const BvhHierarchy& h) : h_(h) {}

  std::string text() {
    text_ = "HIERARCHY\n";
    for (std::size_t j = 0; j < h_.names.size(); ++j) {
      close_down_to(h_.parents[j]);
      open(j);
    }
    close_down_to(-1);
    return std::move(text_);
  }

 private:
  std::string indent() const { return std::string(open_.size(), '\t'); }

  void open(std::size_t j) {
    text_ += indent() + (h_.parents[j] < 0 ? "ROOT " : "JOINT ") + h_.names[j] + "\n";
    text_ += indent() + "{\n";
    open_.push_back(static_cast<int>(j));
    put_offset(text_, indent(), h_.offsets[j], h_.offset_decimals);
    if (h_.channels[j].empty()) return;
    text_ += indent() + fmt::format("CHANNELS {}", h_.channels[j].size());
    for (const Channel channel : h_.channels[j])
      text_ += fmt::format(" {}", channel_words[channel]);
    text_ += '\n';
  }

  void close_down_to(int parent) {
    while (!open_.empty() && open_.back() != parent) {
      for (const EndSite& site : h_.end_sites) {
        if (site.parent != open_.back()) continue;
        text_ += indent() + "End Site\n" + indent() + "{\n";
        put_offset(text_, indent() + "\t", site.offset, h_.offset_decimals);
        text_ += indent() + "}\n";
      }
      open_.pop_back();
      text_ += indent() + "}\n";
    }
  }

  const BvhHierarchy& h_;
  std::string text_;
  std::vector<int> open_;
};

}  // namespace

BvhWriter::BvhWriter(const BvhHierarchy& hierarchy, std::uint64_t frames, int decimals,
                     TextSink sink)
    : sink_(std::move(sink)),
      row_size_(hierarchy.row_size()),
      decimals_(decimals),
      frames_(frames),
      text_(HierarchyText(hierarchy).text() +
            fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", frames, hierarchy.frame_time)) {}

Result<void> BvhWriter::append(std::span<const double> values) {
  constexpr std::size_t piece = std::size_t{256} << 10;
  for (std::size_t i = 0; i + row_size_ <= values.size() && row_size_ > 0; i += row_size_) {
    for (std::size_t c = 0; c < row_size_; ++c) {
      if (c > 0) text_ += ' ';
      put(text_, values[i + c], decimals_);
    }
    text_ += '\n';
    ++written_;
    if (text_.size() < piece) continue;
    KA_TRY(sink_(text_));
    text_.clear();
  }
  return {};
}

Result<void> BvhWriter::finish() {
  if (written_ == frames_) return sink_(text_);
  return Failure(
      Error{"", 0, fmt::format("{} frames to write", frames_), std::to_string(written_)});
}

Result<void> write_bvh(const BvhFile& file, const TextSink& sink) {
  const std::size_t row_size = file.hierarchy.row_size();
  BvhWriter writer(file.hierarchy, row_size == 0 ? 0 : file.values.size() / row_size, file.decimals,
                   sink);
  KA_TRY(writer.append(file.values));
  return writer.finish();
}

}  // namespace kinalign
