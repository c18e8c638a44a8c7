// A record shows what its run showed: drawings, frames, layers and robots from the inside, tick by tick.
#include "core/record/record_source.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <map>

#include "app/catalog.hpp"
#include "app/experiment/plugins.hpp"
#include "app/outputs/observers.hpp"
#include "core/live/inspection.hpp"
#include "core/record/record.hpp"
#include "core/view/layers/layer_set.hpp"
#include "core/view/layers/segments.hpp"
#include "core/view/picture.hpp"
#include "core/view/povray.hpp"
#include "core/view/record_drawing.hpp"
#include "hal/xml/xml.hpp"
#include "tests/controllers/experiment.hpp"
#include "window/space_frame.hpp"

namespace tandem {
namespace {

constexpr int kTicks = 60, kEvery = 6;
constexpr double kRounded = 3e-6;  // places are kept in micrometres
// These follow from what is in no record, or from the ticks before.
const std::vector<std::string> kNotKept = {"velocity", "measures"};

/// What is shown of one robot in a frame.
struct Shown {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, cos_h = 1.0, sin_h = 0.0;
  std::vector<hal::Rgb> leds;
  std::vector<float> values;  // what moves on it
  bool halted = false;
};

std::map<std::string, Shown> shown_in(const window::Frame& frame) {
  std::map<std::string, Shown> all;
  std::vector<Shown*> in_order;
  const hal::Json& ids = frame.members->json["ids"];
  const std::vector<std::uint32_t>&first = frame.members->first_led, &value = frame.members->first_value;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Shown& one = all[ids[i].get<std::string>()];
    one.x_m = frame.x_m[i];
    one.y_m = frame.y_m[i];
    one.z_m = frame.z_m.empty() ? 0.0 : static_cast<double>(frame.z_m[i]);
    one.cos_h = frame.cos_h[i];
    one.sin_h = frame.sin_h[i];
    one.values.assign(frame.values.begin() + value[i], frame.values.begin() + value[i + 1]);
    if (!frame.leds.empty()) one.leds.assign(frame.leds.begin() + first[i], frame.leds.begin() + first[i + 1]);
    in_order.push_back(&one);
  }
  for (const std::uint32_t i : frame.halted) in_order[i]->halted = true;
  return all;
}

/// What a run or a record shows at one tick.
struct Sight {
  std::string svg, pov;
  window::Frame frame;
  std::map<std::string, std::vector<core::Segment>> layers;
  hal::Json inside;
};

std::vector<std::string> some_robots(const core::Space& space) {
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < std::min<std::size_t>(5, space.robot_count()); ++i)
    ids.push_back(space.robot_name(space.robot(i)));
  return ids;
}

/// Looks at runs and records in the same way.
class Eye {
 public:
  Eye() : layers_(app::catalog()) {
    std::vector<std::string> names;
    for (const core::LayerType* type : layers_.types()) {
      if (std::find(kNotKept.begin(), kNotKept.end(), type->name) == kNotKept.end()) names.emplace_back(type->name);
    }
    EXPECT_TRUE(layers_.switch_on(names).ok());
  }
  void note(const core::Observation& now) { layers_.note(now); }
  Sight look(const core::Observation& now, hal::Tick done) {
    Sight sight;
    frames_.fill(now.space, done, now.ticks_per_second, true, sight.frame);
    for (const core::LayerPicture& picture : layers_.show(now))
      sight.layers[std::string(layers_.types()[picture.layer]->name)] = core::segments_of(picture.sketch);
    sight.inside = core::inspection_of(now.space, done, now.ticks_per_second, some_robots(now.space));
    return sight;
  }

 private:
  core::LayerSet layers_;
  window::SpaceFrames frames_;
};

