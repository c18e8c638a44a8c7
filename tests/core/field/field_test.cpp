// Fields: those that there are, and two that this file defines, with the sensors that ask for them.
#include "core/space/field.hpp"

#include <gmock/gmock.h>

#include "core/config/reader.hpp"
#include "core/device/describe.hpp"
#include "core/device/field_ring.hpp"
#include "core/field/floor/floor.hpp"
#include "core/scenario/field_type.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/ring_sensors.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

// --- fields of its own: a temperature that rises towards the east, and a scent that hooks lay out ---

struct Climate {
  double middle = 20.0, per_m = 1.0;
  void describe(hal::ParamVisitor& v) {
    v.number("middle", middle, hal::unit::none, hal::kAny, "Temperature at the origin.");
    v.number("per_meter", per_m, hal::unit::none, hal::kAny, "How it rises towards the east.");
  }
};

class Temperature final : public PointField<Temperature> {
 public:
  explicit Temperature(const Climate& climate) : climate_(climate) {}
  double at(const SpaceStores& /*stores*/, double x_m, double /*y_m*/, double /*z_m*/) const noexcept override {
    return climate_.middle + climate_.per_m * x_m;
  }

 private:
  Climate climate_;
};

/// Microphones that read temperatures.
class Thermometers final : public Sensor {
 public:
  Thermometers(const Field& field, std::span<const hal::Mount> mounts) : ring_(field, mounts) {}
  void sense(const DeviceContext& context, void* ports) noexcept override {
    ring_.sample(context, [&](std::size_t i, const double* values) {
      hal::Microphones& port = static_cast<hal::Microphones*>(ports)[i];
      stamp(context, port);
      port.count = static_cast<std::uint32_t>(ring_.size());
      for (std::size_t k = 0; k < ring_.size(); ++k) port.level[k] = static_cast<float>(values[k]);
    });
  }

 private:
  FieldRing ring_;
};

constexpr hal::Mount kNose{0.0, 0.1, 0.0, 0.05};  // 10 cm ahead

struct NoOptionsAtAll {
  void describe(hal::ParamVisitor&) {}
};

template <const char* kField>
BlockFactory<Sensor> make_thermometers(const Element& element, Problems& problems, const DeviceSetup& setup) {
  (void)read_options<NoOptionsAtAll>(element, problems);
  const Field* const field = setup.field(kField, element, problems);
  return [field](const BlockColumns&) {
    return std::make_unique<Thermometers>(*field, std::span<const hal::Mount>(&kNose, 1));
  };
}

constexpr char kTemperature[] = "temperature";
constexpr char kScent[] = "scent";

template <const char* kField>
DeviceType nose(std::string_view implementation) {
  return sensor_type(
      "microphones", implementation, "A value at the nose.", [](const auto&) { return true; },
      &make_thermometers<kField>, &describe_options<NoOptionsAtAll>);
}

void register_sensors(hal::Registrar& registrar) {
  static const DeviceType kWarm = nose<kTemperature>("thermometers");
  static const DeviceType kSmell = nose<kScent>("noses");
  registrar.add(kWarm);
  registrar.add(kSmell);
}

void register_weather(hal::Registrar& registrar) {
  static constexpr FieldType kWarmth{
      kTemperature, "How warm it is.", [](hal::ParamVisitor& v) { Climate{}.describe(v); },
      [](const Element& element, const FieldArea&, Problems& problems) -> std::unique_ptr<Field> {
        return std::make_unique<Temperature>(read_settings<Climate>(element, problems));
      }};
  static constexpr FieldType kTrail{
      kScent, "What hooks lay out.", nullptr,
      [](const Element&, const FieldArea& a, Problems&) -> std::unique_ptr<Field> {
        return std::make_unique<FloorField>(RasterArea{a.min_x_m, a.min_y_m, a.size_x_m, a.size_y_m}, 20.0);
      }};
  registrar.add(kWarmth);
  registrar.add(kTrail);
  register_sensors(registrar);
}

