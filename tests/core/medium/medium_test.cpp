// Media: those that there are, and one that this file defines, with the devices that work in it.
#include "core/medium/medium.hpp"

#include <gmock/gmock.h>

#include "core/config/reader.hpp"
#include "core/device/describe.hpp"
#include "core/medium/range_and_bearing/range_and_bearing.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/footbots.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

// --- a medium of its own: whistles, which get weaker with the distance ---

struct Whistle {
  float loudness = 0.0F;
  std::uint8_t channel = 0;
};

class WhistleMedium final : public RowMedium<Whistle> {
 public:
  static constexpr std::string_view kKind = "whistle";
  void index(const SpaceStores& /*stores*/) override { ++indexed; }
  int indexed = 0;
};

struct Loudness {
  double loudness = 1.0;
  void describe(hal::ParamVisitor& v) {
    v.number("loudness", loudness, hal::unit::none, {0.0, 10.0}, "How loud a whistle is heard at a metre.");
  }
};
struct Named : Loudness {
  std::string medium;
  void describe(hal::ParamVisitor& v) {
    Loudness::describe(v);
    v.text("medium", medium, "Id of the whistle medium.");
  }
};

/// A lamp that whistles while it is on.
class Whistling final : public Actuator {
 public:
  Whistling(WhistleMedium& medium, std::uint8_t channel) : medium_(medium), channel_(channel) {}
  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    Whistle* const whistles = medium_.publish(context.block);
    if (whistles == nullptr) return;
    for (std::size_t i = 0; i < context.block.used; ++i)
      whistles[i] = {static_cast<const hal::BodyLed*>(ports)[i].on ? 1.0F : 0.0F, channel_};
  }

 private:
  WhistleMedium& medium_;
  std::uint8_t channel_;
};

/// Microphones that hear whistles.
class Listening final : public Sensor {
 public:
  Listening(const WhistleMedium& medium, std::uint8_t channel, double loudness)
      : medium_(medium), channel_(channel), loudness_(loudness) {}
  void sense(const DeviceContext& context, void* ports) noexcept override {
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::Microphones& port = static_cast<hal::Microphones*>(ports)[i];
      stamp(context, port);
      port.count = 1;
      double level = 0.0;
      context.stores.body_index.for_each_near(b.x_m[row], b.y_m[row], 2.0, [&](const IndexEntry& o) {
        const Whistle& whistle = medium_.of(o.row());
        if (o.row() != row && (whistle.channel == channel_ || channel_ == 0))
          level += loudness_ * static_cast<double>(whistle.loudness);
      });
      port.level[0] = static_cast<float>(level);
    }
  }

 private:
  const WhistleMedium& medium_;
  std::uint8_t channel_;
  double loudness_;
};

bool anybody(const hal::RobotKind&) {
  return true;
}

BlockFactory<Actuator> make_whistling(const Element& element, Problems& problems, const DeviceSetup& setup) {
  (void)read_options<Named>(element, problems);
  BlockFactory<Actuator> factory([setup](const BlockColumns&) {
    return std::make_unique<Whistling>(setup.medium_as<WhistleMedium>(), setup.channel);
  });
  factory.publishes = true;
  return factory;
}

BlockFactory<Sensor> make_listening(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto options = read_options<Named>(element, problems);
  BlockFactory<Sensor> factory([setup, options](const BlockColumns&) {
    return std::make_unique<Listening>(setup.medium_as<WhistleMedium>(), setup.channel, options.loudness);
  });
  factory.listens = true;
  return factory;
}

void register_whistling(hal::Registrar& registrar) {
  static const DeviceType kActuator =
      in_medium(WhistleMedium::kKind, actuator_type("body_led", "whistling", "Whistles while it is on.", &anybody,
                                                    &make_whistling, &describe_options<Named>));
  static const DeviceType kSensor = in_medium(
      WhistleMedium::kKind,
      sensor_type("microphones", "whistles", "Hear whistles.", &anybody, &make_listening, &describe_options<Named>));
  registrar.add(kActuator);
  registrar.add(kSensor);
}

void register_whistles(hal::Registrar& registrar) {
  static constexpr MediumType kMedium{WhistleMedium::kKind, "Whistles.",
                                      [](hal::ParamVisitor& v) { Loudness{}.describe(v); },
                                      []() -> std::unique_ptr<Medium> { return std::make_unique<WhistleMedium>(); }};
  registrar.add(kMedium);
  register_whistling(registrar);
}

