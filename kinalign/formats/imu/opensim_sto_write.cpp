// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/axes.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/imu/opensim_sto.h"
#include "kinalign/formats/row_stamps.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

constexpr int decimals = 9;

}  // namespace

OpensimStoWriter::OpensimStoWriter(std::size_t nodes, Time zero, TextOut& out)
    : out_(&out), nodes_(nodes), zero_(zero), z_up_from_ours_(rotation_of(z_up).conjugate()) {}

Result<OpensimStoWriter> OpensimStoWriter::begin(const OpensimStoHead& head, TextOut& out) {
  if (!head.content.orientation)
    return refuse("orientations for a .sto", "nodes without orientations");
  if (head.names.empty()) return refuse("at least one node for a .sto", "none");
  for (const std::string& name : head.names) {
    // A tab in a name would shift the columns.
    if (!fits_a_cell(name)) return refuse("names of nodes for a .sto without tabs", shown(name));
  }
  if (!(head.rate_hz > 0.0)) return refuse("a rate for a .sto", fmt::format("{}", head.rate_hz));
  out.text(
      fmt::format("DataRate={:.6f}\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.1\n"
                  "endheader\ntime",
                  head.rate_hz));
  for (const std::string& name : head.names) out.text("\t" + name);
  KA_TRY(out.end_line());
  return OpensimStoWriter(head.names.size(), head.zero, out);
}

Result<void> OpensimStoWriter::append(const ImuSamples& samples) {
  for (std::size_t t = 0; t < samples.size(); ++t) {
    // Times count from `zero`, because times in OpenSim have no date.
    out_->text(seconds_text((samples.stamps[t] - zero_).count()));
    for (std::size_t i = t * nodes_; i < (t + 1) * nodes_; ++i) {
      // Four nan keep the number of cells, so the cells of other nodes stay in their columns.
      if (samples.valid[i] == 0) {
        out_->text("\tnan,nan,nan,nan");
        continue;
      }
      const Quat q = z_up_from_ours_ * quat(samples.orientation, i);
      out_->number('\t', q.w(), decimals);
      out_->number(',', q.x(), decimals);
      out_->number(',', q.y(), decimals);
      out_->number(',', q.z(), decimals);
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

}  // namespace kinalign
