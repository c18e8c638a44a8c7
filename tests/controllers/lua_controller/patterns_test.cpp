// string.find, match, gmatch and gsub, against Lua's own library: the same results and messages for texts and patterns
// that are made up.
#include <gtest/gtest.h>
#include <lua.hpp>
#include <memory>
#include <random>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

/// A text as Lua reads it.
std::string quoted(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    const std::string digits = std::to_string(code);
    all += "\\" + std::string(3 - digits.size(), '0') + digits;
  }
  return all + "\"";
}

class MadeUp {
 public:
  explicit MadeUp(unsigned seed) : random_(seed) {}

  std::string text() {
    std::string all;
    for (std::size_t left = below(14); left > 0; --left) all += "aab1 .-%]^(\n\tZ_\xE9"[below(16)];
    if (below(9) == 0) all += '\0';
    return all;
  }
  std::string pattern() {
    static const std::vector<std::string> kParts = {
        "a",  "b",   ".",    "%a",   "%d",    "%s",    "%w",   "%p",     "%u",     "%l",      "%x",     "%c",     "%g",
        "%A", "%%",  "[ab]", "[^a]", "[a-z]", "[%a_]", "[]]",  "[^]]",   "[%]]",   "[a-]",    "[a%-z]", "(",      ")",
        "()", "(a)", "(.-)", "%1",   "%2",    "%b()",  "%bab", "%f[%a]", "%f[%z]", "%f[^%w]", "^",      "$",      "-",
        "*",  "+",   "?",    "%",    "[",     "[a",    "%b",   "%f",     "1",      " ",       "\n",     "[%d%s]", "%S"};
    std::string all = below(6) == 0 ? "^" : "";
    for (std::size_t left = below(7); left > 0; --left) {
      all += kParts[below(kParts.size())];
      if (below(3) == 0) all += "*+-?"[below(4)];
    }
    return below(8) == 0 ? all + "$" : all;
  }
  std::string call() {
    const std::string given = quoted(text()) + ", " + quoted(pattern());
    const std::string from = below(3) == 0 ? ", " + std::to_string(static_cast<int>(below(24)) - 8) : "";
    switch (below(5)) {
      case 0:
        return "find, " + given + from;
      case 1:
        return "find, " + given + ", 1, " + (below(2) == 0 ? "true" : "false");
      case 2:
        return "match, " + given + from;
      case 3:
        return "all, " + given + from;
      default:
        break;
    }
    static const std::vector<std::string> kReplacements = {"'<%0>'",
                                                           "'%1'",
                                                           "'%2'",
                                                           "'%%'",
                                                           "'%x'",
                                                           "'%'",
                                                           "''",
                                                           "5",
                                                           "{a = 'A', aa = false, b = 7}",
                                                           "{a = {}}",
                                                           "function(x, y) return y or x end",
                                                           "function() return nil end",
                                                           "string.upper",
                                                           "true"};
    return "gsub, " + given + ", " + kReplacements[below(kReplacements.size())] +
           (below(3) == 0 ? ", " + std::to_string(static_cast<int>(below(4)) - 1) : "");
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  std::mt19937 random_;
};

const std::string kTell = R"lua(
  local find, match, gsub = string.find, string.match, string.gsub
  local function all(text, pattern, from)
    local found = {}
    for a, b in string.gmatch(text, pattern, from) do found[#found + 1] = tostring(a) .. "," .. tostring(b) end
    return table.concat(found, ";")
  end
  local function tell(...)
    local got = table.pack(pcall(...))
    if not got[1] then got[2] = got[2]:match(":%d+: (.*)") or got[2] end  -- where it stands differs
    for i = 1, got.n do got[i] = math.type(got[i]) == "integer" and "#" .. got[i] or tostring(got[i]) end
    return table.concat(got, "|")
  end
)lua";

TEST(LuaPatterns, DoWhatLuasOwnLibraryDoes) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> reference(luaL_newstate(), &lua_close);
  lua_State* const L = reference.get();
  luaL_openlibs(L);
  MadeUp made_up(20);
  for (int round = 0; round < 40; ++round) {
    std::string calls, checks;
    for (int i = 0; i < 100; ++i) {
      const std::string call = made_up.call();
      calls = kTell + "return tell(" + call + ")";
      ASSERT_EQ(luaL_dostring(L, calls.c_str()), LUA_OK) << lua_tostring(L, -1);
      std::size_t size = 0;
      const char* const expected = lua_tolstring(L, -1, &size);
      checks += "check(" + quoted({expected, size}) + ", " + quoted(call) + ", " + call + ")\n";
      lua_settop(L, 0);
    }
    Scripted world({.text = kTell + R"(
        local function check(expected, what, ...)
          local got = tell(...)
          if got ~= expected then error(what .. " is not " .. expected .. " but " .. got) end
        end
        function step()
        )" + checks + " end"});
    world.run(1);
  }
}

}  // namespace
}  // namespace tandem::test