void expect_same(const std::vector<core::Segment>& run, const std::vector<core::Segment>& record,
                 const std::string& layer) {
  ASSERT_EQ(run.size(), record.size()) << layer;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const core::Segment &a = run[i], &b = record[i];
    for (const auto& [p, q] :
         {std::pair{a.x1, b.x1}, {a.y1, b.y1}, {a.z1, b.z1}, {a.x2, b.x2}, {a.y2, b.y2}, {a.z2, b.z2}})
      ASSERT_NEAR(p, q, 1e-5) << layer;
    ASSERT_EQ((std::array{a.r, a.g, a.b, a.a}), (std::array{b.r, b.g, b.b, b.a})) << layer;
  }
}

/// The same text, and numbers that differ by how they are rounded at most.
void expect_same(const std::string& run, const std::string& record) {
  const char *a = run.c_str(), *b = record.c_str();
  while (*a != 0 && *b != 0) {
    if (*a == '-' || (*a >= '0' && *a <= '9') || *b == '-') {
      char *a_end = nullptr, *b_end = nullptr;
      const double x = std::strtod(a, &a_end), y = std::strtod(b, &b_end);
      if (a_end != a && b_end != b) {
        ASSERT_NEAR(x, y, 2e-4) << std::string(a, 40) << " and " << std::string(b, 40);
        a = a_end;
        b = b_end;
        continue;
      }
    }
    ASSERT_EQ(*a++, *b++) << a << " and " << b;
  }
  ASSERT_EQ(*a, *b);
}

void expect_same(const window::Frame& run, const window::Frame& record) {
  EXPECT_EQ(run.tick, record.tick);
  EXPECT_EQ(run.members->json["bodies"], record.members->json["bodies"]);
  EXPECT_EQ(run.objects.size(), record.objects.size());
  EXPECT_EQ(run.scene->json["objects"].size(), record.scene->json["objects"].size());
  EXPECT_EQ(run.scene->json["borders"], record.scene->json["borders"]);
  EXPECT_EQ(run.scene->json["lights"], record.scene->json["lights"]);
  ASSERT_EQ(run.scene->floor == nullptr, record.scene->floor == nullptr);
  if (run.scene->floor != nullptr) {
    EXPECT_EQ(run.scene->floor->pixels, record.scene->floor->pixels);
  }
  const auto ours = shown_in(run), theirs = shown_in(record);
  ASSERT_EQ(ours.size(), theirs.size());
  for (const auto& [id, one] : ours) {
    ASSERT_TRUE(theirs.contains(id)) << id;
    const Shown& other = theirs.at(id);
    EXPECT_NEAR(one.x_m, other.x_m, kRounded) << id;
    EXPECT_NEAR(one.y_m, other.y_m, kRounded) << id;
    EXPECT_NEAR(one.z_m, other.z_m, kRounded) << id;
    EXPECT_NEAR(one.cos_h, other.cos_h, 1e-8) << id;
    EXPECT_NEAR(one.sin_h, other.sin_h, 1e-8) << id;
    EXPECT_EQ(one.halted, other.halted) << id;
    EXPECT_EQ(one.values, other.values) << id;
    EXPECT_EQ(one.leds, other.leds) << id;
  }
}

/// By port and field.
std::map<std::string, std::string> values_in(const hal::Json& robot) {
  std::map<std::string, std::string> all;
  for (const hal::Json& port : robot["ports"]) {
    const std::string name = port["role"].get<std::string>() + " " + port["name"].get<std::string>();
    for (const hal::Json& field : port["fields"])
      all[name + "." + field["name"].get<std::string>()] =
          hal::to_text(field["values"]) + field["unit"].get<std::string>();
    if (port.contains("validity")) all[name + " is"] = hal::to_text(port["validity"]);
  }
  for (const hal::Json& field : robot["published"])
    all["published " + field["name"].get<std::string>()] = hal::to_text(field["value"]);
  return all;
}

