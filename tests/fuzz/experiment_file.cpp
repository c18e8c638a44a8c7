// The reader of experiment files, fed with anything.
//
// An input is a recipe: its first byte chooses a small experiment, or says that the rest is the text itself; then
// follow operations that spoil the text (cut, repeat, nest, replace values and names by nasty ones). Most stay
// well-formed XML, so that they reach the schema. The promises: no crash, no hang, an error is said exactly when there
// is no scenario, and effective settings read back without an error.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "core/config/reader.hpp"
#include "tests/core/config/names.hpp"

namespace {

using namespace tandem::core;

constexpr std::array<std::string_view, 9> kExperiments = {
    R"(<tandem><framework><system threads="2"/><experiment length="10" ticks_per_second="10" random_seed="1"/><time mode="fast"/></framework>
<arena size="4,4,1"/></tandem>)",
    R"(<argos-configuration><framework><experiment/></framework><controllers><c id="c" library="l"><actuators><leds medium="l"/></actuators>
<sensors><epuck_proximity noise_level="0.1"/><range_and_bearing medium="r"/></sensors><params a="1"/></c></controllers><arena size="4,4,1"/>
<media><led id="l"/><range_and_bearing id="r"/></media></argos-configuration>)",
    R"(<tandem><framework><experiment/></framework><controllers><c id="c" library="l"/></controllers><arena size="4,4,1" escape="stop">
<e-puck id="e1"><body position="0,0,0" orientation="90,0,0"/><controller config="c"><params/></controller><battery/><bridge link="x"/><tracker/></e-puck>
<box id="b" size="1,1,1"><body position="1,1,0"/></box><cylinder id="y" radius="10 cm" height="1"><body position="1,1,0"/></cylinder></arena></tandem>)",
    R"(<tandem><framework><experiment/></framework><controllers><c id="c" library="l"/></controllers><arena size="4,4,1"><distribute>
<position method="uniform" min="0,0,0" max="1,1,0"/><orientation method="gaussian" mean="0,0,0" std_dev="1,0,0"/><entity quantity="20" base_num="5">
<e-puck id="e1"><controller config="c"/></e-puck></entity></distribute><e-puck id="e14"><body position="0,0,0"/><controller config="c"/></e-puck>
</arena></tandem>)",
    R"(<tandem><framework><experiment/></framework><arena size="4,4,1"><light id="l" position="0,0,1" color="1,2,3"/><sound id="s" position="0,0,0"/>
<floor source="image" path="p"/><distribute><position method="grid" center="0,0,0" distances="1,1,1" layout="2,2,1"/><orientation method="constant"
values="0,0,0"/><entity quantity="4"><box id="b" size="1,1,1"/></entity></distribute></arena></tandem>)",
    R"(<tandem><framework><experiment/></framework><arena size="4,4,1"/><physics_engines><kinematics2d id="a" regions="2x2"><boundaries><top height="1"/>
<bottom height="0"/><sides><vertex point="0,0" gate="b"/><vertex point="1,0"/><vertex point="1,1"/></sides></boundaries></kinematics2d><kinematics2d id="b"/>
</physics_engines><loop_functions library="l" label="x"><y/></loop_functions><record><trajectory path="p" entities="a*,b"/></record>
<visualization><qt-opengl><camera/></qt-opengl></visualization></tandem>)",
    R"(<tandem><kinds><kind name="crab" summary="s"><body radius="0.1" height="0.1" mass="1"/><differential_drive wheel_radius="0.02" wheel_base="0.1"
max_speed="0.3" force="1" torque="1"/><proximity range="0.1"><mount bearing="90" radius="0.1" count="8"/><mount x="1"/><response distance="0" counts="9"/>
<response distance="1" counts="1"/></proximity><leds beacon="true"><spread sin_lowest="-1"/><mount count="3"/></leds><battery full="4" empty="3"/></kind></kinds>
<framework><experiment/></framework><controllers><c id="c" library="l"/></controllers><arena size="4,4,1"><crab id="c0"><body position="0,0,0"/>
<controller config="c"/></crab></arena></tandem>)",
    R"(<tandem><kinds><kind name="a" like="b" without="leds"/><kind name="b" like="c"/><kind name="c" like="e-puck" bridge="e-puck"/><kind name="d" like="eye-bot"><body mass="2"/></kind>
<kind name="e" like="foot-bot" without="turret gripper differential_drive"><distance_scanner><head min="0" max="1"/></distance_scanner></kind></kinds>
<framework><experiment/></framework><controllers><c id="c" library="l"/></controllers><arena size="4,4,1"><a id="c0" rab_range="1"><body position="0,0,0"/>
<controller config="c"/><bridge link="x"/></a></arena></tandem>)",
    R"(<tandem><kinds file="fuzz.xml"/><kinds file="."/><kinds><kinds file="nowhere.xml"/><kinds version="1"><kind name="q"><quadrotor max_speed="1"/></kind></kinds></kinds>
<framework><experiment/></framework><arena size="4,4,1"/></tandem>)"};

