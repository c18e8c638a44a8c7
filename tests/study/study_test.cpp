// Studies from text: what is read, and what is wrong, with its line.
#include "study/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/checkout.hpp"

namespace tandem::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kExperiment =
    "<experiment file=\"" + std::string(test::kSourceDir) + "/configs/epuck_diffusion.xml\"/>";

struct Outcome {
  std::optional<Study> study;
  std::string problems;
};

Outcome read(const std::string& content) {
  Outcome out;
  core::Problems problems;
  out.study = read_study_text("<study>\n" + content + "\n</study>\n", "s.xml", problems);
  for (const core::Problem& p : problems) out.problems += core::to_text(p) + "\n";
  return out;
}

TEST(Study, TakesListsRangesPairsAndSeedsFromItsFile) {
  const Outcome read_ = read(kExperiment + R"(
    <parameter path="a.b.list" values="1, 2 m ,5"/>
    <parameter path="a.b.vector" values="0,0,1; 2,0,1"/>
    <parameter path="a.b.steps" from="0" to="0.3" step="0.1"/>
    <parameter path="a.b.counted" from="10 cm" to="50 cm" count="3"/>
    <parameter path="a.b.grown" name="log" from="1" to="100" count="3" scale="log"/>
    <paired><parameter path="a.b.x" values="1,2"/><parameter path="a.b.y" values="3,4"/></paired>
    <set path="a.length" value="60"/>
    <seeds first="5" count="3"/>
    <measures names="items, b*" every="2 s"><measure name="steps" published="steps" over="max"/></measures>)");
  ASSERT_TRUE(read_.study) << read_.problems;
  const Study& s = *read_.study;
  ASSERT_EQ(s.axes.size(), 6U);
  EXPECT_THAT(s.axes[0].parameters[0].values, ElementsAre("1", "2 m", "5"));
  EXPECT_EQ(s.axes[0].parameters[0].name, "list");
  EXPECT_THAT(s.axes[1].parameters[0].values, ElementsAre("0,0,1", "2,0,1"));
  EXPECT_THAT(s.axes[2].parameters[0].values, ElementsAre("0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(s.axes[3].parameters[0].values, ElementsAre("10 cm", "30 cm", "50 cm"));
  EXPECT_THAT(s.axes[4].parameters[0].values, ElementsAre("1", "10", "100"));
  EXPECT_EQ(s.axes[5].parameters.size(), 2U);
  EXPECT_THAT(s.seeds, ElementsAre(5U, 6U, 7U));
  EXPECT_THAT(s.measures, ElementsAre("items", "b*"));
  EXPECT_EQ(s.sample_every_s, 2.0);
  EXPECT_EQ(s.table, "s.sqlite");
  ASSERT_EQ(s.published.size(), 1U);
  EXPECT_EQ(s.published[0].over, Over::Max);
}

TEST(Study, NamesEveryMistakeWithItsLine) {
  const std::pair<std::string, std::string> mistakes[] = {
      {"<seed first=\"1\"/>", "s.xml:3: error: <study> cannot hold <seed>"},
      {"<seeds frist=\"1\" count=\"2\"/>", "s.xml:3: error: <seeds> has no attribute 'frist'. Did you mean 'first'"},
      {"<seeds first=\"1\"/>", "s.xml:3: error: <seeds> needs either first and count"},
      {"<seeds values=\"1, 2, x\"/>", "'x' is no seed"},
      {"<parameter path=\"a.b\"/>", "s.xml:3: error: <parameter>: needs either a list"},
      {"<parameter path=\"a.b\" values=\"1,2\" from=\"2\"/>", "needs either a list"},
      {"<parameter path=\"a.b\" values=\"1,,2\"/>", "one of them is empty"},
      {"<parameter path=\"a.b\" values=\"1,2,1\"/>", "'1' stands twice"},
      {"<parameter path=\"a.b\" from=\"1 m\" to=\"5\" count=\"2\"/>", "different units"},
      {"<parameter path=\"a.b\" from=\"0\" to=\"5\" count=\"2\" scale=\"log\"/>", "needs ends above 0"},
      {"<parameter path=\"a.b\" from=\"0\" to=\"5\" step=\"-1\"/>", "does not lead"},
      {"<parameter path=\"a.b\" from=\"0\" to=\"5\" step=\"1e-9\"/>", "ten million"},
      {"<parameter path=\"a.b\" from=\"x\" to=\"5\" count=\"2\"/>", "must begin with a number"},
      {"<parameter path=\"a.seed\" values=\"1\"/>", "every table has a column 'seed'"},
      {"<parameter path=\"a.b-c\" values=\"1\"/>", "cannot name a column"},
      {"<parameter path=\"a.b\" values=\"1\"/>\n<parameter path=\"c.b\" values=\"1\"/>",
       "s.xml:4: error: a second parameter 'b'; the first is on line 3"},
      {"<set path=\"a.b\" value=\"1\"/>\n<parameter path=\"a.b\" values=\"1\"/>", "a second path 'a.b'"},
      {"<paired><parameter path=\"a.b\" values=\"1,2\"/><parameter path=\"a.c\" values=\"1\"/></paired>",
       "'c' has 1 values, and 'b', with which it is paired, 2"},
      {"<latin_hypercube points=\"5\"><parameter path=\"a.b\" values=\"1\"/></latin_hypercube>",
       "needs 'from' and 'to'"},
      {"<latin_hypercube points=\"5\"/>", "needs a <parameter>"},
      {"<experiment file=\"nowhere.xml\"/>", "s.xml:3: error: <experiment file>: there is no file 'nowhere.xml'"},
      {kExperiment, "a second experiment 'epuck_diffusion'"},
  };
  for (const auto& [content, message] : mistakes) {
    const Outcome out = read(kExperiment + "\n" + content);
    EXPECT_FALSE(out.study) << content;
    EXPECT_THAT(out.problems, HasSubstr(message)) << content;
  }
  EXPECT_THAT(read("").problems, HasSubstr("needs an <experiment"));
}

TEST(Study, SaysWhenAFileIsAnExperiment) {
  core::Problems problems;
  EXPECT_FALSE(read_study_text("<tandem/>", "e.xml", problems));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(core::to_text(problems[0]), HasSubstr("an experiment is run by `tandem run`"));
}

TEST(Study, DescribesEachOfItsElements) {
  for (const core::ElementManual& m : study_manuals()) {
    EXPECT_FALSE(m.doc.empty()) << m.name;
    EXPECT_EQ(m.parent.empty(), m.name == "study") << m.name;
  }
}

}  // namespace
}  // namespace tandem::study