const hal::Catalog& with_weather() {
  static const hal::Catalog all = [] {
    hal::Catalog made = test::catalog();
    const hal::Status good = made.add_from("test", &register_weather);
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

Scene measuring(const std::string& implementation) {
  Scene scene(4.0, "everything");
  scene.robot("east", 1.0, 0.0).robot("west", -1.0, 0.0, std::numbers::pi);
  choose(scene, "microphones", hal::Role::Sensor, implementation);
  HookConfig hook;
  hook.library = "test_hooks";
  hook.label = "painter";
  hook.options.name = "loop_functions";
  hook.options.attributes = {{"field", kScent, 0}, {"x", "1", 0}, {"shade", "0.2", 0}};
  scene.scenario.hooks.push_back(hook);
  return scene;
}

double level(const MadeWorld& world, const std::string& id) {
  return static_cast<double>(reading<hal::Microphones>(world, id).level[0]);
}

TEST(FieldOfATest, IsSensedWithNothingElseThatKnowsIt) {
  auto world = make(measuring("thermometers"), {}, with_weather());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 1);
  EXPECT_NEAR(level(world, "east"), 21.1, 1e-5);
  EXPECT_NEAR(level(world, "west"), 18.9, 1e-5);
  EXPECT_DOUBLE_EQ(world->space().field(kTemperature, 0.5, 0.0).value(), 20.5);
  EXPECT_THAT(world->space().field("temprature", 0, 0).error().message,
              HasSubstr("there is no field 'temprature'; there are: floor, light, sound, temperature, scent. Did you "
                        "mean 'temperature'?"));
}

TEST(FieldOfATest, IsReadFromItsElement) {
  const auto read = [](const std::string& things, Problems& problems) {
    return read_experiment_text(
        "<tandem>\n<framework><experiment length=\"1\"/></framework>\n<arena size=\"4,4,1\">\n" + things +
            "</arena></tandem>",
        "file", {}, with_weather(), problems);
  };
  Problems problems;
  const auto good = read(R"(<temperature middle="30" per_meter="-2"/>)", problems);
  ASSERT_TRUE(good.has_value()) << to_text(problems.at(0));
  Scene scene = measuring("thermometers");
  scene.scenario.fields = good->fields;
  auto world = make(scene, {}, with_weather());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 1);
  EXPECT_NEAR(level(world, "east"), 27.8, 1e-5);
  EXPECT_THAT(effective_settings(*good), HasSubstr("<temperature middle=\"30\" per_meter=\"-2\"/>"));

  const auto problem_of = [&](const std::string& things) {
    Problems found;
    EXPECT_FALSE(read(things, found).has_value());
    return found.empty() ? "" : to_text(found[0]);
  };
  EXPECT_THAT(problem_of(R"(<temperature middle="warm"/>)"), HasSubstr("file:4: error: <temperature middle>"));
  EXPECT_THAT(problem_of(R"(<temperature mean="3"/>)"), HasSubstr("has no attribute 'mean'"));
  EXPECT_THAT(problem_of("<temperature/>\n<temperature/>"),
              HasSubstr("file:5: error: a second <temperature>; the first is on line 4"));
  EXPECT_THAT(problem_of("<temperatur/>"),
              HasSubstr("file:4: error: <arena> cannot hold <temperatur>; it may hold: floor, temperature, box"));
  EXPECT_THAT(problem_of("<scent/>"), HasSubstr("<arena> cannot hold <scent>")) << "files say nothing of it";
}

