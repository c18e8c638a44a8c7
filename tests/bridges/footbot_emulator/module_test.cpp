// One module, asked with the bytes of the protocol's description.
#include "bridges/footbot_emulator/modules.hpp"
#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class AModule : public testing::Test {
 protected:
  explicit AModule(Protocol protocol = Protocol::V5) : module_(1, "left motor", {{"speed", 1}, {"odo", 2}}, protocol) {}

  std::vector<Message> ask(std::uint16_t type, const std::vector<int>& words) {
    Message question{0, type, {}};
    for (const int w : words) question.add(static_cast<std::uint16_t>(w));
    std::vector<Message> answers;
    module_.obey(question, 0, answers, [this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
      log_.push_back(to_json(at, name, fields));
    });
    return answers;
  }
  std::vector<int> read(int start, int count) {
    const auto answers = ask(type::kGetVariables, {1, start, count});
    EXPECT_EQ(answers.size(), 1U);
    std::vector<int> words;
    for (std::size_t i = 0; i < answers.at(0).words(); ++i) {
      words.push_back(static_cast<std::int16_t>(answers[0].word(i)));
    }
    return words;
  }

  Module module_;
  std::vector<std::string> log_;
};

class AnOldModule : public AModule {
 protected:
  AnOldModule() : AModule(Protocol::V4) {}
};

TEST_F(AModule, SaysThatItIsThere) {
  EXPECT_THAT(ask(type::kListNodes, {5}), ElementsAre(Message{1, type::kNodePresent, {5, 0}}));
}

TEST_F(AModule, DescribesItselfToThoseWhoAskForIt) {
  EXPECT_THAT(ask(type::kGetDescription, {5}), IsEmpty());
  EXPECT_THAT(ask(type::kGetNodeDescription, {2, 5}), IsEmpty());
  EXPECT_EQ(ask(type::kGetDescription, {4}), ask(type::kGetNodeDescription, {1, 5}));
  const auto d = ask(type::kGetNodeDescription, {1, 5});
  ASSERT_EQ(d.size(), 1 + 5 + 1 + 2U);
  Message head{1, type::kDescription, {}};
  head.add_text("left motor").add(5).add(1024).add(32).add(256).add(5).add(1).add(2);
  EXPECT_EQ(d[0], head);
  const std::vector<std::pair<std::string, int>> names = {
      {"id", 1}, {"source", 1}, {"args", 32}, {"speed", 1}, {"odo", 2}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    Message variable{1, type::kNamedVariable, {}};
    variable.add(static_cast<std::uint16_t>(names[i].second)).add_text(names[i].first);
    EXPECT_EQ(d[i + 1], variable) << names[i].first;
  }
  EXPECT_EQ(d[6].type, type::kLocalEvent);
  EXPECT_EQ(d[7].type, type::kNativeFunction);
  EXPECT_EQ(d[8].type, type::kNativeFunction);
}

TEST_F(AnOldModule, KnowsOneQuestionOnly) {
  EXPECT_THAT(ask(type::kListNodes, {5}), IsEmpty());
  EXPECT_THAT(ask(type::kGetNodeDescription, {1, 5}), IsEmpty());
  for (const int version : {4, 5}) {
    const auto d = ask(type::kGetDescription, {version});
    ASSERT_FALSE(d.empty());
    EXPECT_EQ(d[0].payload.at(11), 4);  // behind the name and its length
  }
}

TEST_F(AModule, IsReadAndWritten) {
  EXPECT_THAT(read(0, 4), ElementsAre(0, 1, 0, 0, 0));
  EXPECT_THAT(ask(type::kSetVariables, {1, 34, -300, 77}), IsEmpty());
  EXPECT_TRUE(module_.written("speed"));
  EXPECT_TRUE(module_.written("odo"));
  EXPECT_THAT(read(34, 3), ElementsAre(34, -300, 77, 0));
  EXPECT_FALSE(module_.written("speed"));
  ask(type::kSetVariables, {1, 35, 5});
  EXPECT_FALSE(module_.written("speed"));
  EXPECT_THAT(ask(type::kSetVariables, {2, 34, 1}), IsEmpty());
  EXPECT_THAT(read(34, 1), ElementsAre(34, -300));
  EXPECT_THAT(ask(type::kGetVariables, {9, 0, 6}), IsEmpty());
}

