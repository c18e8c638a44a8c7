#include "hal/element.hpp"

#include <array>
#include <gmock/gmock.h>

#include "hal/open_params.hpp"

namespace tandem::hal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// One parameter of every kind.
struct Settings {
  double speed_m_s = 0.05;
  std::int64_t count = 3;
  bool loud = false;
  std::string name = "nobody";
  std::string mode = "slow";
  std::array<double, 3> place_m{1.0, 2.0, 3.0};
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kModes = {"slow", "quick"};
    v.number("speed", speed_m_s, unit::cm_s, {0.0, 0.129}, "How fast.");
    v.integer("count", count, {1, 10}, "How many.");
    v.flag("loud", loud, "Whether it is heard.");
    v.text("name", name, "Who.");
    v.choice("mode", mode, kModes, "In which way.");
    v.vector("place", place_m, unit::m, "Where.");
  }
};

/// Parameters that hold others.
struct Gains {
  double p = 0.1 + 0.2;
  struct Limit {
    std::int64_t most = 9;
    void describe(ParamVisitor& v) { v.integer("most", most, {0, 100}, "At most."); }
  } limit;
  void describe(ParamVisitor& v) {
    v.number("p", p, unit::none, {0.0, 5.0}, "Proportional.");
    v.group("limit", limit, "Bounds.");
  }
};
struct Point {
  double x_m = 1.0;
  void describe(ParamVisitor& v) { v.number("x", x_m, unit::m, kAny, "East."); }
};
struct Plan {
  std::string name = "tour";
  Gains gains;
  std::vector<Point> points = {{5.0}, {6.0}};
  void describe(ParamVisitor& v) {
    v.text("name", name, "Its name.");
    v.group("gains", gains, "Of the loop.");
    v.list("point", points, "Where to go.");
  }
};

Element with_children(Element e, std::vector<Element> children) {
  e.children = std::move(children);
  return e;
}

Element child(const std::string& name, int line, std::vector<Element::Attribute> attributes = {}) {
  Element e;
  e.name = name;
  e.file = "file.xml";
  e.line = line;
  e.attributes = std::move(attributes);
  return e;
}

Element element(std::vector<Element::Attribute> attributes) {
  Element e;
  e.name = "thing";
  e.file = "file.xml";
  e.line = 3;
  e.attributes = std::move(attributes);
  return e;
}

struct Read {
  Settings settings;
  std::vector<std::string> problems;
};

Read read(std::vector<Element::Attribute> attributes, std::vector<std::string> ignore = {}) {
  const Element e = element(std::move(attributes));
  Read out;
  Problems problems;
  ElementReader reader(e, problems, std::move(ignore));
  out.settings.describe(reader);
  reader.finish();
  for (const Problem& p : problems) out.problems.push_back(to_text(p));
  return out;
}

TEST(ElementReader, FillsEveryKindOfValue) {
  const Read r = read({{"speed", "12 cm/s", 4},
                       {"count", "7", 4},
                       {"loud", "true", 4},
                       {"name", "ep0", 4},
                       {"mode", "quick", 4},
                       {"place", "4,5 cm, 6", 4}});
  EXPECT_TRUE(r.problems.empty());
  EXPECT_DOUBLE_EQ(r.settings.speed_m_s, 0.12);
  EXPECT_EQ(r.settings.count, 7);
  EXPECT_TRUE(r.settings.loud);
  EXPECT_EQ(r.settings.name, "ep0");
  EXPECT_EQ(r.settings.mode, "quick");
  EXPECT_THAT(r.settings.place_m, ElementsAre(4.0, 0.05, 6.0));
}

TEST(ElementReader, TakesABareNumberInTheDocumentedUnit) {
  EXPECT_DOUBLE_EQ(read({{"speed", "5", 4}}).settings.speed_m_s, 0.05);
}

TEST(ElementReader, KeepsWhatIsLeftOut) {
  const Read r = read({});
  EXPECT_TRUE(r.problems.empty());
  EXPECT_EQ(r.settings.count, 3);
  EXPECT_EQ(r.settings.name, "nobody");
}

