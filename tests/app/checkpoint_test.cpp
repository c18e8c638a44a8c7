// Runs that go on from a checkpoint on disk: the same run, to the last bit, however it was ended before.
#include <gmock/gmock.h>
#include <sstream>

#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;
using testing::HasSubstr;

std::string config(const std::string& name) {
  return std::string(test::kSourceDir) + "/configs/" + name + ".xml";
}

class OnDisk : public testing::Test {
 protected:
  std::unique_ptr<Tandem> run(std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    words.emplace_back("--quiet");
    return std::make_unique<Tandem>(words, folder_.path());
  }
  std::string refused(std::vector<std::string> words, int code = 1) {
    auto ended = run(std::move(words));
    EXPECT_EQ(ended->wait(), code) << ended->errors();
    return ended->errors();
  }
  scenarios::fs::path file(const std::string& name) const { return folder_.path() / name; }
  /// What a report says of the world, but not how long it took.
  std::string of_the_world(const std::string& report) const {
    const std::string text = text_of(file(report));
    const std::size_t measures = text.find("\"measures\"");
    return json_value(text, "state_hash") + json_value(text, "ended") +
           (measures == std::string::npos ? "" : text.substr(measures, text.find('}', measures) - measures));
  }
  /// Its lines from this tick on.
  std::string rows_from(const std::string& name, int tick) const {
    std::istringstream in(text_of(file(name)));
    std::string rows;
    for (std::string line; std::getline(in, line);) {
      if (std::isdigit(line[0]) != 0 && std::stoi(line) >= tick) rows += line + "\n";
    }
    return rows;
  }
  /// The tick of a checkpoint.
  int tick_of(const std::string& name) const { return std::stoi(json_value(text_of(file(name)), "tick")); }

  Folder folder_;
};

/// Killed at any moment, and taken up again and again: the end is that of a run that nobody killed.
TEST_F(OnDisk, ARunThatIsKilledAgainAndAgainEndsAsOneThatIsNot) {
  auto whole = run({config("footbot_foraging"), "--steps", "4000", "--seed", "5", "--report", "whole.json",
                    "--trajectory", "whole.csv"});
  ASSERT_EQ(whole->wait(120), 0) << whole->errors();

  std::vector<std::string> words = {config("footbot_foraging"), "--seed", "5"};
  int last = 0;
  for (int kills = 0; kills < 3; ++kills) {
    std::vector<std::string> all = words;
    for (const char* word : {"--steps", "4000", "--checkpoint", "c.ckpt", "--checkpoint-every", "1"})
      all.emplace_back(word);
    auto killed = run(all);
    ASSERT_TRUE(eventually([&] { return scenarios::fs::exists(file("c.ckpt")) && tick_of("c.ckpt") > last + 200; }, 60))
        << killed->errors();
    killed->signal(SIGKILL);
    ASSERT_EQ(killed->wait(), -SIGKILL);
    last = tick_of("c.ckpt");
    words = {"--resume", "c.ckpt"};
  }
  auto rest = run({"--resume", "c.ckpt", "--steps", "4000", "--report", "rest.json", "--trajectory", "rest.csv"});
  ASSERT_EQ(rest->wait(120), 0) << rest->errors();
  EXPECT_THAT(rest->errors(), HasSubstr("goes on from tick " + std::to_string(last)));
  EXPECT_EQ(of_the_world("rest.json"), of_the_world("whole.json"));
  EXPECT_EQ(rows_from("rest.csv", 0), rows_from("whole.csv", last));
}

TEST_F(OnDisk, ARunThatIsAskedToEndKeepsItsLastTick) {
  auto one =
      run({config("epuck_diffusion"), "--steps", "1000000000", "--checkpoint", "c.ckpt", "--checkpoint-every", "1e6"});
  ASSERT_TRUE(eventually([&] { return one->catches(SIGTERM); }, 30));
  one->signal(SIGTERM);
  ASSERT_EQ(one->wait(), 128 + SIGTERM) << one->errors();
  auto rest = run({"--resume", "c.ckpt", "--steps", std::to_string(tick_of("c.ckpt") + 5), "--report", "rest.json"});
  ASSERT_EQ(rest->wait(), 0) << rest->errors();
}

/// A script keeps what no other process could take over: its run is computed again.
TEST_F(OnDisk, WhatCannotBeWrittenIsComputedAgain) {
  auto whole = run({config("epuck_diffusion_lua"), "--steps", "60", "--seed", "5", "--report", "whole.json"});
  ASSERT_EQ(whole->wait(60), 0) << whole->errors();
  auto one = run({config("epuck_diffusion_lua"), "--steps", "40", "--seed", "5", "--checkpoint", "c.ckpt",
                  "--checkpoint-every", "1"});
  ASSERT_EQ(one->wait(60), 0) << one->errors();
  EXPECT_THAT(one->errors(), HasSubstr("--resume will compute the run again from its start"));
  EXPECT_THAT(one->errors(), HasSubstr("controller"));
  auto rest = run({"--resume", "c.ckpt", "--steps", "60", "--report", "rest.json", "--trajectory", "rest.csv"});
  ASSERT_EQ(rest->wait(60), 0) << rest->errors();
  EXPECT_THAT(rest->errors(), HasSubstr("computes 40 ticks again"));
  EXPECT_EQ(of_the_world("rest.json"), of_the_world("whole.json"));
  EXPECT_EQ(rows_from("rest.csv", 0), rows_from("rest.csv", 40));
  EXPECT_THAT(refused({"--resume", "c.ckpt", "--set", "framework.experiment.length=7"}),
              HasSubstr("--set and --seed cannot change what is computed again"));
}