constexpr std::array<std::string_view, 24> kNasty = {
    "",    "-1",      "0",         "nan",         "inf",       "1e308",    "-1e-320",      "99999999999999999999",
    "1,2", "1,2,3,4", ",,",        "1e9,1e9,1e9", "5 cm",      "5 parsec", "true",         "uniform",
    "c",   "e1",      "&lt;&amp;", "[0]",         "100000000", "4x4",      "\xC3\xA4\xFF", "0x10"};

constexpr std::array<std::string_view, 15> kPieces = {"<box/>",
                                                      "<kind name=\"c\" like=\"a\"/>",
                                                      "<light><mount count=\"30\"/></light>",
                                                      "<quadrotor/>",
                                                      "<e-puck id=\"e1\"/>",
                                                      "<distribute>",
                                                      "</distribute>",
                                                      "<!--",
                                                      "-->",
                                                      "<![CDATA[x]]>",
                                                      "text",
                                                      "<entity quantity=\"1\"/>",
                                                      " id=\"b\"",
                                                      "/>",
                                                      "<body position=\"0,0,0\"/>"};

constexpr std::array<std::string_view, 7> kPaths = {
    "kinds.kind[0].body.radius=",

    "framework.experiment.length=", "arena.distribute[0].entity.quantity=",
    "arena.box[b].size=",           "controllers.c[c].params.a=",
    "framework.system.threads=",    "arena."};

const tandem::hal::Catalog kKnown = known_names();

void expect(bool condition) {
  if (!condition) std::abort();
}

class Recipe {
 public:
  explicit Recipe(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool done() const { return at_ >= bytes_.size(); }
  std::size_t next() { return done() ? 0 : bytes_[at_++]; }
  std::size_t next_below(std::size_t n) { return n == 0 ? 0 : (next() * 256 + next()) % n; }
  std::string_view rest() {
    const auto part = bytes_.subspan(std::min(at_, bytes_.size()));
    at_ = bytes_.size();
    return {reinterpret_cast<const char*>(part.data()), part.size()};
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// The value of some attribute: the place between two quotes; empty when there is none.
std::pair<std::size_t, std::size_t> some_value(const std::string& text, std::size_t from) {
  const std::size_t first = text.find("=\"", from);
  if (first == std::string::npos) return {0, 0};
  const std::size_t last = text.find('"', first + 2);
  return last == std::string::npos ? std::pair<std::size_t, std::size_t>{0, 0} : std::pair{first + 2, last};
}

/// An element that holds no other: from its '<' to its "/>".
std::pair<std::size_t, std::size_t> some_leaf(const std::string& text, std::size_t from) {
  const std::size_t last = text.find("/>", from);
  const std::size_t first = last == std::string::npos ? last : text.rfind('<', last);
  return first == std::string::npos ? std::pair<std::size_t, std::size_t>{0, 0} : std::pair{first, last + 2};
}

void spoil(std::string& text, Recipe& recipe) {
  const std::size_t op = recipe.next() % 8;
  const std::size_t at = recipe.next_below(text.size());
  const auto [value, value_end] = some_value(text, at);
  const auto [leaf, leaf_end] = some_leaf(text, at);
  switch (op) {
    case 0:
    case 1:
      text.replace(value, value_end - value, kNasty[recipe.next() % kNasty.size()]);
      break;
    case 2:
      text.erase(leaf, leaf_end - leaf);
      break;
    case 3:
      text.insert(leaf, text.substr(leaf, leaf_end - leaf));
      break;
    case 4:
      text.insert(leaf, kPieces[recipe.next() % kPieces.size()]);
      break;
    case 5:
      text[at] = static_cast<char>(recipe.next());
      break;
    case 6:
      text.erase(at, recipe.next() % 16);
      break;
    default: {  // an attribute renamed by one letter
      const std::size_t name = value >= 3 ? value - 3 : 0;
      text[name] = static_cast<char>('a' + recipe.next() % 26);
    }
  }
}

void try_out(const std::string& text, const std::vector<std::string>& overrides, bool read_back) {
  Problems problems;
  const auto scenario = read_experiment_text(text, "fuzz.xml", overrides, kKnown, problems);
  expect(scenario.has_value() != has_errors(problems));
  for (const Problem& p : problems) expect(!p.message.empty() && !p.file.empty());
  if (!scenario) return;
  expect(scenario->ticks_per_second > 0 && scenario->length_s >= 0.0 && !scenario->engines.empty());
  for (const RobotItem& r : scenario->robots) expect(r.controller < scenario->controllers.size());
  if (!read_back) return;
  Problems again;
  expect(read_experiment_text(effective_settings(*scenario), "effective.xml", {}, kKnown, again).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Recipe recipe({data, size});
  const std::size_t start = recipe.next();
  if (start == 255) {
    try_out(std::string(recipe.rest()), {}, false);
    return 0;
  }
  std::string text(kExperiments[start % kExperiments.size()]);
  std::vector<std::string> overrides;
  if (start % 11 == 0) {
    const std::string path(kPaths[recipe.next() % kPaths.size()]);
    overrides.push_back(path + std::string(kNasty[recipe.next() % kNasty.size()]));
  }
  const std::size_t operations = 1 + start / 64;  // up to four
  for (std::size_t i = 0; i < operations && !recipe.done() && !text.empty(); ++i) spoil(text, recipe);
  try_out(text, overrides, start % 8 == 0);
  return 0;
}