TEST(ElementReader, TakesTheLimitsOfARangeDespiteRounding) {
  EXPECT_EQ(read({{"speed", "12.9 cm/s", 4}}).settings.speed_m_s, 0.129);
  EXPECT_EQ(read({{"speed", "129 mm/s", 4}}).settings.speed_m_s, 0.129);
  EXPECT_EQ(read({{"speed", "0", 4}}).settings.speed_m_s, 0.0);
  EXPECT_FALSE(read({{"speed", "12.91 cm/s", 4}}).problems.empty());
  EXPECT_FALSE(read({{"speed", "-1e-13", 4}}).problems.empty());
}

TEST(ElementReader, ForgivesSpacesAndPlus) {
  const Read r = read({{"speed", " +5 ", 4}, {"count", " +7 ", 4}, {"loud", " 1 ", 4}, {"mode", " quick", 4}});
  EXPECT_TRUE(r.problems.empty());
  EXPECT_EQ(r.settings.count, 7);
  EXPECT_TRUE(r.settings.loud);
  EXPECT_EQ(r.settings.mode, "quick");
}

struct Bad {
  std::string attribute, value, message;
};
void PrintTo(const Bad& bad, std::ostream* out) {
  *out << bad.attribute << "=" << bad.value;
}

class BadValue : public testing::TestWithParam<Bad> {};

TEST_P(BadValue, IsNamedAndLeavesTheDefault) {
  const Read r = read({{GetParam().attribute, GetParam().value, 4}});
  ASSERT_EQ(r.problems.size(), 1U);
  EXPECT_THAT(r.problems[0], testing::StartsWith("file.xml:4: error: <thing " + GetParam().attribute + ">: "));
  EXPECT_THAT(r.problems[0], HasSubstr(GetParam().message));
  const Settings untouched;
  EXPECT_EQ(r.settings.speed_m_s, untouched.speed_m_s);
  EXPECT_EQ(r.settings.count, untouched.count);
  EXPECT_EQ(r.settings.loud, untouched.loud);
  EXPECT_EQ(r.settings.mode, untouched.mode);
  EXPECT_EQ(r.settings.place_m, untouched.place_m);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadValue,
    testing::Values(Bad{"speed", "fast", "'fast' is not a number"}, Bad{"speed", "", "'' is not a number"},
                    Bad{"speed", "5 cm", "unit 'cm' does not fit; use one of: m/s, cm/s, mm/s"},
                    Bad{"speed", "13", "'13' is out of range; it may be from 0 cm/s to 12.9 cm/s"},
                    Bad{"speed", "nan", "is not a number"}, Bad{"count", "2.5", "is not a whole number"},
                    Bad{"count", "0", "it may be from 1 to 10"}, Bad{"count", "7x", "is not a whole number"},
                    Bad{"count", "+-7", "is not a whole number"}, Bad{"count", "9223372036854775808", "too large"},
                    Bad{"loud", "perhaps", "neither"},
                    Bad{"mode", "quik", "is not one of: slow, quick. Did you mean 'quick'?"},
                    Bad{"place", "1,2", "must be three numbers"}, Bad{"place", "1,2,3,4", "must be three numbers"},
                    Bad{"place", "1,b,3", "'b' is not a number"}, Bad{"place", "1 s,2,3", "unit 's' does not fit"}));

TEST(ElementReader, NamesUnknownAttributesAndTheNearestKnownOne) {
  const Read r = read({{"sped", "1", 5}, {"x", "1", 0}, {"implementation", "default", 4}}, {"implementation"});
  EXPECT_THAT(r.problems, ElementsAre("file.xml:5: error: <thing> has no attribute 'sped'. Did you mean 'speed'?",
                                      "file.xml:3: error: <thing> has no attribute 'x'"));
}

TEST(ElementReader, NamesTheOriginOfWhatWasNotInTheFile) {
  const Read r = read({{"speed", "fast", 0, "--set thing.speed=fast"}, {"sped", "1", 0, "--set thing.sped=1"}});
  ASSERT_EQ(r.problems.size(), 2U);
  EXPECT_THAT(r.problems[0], testing::StartsWith("--set thing.speed=fast: error: <thing speed>: 'fast'"));
  EXPECT_THAT(r.problems[1], testing::StartsWith("--set thing.sped=1: error: <thing> has no attribute"));
}