/// Records the run, and looks at both.
/// @param catalog that the record is opened with; null: none
/// @param ports whether it keeps all of them; else nothing is seen from the inside
/// @returns what was seen last of the run
Sight expect_shown(core::World* run, const std::string& path, const hal::Catalog* catalog, bool ports = true) {
  std::vector<std::pair<hal::Tick, Sight>> sights;
  {
    run->start();
    core::RecordConfig config;
    config.path = path;
    config.entities = {"*"};
    if (ports) config.ports = {"*"};
    auto recorder = core::Recorder::open(
        config, run->space(), {{"experiment", "x"}, {"seed", 7U}, {"ticks_per_second", run->ticks_per_second()}});
    EXPECT_TRUE(recorder.ok()) << recorder.error().message;
    Eye eye;
    for (hal::Tick tick = 0; tick < kTicks; ++tick) {
      run->step();
      EXPECT_TRUE(recorder.value()->tick_done(run->space(), tick).ok());
      const core::Observation now = app::observation_of(*run, tick);
      eye.note(now);
      if (tick % kEvery != 0) continue;
      Sight& sight = sights.emplace_back(tick, eye.look(now, tick + 1)).second;
      core::PictureOptions options{"x", 7, hal::time_of_tick(tick + 1, run->ticks_per_second())};
      const core::Drawing drawing = core::drawing_of(run->space(), options);
      sight.svg = core::to_svg(drawing);
      sight.pov = core::to_povray(drawing, {});
    }
    EXPECT_TRUE(recorder.value()->close(kTicks - 1, {{"ended", "length"}}).ok());
  }

  auto opened = core::RecordSource::open(path, catalog);
  EXPECT_TRUE(opened.ok()) << opened.error().message;
  core::RecordSource& record = opened.value();
  Eye eye;
  std::size_t seen = 0, rays = 0, values = 0;
  while (record.next()) {
    const core::Observation now = record.observation();
    eye.note(now);
    if (seen == sights.size() || record.ticks_done() != sights[seen].first + 1) continue;
    SCOPED_TRACE(testing::Message() << "tick " << sights[seen].first);
    const Sight& run_shows = sights[seen++].second;
    const Sight shows = eye.look(now, record.ticks_done());
    const core::Drawing drawing = core::drawing_of(record, {}, nullptr);
    expect_same(run_shows.svg, core::to_svg(drawing));
    expect_same(run_shows.pov, core::to_povray(drawing, {}));
    expect_same(run_shows.frame, shows.frame);
    if (!ports) continue;
    for (const auto& [layer, segments] : run_shows.layers) {
      rays += segments.size();
      expect_same(segments, shows.layers.at(layer), layer);
    }
    for (std::size_t i = 0; i < run_shows.inside["robots"].size(); ++i) {
      const auto in_run = values_in(run_shows.inside["robots"][i]), in_record = values_in(shows.inside["robots"][i]);
      values += in_run.size();
      EXPECT_EQ(in_run, in_record);
      EXPECT_EQ(run_shows.inside["robots"][i]["halted"], shows.inside["robots"][i]["halted"]);
    }
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_EQ(seen, sights.size());
  EXPECT_TRUE(rays > 0 || values > 0 || !ports);
  EXPECT_TRUE(!ports || values > 0);
  std::filesystem::remove(path);
  return std::move(sights.back().second);
}

class RecordSources : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, RecordSources,
                         testing::Values("epuck_diffusion.xml", "footbot_foraging.xml", "eyebot_circle.xml",
                                         "footbot_gripping.xml", "footbot_task_partitioning_noise.xml",
                                         "epuck_push.xml", "khepera4_avoidance.xml", "thymio_cruise.xml"),
                         [](const auto& name) { return name.param.substr(0, name.param.find('.')); });

void expect_what_the_run_shows(const std::string& experiment) {
  const test::Experiment run(experiment, {}, test::seeded(7), "", app::catalog());
  const std::string path = test::temporary(std::filesystem::path(experiment).filename().string() + ".record");
  const auto known = app::kinds_of_settings(hal::to_xml(run->scenario().effective), path);
  expect_shown(run.world.get(), path, &known->catalog);
}

TEST_P(RecordSources, ShowWhatTheRunShows) {
  expect_what_the_run_shows(GetParam());
}