TEST_F(AModule, ChecksNoBounds) {
  const auto most = ask(type::kGetVariables, {1, 0, 257});
  ASSERT_EQ(most.size(), 1U);
  EXPECT_EQ(most[0].payload.size(), 0x204U);
  EXPECT_EQ(read(255, 3).size(), 4U);
  EXPECT_THAT(log_.back(), testing::HasSubstr("get_beyond"));
  ask(type::kSetVariables, {1, 255, 7, 8});
  EXPECT_THAT(log_.back(), testing::HasSubstr("set_beyond"));
  EXPECT_THAT(read(255, 1), ElementsAre(255, 7));
  ask(type::kSetVariables, {1, 65535, 7, 8});
  EXPECT_THAT(read(0, 1), ElementsAre(0, 1));
  EXPECT_THAT(ask(type::kGetVariables, {1, 0, 258}), IsEmpty());
}

TEST_F(AModule, HasAMachineThatCanBeSteered) {
  const auto state = [](int flags) { return Message{1, type::kExecutionState, {0, 0, std::uint8_t(flags), 0}}; };
  EXPECT_THAT(ask(type::kGetExecutionState, {1}), ElementsAre(state(0)));
  EXPECT_THAT(ask(type::kReset, {1}), ElementsAre(state(2)));
  EXPECT_THAT(ask(type::kGetExecutionState, {1}), ElementsAre(state(2)));
  EXPECT_THAT(ask(type::kRun, {1}), ElementsAre(state(0)));
  EXPECT_THAT(ask(type::kPause, {1}), ElementsAre(state(2)));
  EXPECT_THAT(ask(type::kBreakpointSet, {1, 0}), ElementsAre(Message{1, type::kBreakpointSetResult, {0, 0, 1, 0}}));
  EXPECT_THAT(ask(type::kBreakpointSet, {1, 5000}),
              ElementsAre(Message{1, type::kBreakpointSetResult, {0x88, 0x13, 0, 0}}));
  EXPECT_THAT(ask(type::kRun, {2}), IsEmpty());
}

TEST_F(AModule, KeepsItsVariablesThroughAReset) {
  ask(type::kSetVariables, {1, 34, 30});
  ask(type::kReset, {1});
  ask(type::kStop, {1});
  EXPECT_THAT(read(34, 1), ElementsAre(34, 30));
  module_.restart();
  EXPECT_THAT(read(34, 1), ElementsAre(34, 0));
  EXPECT_THAT(read(0, 1), ElementsAre(0, 1));
}

TEST_F(AModule, HearsTheEventsThatItsProgramWaitsFor) {
  ask(5, {1, 2, 3});
  EXPECT_THAT(read(1, 4), ElementsAre(1, 0, 0, 0, 0));
  ask(type::kSetBytecode, {1, 0, 3, 5, 3, 0});  // 3 words of vector: event 5 at address 3
  ask(6, {9});
  EXPECT_THAT(read(2, 1), ElementsAre(2, 0));
  ask(5, {1, 2, 3});
  EXPECT_THAT(read(1, 4), ElementsAre(1, 0, 1, 2, 3));
  module_.restart();
  ask(5, {1, 2, 3});
  EXPECT_THAT(read(2, 1), ElementsAre(2, 0)) << "the program was not kept";
  ask(type::kSetBytecode, {1, 0, 3, 5, 3, 0});
  ask(type::kWriteBytecode, {1});
  module_.restart();
  ask(5, {1, 2, 3});
  EXPECT_THAT(read(2, 1), ElementsAre(2, 1));
}

TEST_F(AModule, IgnoresWhatIsNotForIt) {
  EXPECT_THAT(ask(type::kVariables, {34, 7}), IsEmpty());
  EXPECT_THAT(ask(0x8000, {1}), IsEmpty());
  EXPECT_THAT(ask(0xA0FF, {1}), IsEmpty());
  EXPECT_THAT(log_.back(), testing::HasSubstr("ignored"));
  EXPECT_THAT(ask(type::kSetVariables, {}), IsEmpty());
  EXPECT_THAT(ask(type::kSetVariables, {1}), IsEmpty());
  EXPECT_THAT(read(34, 1), ElementsAre(34, 0));
}

TEST_F(AModule, LiesWhenToldTo) {
  const auto honest = ask(type::kGetNodeDescription, {1, 5});
  module_.set_lie(Lie::Size);
  auto d = ask(type::kGetNodeDescription, {1, 5});
  EXPECT_EQ(d[4], (Message{1, type::kNamedVariable, {}}.add(2).add_text("speed")));
  module_.set_lie(Lie::Name);
  d = ask(type::kGetNodeDescription, {1, 5});
  EXPECT_EQ(d[4], (Message{1, type::kNamedVariable, {}}.add(1).add_text("speed?")));
  module_.set_lie(Lie::Count);
  d = ask(type::kGetNodeDescription, {1, 5});
  EXPECT_EQ(d.size(), honest.size());
  EXPECT_NE(d[0], honest[0]);
  module_.set_lie(Lie::None);
  EXPECT_EQ(ask(type::kGetNodeDescription, {1, 5}), honest);
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