TEST(ElementWriter, CompletesAnElementSoThatItReadsBack) {
  Element e = element({{"count", "9", 4}});
  Settings settings;
  ElementWriter writer(e);
  settings.describe(writer);
  ASSERT_EQ(e.attributes.size(), 6U);
  EXPECT_EQ(*e.attribute("count"), "9") << "what the file says stays";
  EXPECT_EQ(*e.attribute("speed"), "5 cm/s");
  EXPECT_EQ(*e.attribute("loud"), "false");
  EXPECT_EQ(*e.attribute("place"), "1 m,2 m,3 m");
  const Read r = read(e.attributes);
  EXPECT_TRUE(r.problems.empty());
  EXPECT_EQ(r.settings.speed_m_s, settings.speed_m_s);
  EXPECT_EQ(r.settings.place_m, settings.place_m);
}

TEST(ManualWriter, ShowsDefaultRangeUnitAndMeaning) {
  Settings settings;
  ManualWriter manual;
  settings.describe(manual);
  EXPECT_EQ(manual.text(),
            "  speed=\"5 cm/s\"  (from 0 cm/s to 12.9 cm/s; a bare number is in cm/s)\n      How fast.\n"
            "  count=\"3\"  (from 1 to 10)\n      How many.\n"
            "  loud=\"false\"  (true or false)\n      Whether it is heard.\n"
            "  name=\"nobody\"\n      Who.\n"
            "  mode=\"slow\"  (slow, quick)\n      In which way.\n"
            "  place=\"1,2,3\"  (three numbers in m)\n      Where.\n");
}

TEST(Element, FindsAttributesAndChildren) {
  Element e = element({{"a", "1", 1}, {"b", "2", 1}});
  e.children.push_back(element({{"x", "first", 1}}));
  e.children.push_back(element({{"x", "second", 1}}));
  EXPECT_EQ(*e.attribute("b"), "2");
  EXPECT_EQ(e.attribute("c"), nullptr);
  EXPECT_EQ(*e.child("thing")->attribute("x"), "first");
  EXPECT_EQ(e.child("other"), nullptr);
}

TEST(Problem, ReadsLikeACompilersMessage) {
  EXPECT_EQ(to_text({"a.xml", 7, "no good", false}), "a.xml:7: error: no good");
  EXPECT_EQ(to_text({"a.xml", 0, "no good", true}), "a.xml: warning: no good");
  EXPECT_FALSE(has_errors({{"a", 1, "w", true}}));
  EXPECT_TRUE(has_errors({{"a", 1, "w", true}, {"a", 1, "e", false}}));
}

TEST(Problem, PointsAtTheAttributeOrElseTheElement) {
  const Element e = element({{"a", "1", 5}});
  EXPECT_EQ(to_text(problem_at(e, "a", "bad")), "file.xml:5: error: <thing a>: bad");
  EXPECT_EQ(to_text(problem_at(e, "b", "missing")), "file.xml:3: error: <thing b>: missing");
  EXPECT_EQ(to_text(problem_at(e, "bad")), "file.xml:3: error: bad");
}

TEST(Closest, FindsWhatWasMeant) {
  const std::vector<std::string> names = {"proximity", "light", "ground"};
  EXPECT_EQ(closest("proxmity", names), "proximity");
  EXPECT_EQ(closest("ligth", names), "light");
  EXPECT_EQ(closest("wheels", names), "");
  EXPECT_EQ(closest("", {}), "");
  EXPECT_EQ(closest(std::string(1000, 'x'), names), "");
  EXPECT_EQ(did_you_mean("grund", names), ". Did you mean 'ground'?");
  EXPECT_EQ(did_you_mean("camera", names), "");
}

TEST(Listed, IsShortForManyNames) {
  EXPECT_EQ(listed({}), "none");
  EXPECT_EQ(listed({"a", "b"}), "a, b");
  const std::vector<std::string> many(1000, "x");
  EXPECT_THAT(listed(many), testing::EndsWith("x, …"));
  EXPECT_LT(listed(many).size(), 100U);
}

