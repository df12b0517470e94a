// SPDX-License-Identifier: Apache-2.0
// The common part of the readers of text tables: it splits lines, stamps rows, and keeps rows until
// their stamps are final.
#pragma once

#include "kinalign/formats/held_rows.h"
#include "kinalign/formats/named_lines.h"
#include "kinalign/formats/reader.h"
#include "kinalign/formats/row_stamps.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace kinalign {

/// Base is PointReader or ImuReader. A derived class reads one line at a time, and sets header_
/// before the first row.
template <class Base>
class LineReader : public Base {
 public:
  using Header = typename Base::Header;
  using Frames = typename Base::Frames;

  /// `head`: a description of the header, for the error about a file without it.
  LineReader(std::string_view file, std::string head, RowStamps stamps)
      : lines_(file), stamps_(std::move(stamps)), head_(std::move(head)) {}

  Result<void> feed(std::string_view piece, Frames& out) final {
    return lines_.feed(piece, [&](std::string_view line) { return read(line, out); });
  }

  Result<void> finish(Frames& out) final {
    const auto use = [&](std::string_view line) { return read(line, out); };
    KA_TRY(header_ ? lines_.finish(use, this->findings) : lines_.finish_head(use, this->findings));
    if (!header_) return Failure(lines_.error(head_, "the end of the file"));
    // At the end of the file the stamps become final, and all kept rows are passed on.
    stamps_.settle();
    this->counted = stamps_.counted();
    held_.release(stamps_, out);
    if (stamps_.stuck()) this->findings.push_back(stuck_finding(lines_.file(), stamps_));
    return report();
  }

  const Header* header() const final { return header_ ? &*header_ : nullptr; }

 protected:
  virtual Result<void> read(std::string_view line, Frames& out) = 0;
  /// Adds findings. It is called at the end of the file.
  virtual Result<void> report() = 0;

  NamedLines lines_;
  RowStamps stamps_;
  HeldRows<Frames> held_;
  std::optional<Header> header_;

 private:
  std::string head_;
};

}  // namespace kinalign
