#include <gmock/gmock.h>

#include "bridges/aseba/node.hpp"

namespace tandem::bridges::aseba {
namespace {

using testing::HasSubstr;
using enum DescriptionDraft::Progress;

Description announcing(std::uint16_t words, std::uint16_t variables, std::uint16_t events = 0,
                       std::uint16_t functions = 0) {
  return {"left motor", 5, 1024, 32, words, variables, events, functions};
}

TEST(Description, GivesEachVariableTheAddressBehindThoseBeforeIt) {
  DescriptionDraft draft;
  draft.begin(announcing(200, 5, 1, 1));
  draft.add(NamedVariable{1, "id"});
  draft.add(NamedVariable{1, "source"});
  draft.add(NamedVariable{32, "args"});
  draft.add(NamedVariable{1, "speed"});
  draft.add(NamedVariable{2, "odo"});
  draft.add(LocalEvent{"timer", "every step"});
  EXPECT_EQ(draft.progress(), Collecting);
  draft.add(NativeFunction{"math.add", "sum", 0, {}});
  ASSERT_EQ(draft.progress(), Complete);
  const NodeDescription& d = draft.description();
  EXPECT_EQ(d.variable("speed")->address, 34);
  EXPECT_EQ(d.variable("odo")->address, 35);
  EXPECT_EQ(d.variable("odo")->words, 2);
  EXPECT_EQ(d.variable("nothing"), nullptr);
  EXPECT_EQ(d.named_words(), 37U);
}

TEST(Description, IsCompleteAtOnceWhereNothingIsAnnounced) {
  DescriptionDraft draft;
  draft.begin(announcing(0, 0));
  EXPECT_EQ(draft.progress(), Complete);
}

TEST(Description, RefusesTooManyVariables) {
  DescriptionDraft draft;
  draft.begin(announcing(65535, 65535));
  EXPECT_EQ(draft.progress(), Refused);
  EXPECT_THAT(draft.trouble(), HasSubstr("65535 named variables"));
  draft.begin(announcing(3, 4));
  EXPECT_EQ(draft.progress(), Refused);
  draft.begin(announcing(3, 1, 65535));
  EXPECT_EQ(draft.progress(), Refused);
}

TEST(Description, RefusesSizesBeyondTheMemory) {
  DescriptionDraft draft;
  draft.begin(announcing(100, 2));
  draft.add(NamedVariable{60, "a"});
  draft.add(NamedVariable{41, "b"});
  EXPECT_EQ(draft.progress(), Refused);
  EXPECT_THAT(draft.trouble(), HasSubstr("'b' with 41 words at 60 reaches beyond 100 words"));
  // A memory that no such processor has is none, whatever was announced.
  draft.begin(announcing(65535, 2));
  draft.add(NamedVariable{DescriptionDraft::kMostMemory, "a"});
  EXPECT_EQ(draft.progress(), Collecting);
  draft.add(NamedVariable{65535, "b"});
  EXPECT_EQ(draft.progress(), Refused);
}

TEST(Description, RefusesWhatShowsThatMessagesWereLostOrDoubled) {
  DescriptionDraft draft;
  draft.begin(announcing(100, 2, 1, 1));
  draft.add(NamedVariable{1, "a"});
  draft.add(NamedVariable{1, "a"});
  EXPECT_THAT(draft.trouble(), HasSubstr("comes twice"));
  draft.begin(announcing(100, 2, 1, 1));
  draft.add(NamedVariable{1, "a"});
  draft.add(LocalEvent{"timer", ""});
  EXPECT_THAT(draft.trouble(), HasSubstr("variables are missing"));
  draft.begin(announcing(100, 1, 1, 1));
  draft.add(NamedVariable{1, "a"});
  draft.add(NamedVariable{1, "b"});
  EXPECT_THAT(draft.trouble(), HasSubstr("more variables than announced"));
  draft.begin(announcing(100, 1, 1, 1));
  draft.add(NamedVariable{1, "a"});
  draft.add(NativeFunction{"f", "", 0, {}});
  EXPECT_EQ(draft.progress(), Refused);
  draft.begin(announcing(100, 1));
  draft.add(NamedVariable{0, "a"});
  EXPECT_THAT(draft.trouble(), HasSubstr("no words"));
  draft.add(NamedVariable{1, "b"});  // nothing mends it but a new beginning
  EXPECT_EQ(draft.progress(), Refused);
  draft.begin(announcing(100, 1));
  EXPECT_EQ(draft.progress(), Collecting);
}

TEST(Description, TakesNamesOf255Bytes) {
  const std::string name(255, 'n');
  DescriptionDraft draft;
  draft.begin(announcing(10, 1));
  draft.add(NamedVariable{1, name});
  ASSERT_EQ(draft.progress(), Complete);
  EXPECT_NE(draft.description().variable(name), nullptr);
}

TEST(Image, FindsMarkedRangesAndTakesSmallGapsAlong) {
  Image image;
  image.resize(100);
  image.mark(10, 3, Image::kWanted);
  image.mark(18, 2, Image::kWanted);
  image.mark(60, 40, Image::kWanted);
  auto range = image.next(Image::kWanted, 0, 257, 8);
  EXPECT_EQ(range.start, 10U);
  EXPECT_EQ(range.count, 10U);
  range = image.next(Image::kWanted, 0, 257, 4);
  EXPECT_EQ(range.count, 3U);
  range = image.next(Image::kWanted, 20, 25, 8);
  EXPECT_EQ(range.start, 60U);
  EXPECT_EQ(range.count, 25U);
  EXPECT_EQ(image.next(Image::kDirty, 0, 257, 8).count, 0U);
  image.unmark(0, 100, Image::kWanted);
  EXPECT_EQ(image.next(Image::kWanted, 0, 257, 8).count, 0U);
}

}  // namespace
}  // namespace tandem::bridges::aseba
