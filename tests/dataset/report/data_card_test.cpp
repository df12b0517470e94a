// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/data_card.h"

#include "tests/dataset/report/summarised_set.h"

using namespace kinalign;

namespace {

class CardSet : public SummarisedSet {
 public:
  CardSet() {
    put({"01", "A", 1}, summary(0, 1, 0.02));
    folder.write("splits/people.json", "{}");
  }
  Result<std::string> card() {
    const DatasetIndex index = open();
    return data_card(files, index, folder.path(), folder / "README.md", "kinalign 0.1.0");
  }
};

bool has(const std::string& text, std::string_view what) {
  return text.find(what) != std::string::npos;
}

}  // namespace

TEST_CASE("the card describes the data set, how to read it and its licence") {
  CardSet set;
  const auto card = set.card();
  REQUIRE(card);
  CHECK(card->starts_with("# walks\n<!-- data card of kinalign"));
  for (const char* text :
       {"Walking \\*people\\*.", "Takes: 1. People: 1. Frames: 600. Motion: 10.00 s.",
        "Verdicts: usable (1).", "| 01 | f | 165 | 600 | 0 | 0 |", "| S1 | walking | 600 | 0 | 0 |",
        "| mocap | mocap | 59 | 1 |", "60.0 Hz (1)",
        "h5py.File(\"sub-01/sub-01_task-A_run-01_take.h5\")", "- kinect: model: v2",
        "- `splits/people.json`", "- Licence: not stated in dataset.toml",
        "- Consent of 01: released", "- Consent of 02: not stated in dataset.toml",
        "Written by kinalign 0.1.0."}) {
    CAPTURE(std::string(text));
    CHECK(has(*card, text));
  }
  set.folder.write("README.md", *card);
  CHECK(set.card() == *card);
}

TEST_CASE("own text in the old card is kept, byte by byte, and needs an end") {
  CardSet set;
  std::string card = *set.card();
  const std::string own = "<!-- own text -->\n\n## Ours\n| a | <b>*c*</b> |\n<!-- end -->\n";
  card.replace(card.find("<!-- own text -->"),
               std::string("<!-- own text -->\n\n<!-- end -->\n").size(), own);
  set.folder.write("README.md", card + "\nlost\n<!-- own text -->two<!-- end -->\n");
  const auto anew = set.card();
  REQUIRE(anew);
  CHECK(has(*anew, own + "\n<!-- own text -->two<!-- end -->\n"));
  CHECK(!has(*anew, "lost"));
  set.folder.write("README.md", "# walks\n\n<!-- own text -->\nno end\n");
  const auto refused = set.card();
  REQUIRE(!refused);
  CHECK(to_string(refused.error()) ==
        set.folder / "README.md" + ":3: expected <!-- end --> behind the own text, found none");
}
