#include <gmock/gmock.h>

#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string file() {
  Parts parts;
  parts.controllers =
      R"(<controllers><wander id="a" library="l"><params speed="1"/></wander><wander id="b" library="l"/></controllers>)";
  parts.things =
      R"(<box id="crate" size="1,1,1"><body position="0,0,0"/></box><box id="bench" size="1,1,1"><body position="0,0,0"/></box>)";
  for (const char* id : {"left", "right"}) {
    parts.things +=
        std::string(
            R"(<distribute><position method="uniform" min="0,0,0" max="1,1,0"/><orientation method="constant" values="0,0,0"/>)") +
        R"(<entity quantity="10"><e-puck id=")" + id + R"("><controller config="a"/></e-puck></entity></distribute>)";
  }
  return parts.text();
}

TEST(Overrides, SetWhatThePathNames) {
  const Scenario s = read(file(), {"framework.experiment.length=5", "arena.distribute[1].entity.quantity=1000",
                                   "arena.box[bench].size=2,2,2", "arena.box[0].size=3,3,3",
                                   "controllers.wander[a].params.speed=3", "tandem.arena.escape=stop"})
                         .good();
  EXPECT_EQ(s.length_s, 5.0);
  EXPECT_EQ(s.robots[0].distribute->quantity, 10);
  EXPECT_EQ(s.robots[1].distribute->quantity, 1000);
  EXPECT_EQ(s.objects[0].size[0], 3.0);
  EXPECT_EQ(s.objects[1].size[0], 2.0);
  EXPECT_EQ(*s.controllers[0].params.attribute("speed"), "3");
  EXPECT_EQ(s.escape, EscapePolicy::Stop);
}

TEST(Overrides, AddElementsThatMayBeLeftOut) {
  const Scenario s = read(file(), {"framework.system.threads=4", "framework.time.mode=realtime",
                                   "controllers.wander[b].params.speed=9", "record.trajectory.path=x.csv"})
                         .good();
  EXPECT_EQ(s.threads, 4);
  EXPECT_EQ(s.time_mode, TimeMode::Realtime);
  EXPECT_EQ(*s.controllers[1].params.attribute("speed"), "9");
  EXPECT_EQ(s.trajectory->path, "x.csv");
}

TEST(Overrides, TheLastOneCounts) {
  EXPECT_EQ(read(file(),
                 {"framework.experiment.length=5", "framework.experiment.length=6=6", "framework.experiment.length=7"})
                .good()
                .length_s,
            7.0);
}

struct Bad {
  std::string assignment, message;
};

void PrintTo(const Bad& bad, std::ostream* out) {
  *out << bad.assignment;
}

class BadOverride : public testing::TestWithParam<Bad> {};

TEST_P(BadOverride, IsNamedAndSaysWhatThereIs) {
  const Outcome out = read(file(), {GetParam().assignment});
  EXPECT_FALSE(out.scenario.has_value());
  ASSERT_EQ(out.problems.size(), 1U) << out.text();
  EXPECT_THAT(to_text(out.problems[0]), StartsWith("--set " + GetParam().assignment + ": error: "));
  EXPECT_THAT(out.problems[0].message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadOverride,
    testing::Values(
        Bad{"framework", "write path=value"}, Bad{"=5", "write path=value"},
        Bad{"length=5", "the path must name elements"}, Bad{"framework..length=5", "the path must name elements"},
        Bad{"arena.box[crate.size=1,1,1", "the path must name elements"},
        Bad{"arena.box[].size=1,1,1", "the path must name elements"},
        Bad{"arena.box[0][1].size=1,1,1", "the path must name elements"},
        Bad{"framwork.experiment.length=5",
            "<tandem> has no framwork; it has: framework, controllers, physics_engines, arena. Did you mean "
            "'framework'?"},
        Bad{"arena.box.size=1,1,1",
            "<arena> has 2 <box>; choose one with box[n], from 0, or box[id]: box[crate], box[bench], distribute[0]"},
        Bad{"arena.box[5].size=1,1,1", "<arena> has no box[5]; it has: box[crate], box[bench]"},
        Bad{"arena.box[crte].size=1,1,1", "<arena> has no box[crte]"},
        Bad{"arena.light.position=0,0,0", "<arena> has no light"},
        Bad{"framework.experiment.lenght=5", "<experiment> has no attribute 'lenght'. Did you mean 'length'?"},
        Bad{"framework.experiment.length=long", "'long' is not a number"},
        Bad{"arena.distribute[0].entity.quantity=-1", "out of range"},
        Bad{"arena.box[crate].size=1,0,1", "every length must be above 0"},
        Bad{"framework.system.thread=4", "<system> has no attribute 'thread'"}));

}  // namespace
}  // namespace tandem::core