const hal::Catalog& with_whistles() {
  static const hal::Catalog all = [] {
    hal::Catalog made = test::catalog();
    const hal::Status good = made.add_from("test", &register_whistles);
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

/// Three robots that whistle and listen.
Scene whistling(const std::vector<Element::Attribute>& whistle = {}, const std::vector<Element::Attribute>& ear = {}) {
  Scene scene(4.0, "everything");
  scene.robot("a", -0.5, 0.0).robot("b", 0.5, 0.0).robot("c", 0.0, 1.5);
  choose(scene, "body_led", hal::Role::Actuator, "whistling", whistle);
  choose(scene, "microphones", hal::Role::Sensor, "whistles", ear);
  return scene;
}

float level(const MadeWorld& world, const std::string& id) {
  return reading<hal::Microphones>(world, id).level[0];
}

TEST(MediumOfATest, CarriesWhatItsDevicesPublish) {
  auto world = make(whistling(), {}, with_whistles());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 2);
  EXPECT_EQ(level(world, "a"), 2.0F);
  world->space().remove_robot(world->space().find_robot("c"));
  world->step();
  EXPECT_EQ(level(world, "a"), 1.0F) << "those who are gone are silent";
  ASSERT_TRUE(world->space().add_robot({.id = "d", .controller = "c", .pose = Pose::at(0.0, 1.0, 0.0)}).ok());
  world->step();
  world->step();
  EXPECT_EQ(level(world, "a"), 2.0F);
  EXPECT_EQ(level(world, "d"), 2.0F);
}

TEST(MediumOfATest, GoesOnAfterACheckpointAsBefore) {
  auto world = make(whistling(), {}, with_whistles());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 3);
  const auto moment = world->snapshot();
  ASSERT_TRUE(moment.ok());
  const auto goes_on = [&] {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 3; ++i) {
      world->step();
      hashes.push_back(world->state_hash());
    }
    return hashes;
  };
  const auto first = goes_on();
  for (int i = 0; i < 40; ++i) {  // more than one block: rows that the moment does not have
    ASSERT_TRUE(
        world->space()
            .add_robot({.id = "n" + std::to_string(i), .controller = "c", .pose = Pose::at(-1.9 + 0.09 * i, -1.0, 0.0)})
            .ok());
  }
  world->step();
  EXPECT_GT(level(world, "a"), 2.0F);
  ASSERT_TRUE(world->restore(moment.value()).ok());
  EXPECT_EQ(goes_on(), first);
  EXPECT_EQ(level(world, "a"), 2.0F);
}

TEST(MediumOfATest, IsOfTheChannelsThatFilesName) {
  Scene scene = whistling({{"medium", "low", 0}}, {{"medium", "high", 0}});
  scene.scenario.media = {{"whistle", "low", {}, 0}, {"whistle", "high", {}, 0}};
  auto world = make(scene, {}, with_whistles());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 2);
  EXPECT_EQ(level(world, "a"), 0.0F);
  choose(scene, "microphones", hal::Role::Sensor, "whistles", {{"medium", "low", 0}});
  auto same = make(scene, {}, with_whistles());
  run(*same.world, 2);
  EXPECT_EQ(level(same, "a"), 2.0F);
}

TEST(MediumOfATest, IsReadFromFilesWithItsOwnAttributes) {
  const auto read = [](const std::string& media, Problems& problems) {
    return read_experiment_text(
        "<tandem>\n<framework><experiment length=\"1\"/></framework>\n<arena size=\"4,4,1\"/>\n" + media +
            "\n</tandem>",
        "file", {}, with_whistles(), problems);
  };
  Problems problems;
  const auto good = read(R"(<media><whistle id="loud" loudness="3"/></media>)", problems);
  ASSERT_TRUE(good.has_value()) << to_text(problems.at(0));
  Scene scene = whistling({{"medium", "loud", 0}}, {{"medium", "loud", 0}});
  scene.scenario.media = good->media;
  auto world = make(scene, {}, with_whistles());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 2);
  EXPECT_EQ(level(world, "a"), 6.0F) << "what the medium says holds for the devices that name it";
  choose(scene, "microphones", hal::Role::Sensor, "whistles", {{"medium", "loud", 0}, {"loudness", "0.5", 0}});
  auto softer = make(scene, {}, with_whistles());
  run(*softer.world, 2);
  EXPECT_EQ(level(softer, "a"), 1.0F) << "unless these say otherwise";

  const auto problem_of = [&](const std::string& media) {
    Problems found;
    EXPECT_FALSE(read(media, found).has_value());
    return found.empty() ? "" : to_text(found[0]);
  };
  EXPECT_THAT(problem_of(R"(<media><whistle id="a" loudness="11"/></media>)"),
              HasSubstr("file:4: error: <whistle loudness>"));
  EXPECT_THAT(problem_of(R"(<media><whistle id="a" pitch="1"/></media>)"), HasSubstr("has no attribute 'pitch'"));
  EXPECT_THAT(problem_of(R"(<media><whistel id="a"/></media>)"),
              HasSubstr("file:4: error: <media> cannot hold <whistel>; it may hold: led, range_and_bearing, "));
  EXPECT_THAT(problem_of("<media><whistle id=\"a\"/>\n<led id=\"a\"/></media>"),
              HasSubstr("file:5: error: <led id>: a second medium 'a'; the first is on line 4"));
}