TEST(ElementReader, ReadsGroupsAndListsFromChildren) {
  Problems problems;
  const Element e = with_children(
      element({}), {with_children(child("gains", 4, {{"p", "2", 4}}), {child("limit", 5, {{"most", "7", 5}})}),
                    child("point", 6, {{"x", "30 cm", 6}}), child("point", 7)});
  const Plan plan = read_settings<Plan>(e, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(plan.gains.p, 2.0);
  EXPECT_EQ(plan.gains.limit.most, 7);
  ASSERT_EQ(plan.points.size(), 2U);
  EXPECT_EQ(plan.points[0].x_m, 0.3);
  EXPECT_EQ(plan.points[1].x_m, 1.0);
}

TEST(ElementReader, KeepsGroupsAndListsThatTheFileLeavesOut) {
  Problems problems;
  const Plan plan = read_settings<Plan>(element({}), problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(plan.gains.limit.most, 9);
  ASSERT_EQ(plan.points.size(), 2U);
  EXPECT_EQ(plan.points[1].x_m, 6.0);
}

TEST(ElementReader, NamesEveryWrongChildWithItsLine) {
  Problems problems;
  const Element e =
      with_children(element({}), {with_children(child("gains", 4, {{"q", "2", 4}}), {child("limits", 5)}),
                                  child("gains", 6), child("piont", 7), child("point", 8, {{"x", "far", 8}})});
  (void)read_settings<Plan>(e, problems);
  std::vector<std::string> texts;
  for (const Problem& p : problems) texts.push_back(to_text(p));
  EXPECT_THAT(
      texts,
      testing::UnorderedElementsAre(
          HasSubstr("file.xml:4: error: <gains> has no attribute 'q'"),
          HasSubstr("file.xml:5: error: <gains> cannot hold <limits>; it may hold: limit. Did you mean 'limit'?"),
          HasSubstr("file.xml:6: error: a second <gains>; the first is on line 4"),
          HasSubstr("file.xml:7: error: <thing> cannot hold <piont>; it may hold: gains, point. Did you mean 'point'?"),
          HasSubstr("file.xml:8: error: <point x>")));
}

TEST(ElementReader, AllowsNoChildWhereNoneIsDescribed) {
  Problems problems;
  (void)read_settings<Settings>(with_children(element({}), {child("more", 4)}), problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(to_text(problems[0]), "file.xml:4: error: <thing> cannot hold <more>; it may hold: none");
}

TEST(ElementWriter, CompletesGroupsAndListsSoThatTheyReadBackAsTheSameBits) {
  Element e = with_children(element({}), {child("gains", 4)});
  Plan plan;
  ElementWriter writer(e);
  plan.describe(writer);
  Problems problems;
  const Plan back = read_settings<Plan>(e, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(back.gains.p, 0.1 + 0.2);
  EXPECT_EQ(back.gains.limit.most, 9);
  ASSERT_EQ(back.points.size(), 2U);
  EXPECT_EQ(back.points[0].x_m, 5.0);
  ASSERT_NE(e.child("gains"), nullptr);
  EXPECT_NE(e.child("gains")->child("limit"), nullptr);
}

TEST(ManualWriter, ShowsGroupsAndListsWithWhatTheyHold) {
  ManualWriter manual;
  Plan plan;
  plan.describe(manual);
  EXPECT_THAT(manual.text(), HasSubstr("  <gains>  (an element inside)\n      Of the loop.\n      p="));
  EXPECT_THAT(manual.text(), HasSubstr("          most=\"9\""));
  EXPECT_THAT(manual.text(), HasSubstr("  <point>  (any number of elements inside"));
}

/// Takes whatever its file says.
struct Open {
  std::string script;
  std::vector<NamedText> others;
  void describe(ParamVisitor& v) {
    describe_file(v, "script", script, "What it does.");
    describe_others(v, others, "For the script.");
  }
};

TEST(Element, HandsWhatNobodyKnowsToThoseWhoTakeIt) {
  Element element{
      "params", "/there/file.xml", 3, {{"script", "walk.lua", 3}, {"speed", "5 cm/s", 3}, {"none", "", 3}}, {}};
  Problems problems;
  const Open open = read_settings<Open>(element, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(open.script, "/there/walk.lua");
  ASSERT_EQ(open.others.size(), 2U);
  EXPECT_EQ(open.others[0].name + "=" + open.others[0].value, "speed=5 cm/s");
  EXPECT_EQ(open.others[1].name + "=" + open.others[1].value, "none=");
  ManualWriter manual;
  Open().describe(manual);
  EXPECT_THAT(manual.text(), HasSubstr("NAME=\"TEXT\"  (any other name)"));
  ElementWriter writer(element);
  Open().describe(writer);
  EXPECT_EQ(element.attributes.size(), 3U);
}

}  // namespace
}  // namespace tandem::hal