/// A robot of a plug-in of this test alone: a mast that turns, a boom that slides out of it, a hook and two lamps.
TEST(Looks, OfAPlugInAreShownRecordedAndInspected) {
  hal::PluginLoader loader = app::make_loader();
  const std::string file = test::temporary("crane.xml");
  std::ofstream(file) << R"(<tandem version="1">
    <plugins library="test_crane"/>
    <framework><experiment length="10" ticks_per_second="10" random_seed="1"/></framework>
    <controllers><crane_driver id="c" library="test_crane"><actuators><crane/></actuators></crane_driver></controllers>
    <arena size="2,2,1">
      <crane id="a"><body position="0.5,0,0"/><controller config="c"/></crane>
      <crane id="b"><body position="-0.5,0,0" orientation="90,0,0"/><controller config="c"/></crane>
    </arena></tandem>)";
  const auto scenario = app::read_or_complain(loader, {}, file, {});
  std::filesystem::remove(file);
  ASSERT_TRUE(scenario);
  const auto look = [&](const hal::Catalog* catalog, bool ports) {
    core::Problems problems;
    const auto world = core::World::make(*scenario, loader, {}, problems);
    EXPECT_NE(world, nullptr);
    return expect_shown(world.get(), test::temporary("crane.record"), catalog, ports);
  };
  look(nullptr, true);  // whoever has no such plug-in sees the same
  look(nullptr, false);
  const Sight last = look(&loader.catalog(), true);
  // 55 ticks: the mast has turned by 0.01 rad a tick, the boom is out by half of what was commanded.
  EXPECT_NE(last.svg.find("<g class=\"mast\" transform=\"rotate("), std::string::npos) << last.svg;
  EXPECT_NE(last.svg.find("<g class=\"boom\" transform=\"translate(0.0"), std::string::npos);
  EXPECT_NE(last.svg.find("<rect class=\"arm\""), std::string::npos);
  EXPECT_NE(last.svg.find("fill=\"#102030\""), std::string::npos) << "its lamp";
  EXPECT_NE(last.svg.find("fill=\"#ff8800\""), std::string::npos) << "the lamp that is only switched";
  EXPECT_NE(last.pov.find("matrix <"), std::string::npos);
  const auto shown = shown_in(last.frame);
  ASSERT_EQ(shown.at("a").values.size(), 3U);
  EXPECT_GT(shown.at("a").values[0], 0.5F);
  EXPECT_GT(shown.at("a").values[1], 0.1F);
  EXPECT_EQ(shown.at("a").values[2], 1.0F) << "the hook holds something";
  EXPECT_EQ(shown.at("b").leds, (std::vector<hal::Rgb>{{0x10, 0x20, 0x30}, {0xff, 0x88, 0x00}}));
  EXPECT_EQ(last.frame.members->json["bodies"][0]["look"]["joints"].size(), 2U);
  EXPECT_EQ(last.inside["robots"][0]["ports"][0]["name"], "crane");
}

/// `text` with the part from `begin` to `end` twice, the second one with all `from` made `to`.
std::string with_another(std::string text, const std::string& begin, const std::string& end,
                         const std::vector<std::pair<std::string, std::string>>& changes) {
  const std::size_t first = text.find(begin);
  const std::size_t past = text.find(end, first) + end.size();
  std::string other = text.substr(first, past - first);
  for (const auto& [from, to] : changes) other.replace(other.find(from), from.size(), to);
  return text.insert(past, other);
}

TEST(RecordSource, ShowsTheStateOfEachGroupWhereTwoHaveOneController) {
  const std::filesystem::path configs = std::string(test::kSourceDir) + "/configs";
  std::stringstream text;
  text << std::ifstream(configs / "footbot_foraging.xml").rdbuf();
  const std::string file = test::temporary("two_groups.xml");
  std::ofstream(file) << with_another(
      with_another(text.str(), "<footbot_foraging id=", "</footbot_foraging>", {{"\"forage\"", "\"other\""}}),
      "<distribute>", "</distribute>", {{"\"fb\"", "\"other\""}, {"\"forage\"", "\"other\""}});
  expect_what_the_run_shows(std::filesystem::relative(file, configs).string());
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace tandem
