// SPDX-License-Identifier: Apache-2.0
// A live stream is read alike, however it is cut into pieces.
#include "kinalign/recording/live/live_stream.h"

#include <algorithm>
#include <cstdlib>
#include <string>

using namespace kinalign;

namespace {

struct Heard {
  std::size_t samples = 0, rows = 0, marks = 0;
  bool fails = false, closed = false;

  bool operator==(const Heard&) const = default;
};

Heard heard(std::string_view bytes, std::size_t piece) {
  LiveStream stream;
  LiveData news;
  Heard out;
  for (; !bytes.empty() && !out.fails; bytes.remove_prefix(std::min(piece, bytes.size()))) {
    out.fails = !stream.take(bytes.substr(0, piece), news);
  }
  if (!out.fails) stream.end();
  out.samples = news.samples.size();
  out.rows = news.rows.size();
  out.marks = news.marks.size();
  out.closed = !out.fails && stream.closed();
  for (const LiveNodeSample& one : news.samples) {
    if (one.stamp > one.arrival + std::chrono::seconds(1)) std::abort();
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const Heard whole = heard(bytes, std::max<std::size_t>(size, 1));
  const Heard cut = heard(bytes, 3);
  // If a stream fails, the data before the damage may or may not have been passed on.
  if (whole.fails != cut.fails || (!whole.fails && !(whole == cut))) std::abort();
  return 0;
}
