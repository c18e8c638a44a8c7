// The reader of foot-bots' maps, fed with anything, and what it accepts wired to modules that fit it.
//
// An input is a recipe: its first byte says whether the rest is the text itself; else a good map is spoilt again and
// again (values replaced by nasty ones, elements doubled, dropped, cut). The promises: no crash, an error is said
// exactly when there is no map, and a map that was accepted reads and writes within its variables.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/footbot/map_file.hpp"
#include "bridges/footbot/words.hpp"

namespace {

using namespace tandem;
using bridges::footbot::FieldMap;
using bridges::footbot::FootbotMap;

constexpr std::string_view kMap =
    R"(<footbot_map profile="p" refresh="500 ms"><node names="left motor|wheel" id="1" needed="always">
<variable names="speed|v" words="1" verify="true"><write port="differential_steering" field="left" scale="0.41 cm/s" least="-72" most="72" rest="0"/></variable>
<variable names="odo" words="4" period="1 s" optional="true"><read port="wheel_encoders" field="left" form="int32" word="1" scale="1 mm" accumulate="true" rate="left_speed" fastest="60 cm"/></variable></node>
<node names="prox"><variable names="bumpers" words="24"><read port="proximity" field="distance" word="23" word_step="-1" element="0" element_step="1" count="24" min="0 m" max="10 cm"><knot raw="0" value="10 cm"/><knot raw="4096" value="0 m"/><special raw="-1" value="5 cm"/></read></variable></node>
<node names="rab" needed="never"><variable names="tx" words="5"><write port="range_and_bearing" field="payload" form="bytes" count="10" when="sending"/></variable>
<event number="3" words="8" port="range_and_bearing"><value field="range" word="0" scale="1 mm"/><value field="bearing" word="1" scale="0.01 deg"/><value field="payload" word="3" form="bytes" count="10"/></event></node></footbot_map>)";

constexpr std::array<std::string_view, 24> kNasty = {
    "",      "-1",     "0",    "1",   "nan",  "inf",      "1e308",      "99999999999999999999",
    "65536", "-32769", "1000", "|",   "a||b", "bytes",    "5 s",        "24",
    "int32", "leds",   "left", "rgb", "&lt;", "\xC3\xFF", "2147483647", "-256"};

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
    return {reinterpret_cast<const char*>(part.data()), part.size()};
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void spoil(std::string& text, Recipe& recipe) {
  const std::size_t op = recipe.next() % 6;
  const std::size_t at = recipe.next_below(text.size());
  const std::size_t value = text.find("=\"", at);
  const std::size_t value_end = value == std::string::npos ? value : text.find('"', value + 2);
  const std::size_t leaf_end = text.find("/>", at);
  const std::size_t leaf = leaf_end == std::string::npos ? leaf_end : text.rfind('<', leaf_end);
  if (op < 3 && value_end != std::string::npos) {
    text.replace(value + 2, value_end - value - 2, kNasty[recipe.next() % kNasty.size()]);
  } else if (op == 3 && leaf != std::string::npos) {
    text.insert(leaf, text.substr(leaf, leaf_end + 2 - leaf));
  } else if (op == 4 && leaf != std::string::npos) {
    text.erase(leaf, leaf_end + 2 - leaf);
  } else if (!text.empty()) {
    text[at] = static_cast<char>(recipe.next());
  }
}

void use(const FieldMap& f, std::span<std::int16_t> words) {
  for (std::size_t i = 0; i < f.count; ++i) {
    for (const std::int32_t raw : {0, 1, -1, 32767, -32768, 4096}) {
      bridges::footbot::set_raw_number(f, words, i, raw);
      const double value = bridges::footbot::to_value(f, bridges::footbot::raw_number(f, words, i));
      expect(!std::isnan(value) || !std::isfinite(f.scale * 65535.0) || !std::isfinite(f.offset));
    }
    const std::int32_t raw = bridges::footbot::to_raw(f, 0.37);
    expect(raw == f.rest || (raw >= f.least && raw <= f.most) || raw == bridges::footbot::largest(f.form) ||
           raw == bridges::footbot::smallest(f.form));
    const auto element = static_cast<std::ptrdiff_t>(f.element) + static_cast<std::ptrdiff_t>(i) * f.element_step;
    expect(element >= 0 && element < static_cast<std::ptrdiff_t>(f.field->count));
  }
}

void use(const FootbotMap& map) {
  expect(!map.nodes.empty());
  for (const auto& node : map.nodes) {
    expect(!node.names.empty());
    for (const auto& v : node.variables) {
      std::vector<std::int16_t> words(v.words);
      for (const FieldMap& f : v.reads) use(f, words);
      for (const FieldMap& f : v.writes) use(f, words);
    }
    for (const auto& packet : node.packets) {
      std::vector<std::int16_t> words(packet.words);
      for (const FieldMap* f : {&packet.range, &packet.bearing, &packet.elevation, &packet.payload}) {
        if (f->count > 0) use(*f, words);
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Recipe recipe({data, size});
  const bool raw = recipe.next() % 16 == 0;
  std::string text(raw ? recipe.rest() : kMap);
  for (int i = 0; i < 8 && !raw && !recipe.done(); ++i) spoil(text, recipe);
  hal::Problems problems;
  const auto map = bridges::footbot::read_footbot_map_text(text, "map.xml", problems);
  expect(map.has_value() != hal::has_errors(problems));
  for (const hal::Problem& p : problems) expect(!p.message.empty() && p.file == "map.xml");
  if (map) use(*map);
  return 0;
}