TEST_F(OnDisk, AnotherWayOnFollowsTheChangedSettings) {
  auto one = run({config("epuck_diffusion"), "--steps", "50", "--checkpoint", "c.ckpt", "--checkpoint-every", "5",
                  "--report", "one.json"});
  ASSERT_EQ(one->wait(60), 0) << one->errors();
  const auto on = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"--resume", "c.ckpt", "--steps", "60", "--report", "on.json"};
    words.insert(words.end(), more.begin(), more.end());
    auto rest = run(words);
    EXPECT_EQ(rest->wait(60), 0) << rest->errors();
    return of_the_world("on.json");
  };
  const std::string same = on({});
  EXPECT_EQ(on({"--set", "framework.experiment.length=1000"}), same);
  EXPECT_NE(on({"--set", "controllers.epuck_diffusion.params.velocity=1"}), same);
  EXPECT_THAT(refused({"--resume", "c.ckpt", "--set", "arena.distribute[0].entity.quantity=3"}),
              HasSubstr("does not fit: cannot change on the way: arena.distribute[0].entity.quantity"));
}

TEST_F(OnDisk, AnotherSeedOrFloorIsNotTakenForTheOldOne) {
  auto one = run({config("footbot_foraging"), "--steps", "30", "--checkpoint", "c.ckpt", "--checkpoint-every", "3"});
  ASSERT_EQ(one->wait(60), 0) << one->errors();
  const auto on = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"--resume", "c.ckpt", "--steps", "40", "--report", "on.json"};
    words.insert(words.end(), more.begin(), more.end());
    auto rest = run(words);
    EXPECT_EQ(rest->wait(60), 0) << rest->errors();
    return of_the_world("on.json");
  };
  const std::string same = on({});
  EXPECT_EQ(on({"--set", "framework.experiment.random_seed=124"}), same) << "as it was";
  const std::string other = on({"--set", "framework.experiment.random_seed=9"});
  EXPECT_NE(other, same);
  EXPECT_EQ(on({"--seed", "9"}), other);
  EXPECT_NE(on({"--set", "arena.floor.source=none"}), same);
  EXPECT_NE(on({"--set", "arena.floor.pixels_per_meter=20"}), same);
}

TEST_F(OnDisk, AFileThatIsNoWholeCheckpointIsRefused) {
  auto one = run({config("epuck_diffusion"), "--steps", "20", "--checkpoint", "c.ckpt", "--checkpoint-every", "1",
                  "--record", "r.record"});
  ASSERT_EQ(one->wait(60), 0) << one->errors();
  const std::string bytes = text_of(file("c.ckpt"));
  EXPECT_THAT(refused({"--resume", "nowhere.ckpt"}), HasSubstr("nowhere.ckpt"));
  EXPECT_THAT(refused({"--resume", "r.record"}), HasSubstr("is a record, and no checkpoint"));
  folder_.write("cut.ckpt", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(refused({"--resume", "cut.ckpt"}), HasSubstr("is not whole"));
  std::string flipped = bytes;
  flipped[bytes.size() - 200] = static_cast<char>(flipped[bytes.size() - 200] ^ 4);
  folder_.write("flipped.ckpt", flipped);
  EXPECT_THAT(refused({"--resume", "flipped.ckpt"}), HasSubstr("is damaged"));
  folder_.write("empty.ckpt", "");
  EXPECT_THAT(refused({"--resume", "empty.ckpt"}), HasSubstr("empty.ckpt"));
}

TEST_F(OnDisk, NeitherAnExperimentNorBothAreNamed) {
  EXPECT_THAT(refused({}, 2), HasSubstr("--resume"));
  EXPECT_THAT(refused({config("epuck_diffusion"), "--resume", "c.ckpt"}, 2), HasSubstr("--resume"));
}

TEST_F(OnDisk, AFullDiskIsToldAndTheRunGoesOn) {
  auto one = run({config("epuck_diffusion"), "--steps", "20", "--checkpoint", "/dev/full", "--checkpoint-every", "1",
                  "--report", "r.json"});
  EXPECT_EQ(one->wait(60), 3) << one->errors();
  EXPECT_THAT(one->errors(), HasSubstr("No space left on device"));
  EXPECT_EQ(json_value(text_of(file("r.json")), "steps"), "20");
}

TEST_F(OnDisk, RealRobotsCannotBePutBack) {
  EXPECT_THAT(refused({config("epuck_mixed"), "--steps", "5", "--checkpoint", "c.ckpt"}),
              HasSubstr("real robots take part"));
}

}  // namespace
}  // namespace tandem