TEST(FieldOfATest, IsPaintedByHooksAndGoesBackWithTheRun) {
  auto world = make(measuring("noses"), {}, with_weather());
  ASSERT_TRUE(world.world) << world.all_problems();
  const auto fresh = world->snapshot();
  ASSERT_TRUE(fresh.ok());
  run(*world.world, 1);
  EXPECT_NEAR(level(world, "east"), 0.2, 1e-2);
  EXPECT_NEAR(level(world, "west"), 0.5, 1e-2) << "nobody painted there";
  EXPECT_EQ(world->space().floor(1.0, 0.0), 0.5) << "the floor is another field";
  const std::uint64_t painted = world->state_hash();
  ASSERT_TRUE(world->restore(fresh.value()).ok());
  EXPECT_EQ(world->space().field(kScent, 1.0, 0.0).value(), 0.5) << "not painted yet";
  EXPECT_NE(world->state_hash(), painted);
  world->step();
  EXPECT_EQ(world->state_hash(), painted);
  ASSERT_TRUE(world->reset(world->seed()).ok());
  EXPECT_EQ(world->space().field(kScent, 1.0, 0.0).value(), 0.5) << "a new run begins unpainted";
  world->step();
  EXPECT_EQ(world->state_hash(), painted);
  EXPECT_TRUE(world->space().repaint(kScent).ok());
  EXPECT_NE(world->state_hash(), painted) << "it is to be painted anew";
  EXPECT_FALSE(world->space().repaint("sent").ok());
}

TEST(FieldOfATest, ThatNobodyRegisteredIsAnErrorOfItsSensor) {
  hal::Catalog catalog = test::catalog();
  ASSERT_TRUE(catalog.add_from("half", &register_sensors).ok());
  const auto world = make(measuring("thermometers"), {}, catalog);
  EXPECT_FALSE(world.world);
  EXPECT_THAT(world.all_problems(), HasSubstr("scene:11: error: <microphones> senses the field 'temperature', which is "
                                              "not there; there are: floor, light, sound"));
}

// --- those of the program ---

TEST(Floor, NeedsItsPicture) {
  for (const auto& [attributes, problem] : std::vector<std::pair<std::vector<Element::Attribute>, std::string>>{
           {{{"source", "image", 5}}, "scene:5: error: <floor> with source=\"image\" needs the attribute 'path'"},
           {{{"source", "image", 5}, {"path", "/no/such.png", 5}},
            "scene:5: error: <floor> image '/no/such.png': there is no such file"},
           {{{"source", "loop_functions", 5}},
            "scene:5: error: the floor is to be painted by loop functions, but there are none"}}) {
    Scene scene;
    scene.robot("a", 0, 0).field("floor", attributes);
    const auto world = make(scene);
    EXPECT_FALSE(world.world);
    EXPECT_THAT(world.all_problems(), HasSubstr(problem));
  }
}

TEST(Floor, OfArgosFilesIsWhiteWithoutLoopFunctions) {
  Scene scene;
  scene.robot("a", 0, 0).field("floor", {{"source", "loop_functions", 5}});
  scene.scenario.fields.back().argos = true;
  const auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world.world->step();
  EXPECT_EQ(world.world->space().floor(0.3, 0.1), 1.0);
}

TEST(Fields, SayWhatIsAtAPoint) {
  Scene scene;
  scene.robot("a", 1.5, 1.5).box(-0.5, 0.0, 0.1, 1.0);
  scene.scenario.lights.push_back({"lamp", {0.0, 0.0, 0.2}, {255, 255, 255}, 1.0, std::nullopt, 0, ""});
  scene.scenario.sounds.push_back({"horn", {0.0, 0.0, 0.0}, 0.8, 0});
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  const Space& space = world->space();
  EXPECT_NEAR(space.field("light", 2.0, 0.0, 0.2).value(), 0.25, 1e-6);
  EXPECT_EQ(space.field("light", -1.0, 0.0, 0.2).value(), 0.0) << "in the shadow of the box";
  EXPECT_NEAR(space.field("sound", 0.1, 0.0).value(), 0.4, 1e-12);
  EXPECT_EQ(space.field("floor", 0.1, 0.0).value(), 0.5);
}

}  // namespace
}  // namespace tandem::core