// --- names ---

TEST(Media, ThatAreNotThereAreErrorsOfTheDevicesThatNameThem) {
  Scene scene = whistling({{"medium", "lo", 0}});
  scene.scenario.media = {{"whistle", "low", {}, 0}, {"led", "lo", {}, 0}};
  const auto world = make(scene, {}, with_whistles());
  EXPECT_FALSE(world.world);
  EXPECT_THAT(
      world.all_problems(),
      HasSubstr("scene:11: error: <body_led medium>: <media> has no <whistle> with id 'lo'; it has: low. Did you "
                "mean 'low'?"));
}

TEST(Media, OfNoRegisteredKindAreErrorsOfTheirDevices) {
  hal::Catalog catalog = test::catalog();
  ASSERT_TRUE(catalog.add_from("half", &register_whistling).ok());
  const auto world = make(whistling(), {}, catalog);
  EXPECT_FALSE(world.world);
  EXPECT_THAT(world.all_problems(),
              HasSubstr("scene:11: error: device 'body_led': there is no medium 'whistle' to work "
                        "in; there are: led, range_and_bearing"));
}

// --- range-and-bearing ---

TEST(RangeAndBearingMedia, AreNotHeardByBoardsOfOthers) {
  for (const auto& [sends, hears, count] : {std::tuple{"x", "x", 2U}, {"x", "y", 0U}, {"x", "", 2U}, {"", "y", 2U}}) {
    Scene scene(4.0, "everything");
    scene.robot("a", -0.3, 0.0).robot("b", 0.3, 0.0).robot("c", 0.0, 0.4);
    scene.scenario.media = {{"range_and_bearing", "x", {}, 0}, {"range_and_bearing", "y", {}, 0}};
    choose(scene, "range_and_bearing", hal::Role::Actuator, "default", {{"medium", sends, 0}});
    choose(scene, "range_and_bearing", hal::Role::Sensor, "default", {{"medium", hears, 0}});
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    run(*world.world, 2);
    EXPECT_EQ(reading<hal::RangeAndBearing>(world, "a").count, count) << sends << " to " << hears;
  }
}

TEST(RangeAndBearingMedia, SayWhetherBodiesAndBoxesBlockMessages) {
  for (const char* blocks : {"true", "false"}) {
    Scene scene(4.0, "everything");
    scene.robot("a", -0.3, 0.0).robot("b", 0.3, 0.0).box(0.0, 0.0, 0.1, 0.4);
    Element said;
    said.attributes = {{"check_occlusions", blocks, 0}};
    scene.scenario.media = {{"range_and_bearing", "x", said, 0}};
    choose(scene, "range_and_bearing", hal::Role::Sensor, "default", {{"medium", "x", 0}});
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    run(*world.world, 2);
    EXPECT_EQ(reading<hal::RangeAndBearing>(world, "a").count, blocks == std::string("true") ? 0U : 1U);
    EXPECT_EQ(*world->scenario().controllers[0].sensors[8].options.attribute("check_occlusions"), blocks);
  }
}

// --- rows ---

TEST(RowMedium, HasRowsFromTheFirstThatPublishesToTheLast) {
  Space space;
  WhistleMedium medium;
  for (const char* id : {"a", "b", "c", "d"}) add_robot(space, hal::epuck::kind(), id, 0.0, 0.0, 0.0);
  SpaceStores& s = space.stores();
  s.groups[1].media = {{&medium, true, false}};
  s.groups[2].media = {{&medium, true, false}};
  medium.fit(s);
  EXPECT_TRUE(medium.silent()) << "nobody listens";
  EXPECT_EQ(medium.publish(s.blocks[1]), nullptr);
  s.groups[3].media = {{&medium, false, true}};
  medium.fit(s);
  EXPECT_FALSE(medium.silent());
  *medium.publish(s.blocks[1]) = {0.5F, 0};
  *medium.publish(s.blocks[2]) = {0.25F, 0};
  for (const auto& [row, loudness] : {std::pair{0U, 0.0F}, {1U, 0.5F}, {2U, 0.25F}, {3U, 0.0F}})
    EXPECT_EQ(medium.of(row).loudness, loudness);
  medium.fit(s);
  EXPECT_EQ(medium.of(1).loudness, 0.0F) << "silent until somebody publishes again";
}

}  // namespace
}  // namespace tandem::core
