// Scripts that are made up, which change what all robots have, fill memory, never end, and catch what they can.
// Whatever they do: the same bits for any number of threads, and who does nothing of it is not touched.
//
//   TANDEM_LUA_FUZZ=10000 TANDEM_LUA_FUZZ_FIRST=1 build/release/tests/test_controllers_lua --gtest_filter=LuaFuzz.*
#include <cstdlib>
#include <gtest/gtest.h>
#include <lua.hpp>
#include <memory>
#include <random>

#include "tests/controllers/lua_controller/scripted.hpp"

namespace tandem::test {
namespace {

/// Makes up programs from Lua's grammar and from the names of its manual; what they do is nobody's plan.
class Author {
 public:
  explicit Author(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return random_() % n; }

  std::string program() {
    std::string text = "local a, b, c, d = 1, {}, 'x', nil\nG = G or {}\n";
    for (std::size_t left = 2 + below(6); left > 0; --left) text += statement(3);
    return text;
  }

 private:
  template <std::size_t kCount>
  std::string one_of(const char* const (&choices)[kCount]) {
    return choices[below(kCount)];
  }

  std::string library() {
    return one_of({"math",
                   "string",
                   "table",
                   "coroutine",
                   "utf8",
                   "os",
                   "debug",
                   "io",
                   "_G",
                   "robot",
                   "robot.wheels",
                   "robot.random",
                   "robot.sensors",
                   "robot.range_and_bearing",
                   "robot.proximity",
                   "robot.proximity[1]",
                   "robot.params",
                   "getmetatable('')",
                   "getmetatable(vector2())",
                   "_ENV"});
  }
  std::string entry() {
    return one_of({"math.pi",
                   "math.huge",
                   "math.maxinteger",
                   "math.floor",
                   "math.sin",
                   "math.random",
                   "math.type",
                   "string.format",
                   "string.rep",
                   "string.find",
                   "string.gsub",
                   "string.sub",
                   "string.len",
                   "table.insert",
                   "table.concat",
                   "table.unpack",
                   "table.sort",
                   "coroutine.wrap",
                   "coroutine.yield",
                   "utf8.charpattern",
                   "utf8.char",
                   "os.time",
                   "os.clock",
                   "debug.traceback",
                   "print",
                   "pairs",
                   "ipairs",
                   "next",
                   "type",
                   "tostring",
                   "select",
                   "pcall",
                   "error",
                   "setmetatable",
                   "rawget",
                   "robot.id",
                   "robot.wheels.set_velocity",
                   "robot.random.uniform",
                   "robot.random.gaussian",
                   "robot.proximity[2].value",
                   "robot.proximity[1]",
                   "robot.proximity",
                   "robot.wheels",
                   "robot.sensors.clock",
                   "robot.range_and_bearing[1]",
                   "robot.range_and_bearing.set_data",
                   "vector2",
                   "_VERSION"});
  }
  std::string name() {
    return one_of({"pi",           "floor", "sin",    "format",  "rep",         "find",  "insert",
                   "mine",         "x",     "length", "__index", "__len",       "value", "angle",
                   "set_velocity", "step",  "time",   "id",      "charpattern", "wrap"});
  }
  std::string variable() { return one_of({"a", "b", "c", "d", "G.x", "G.y", "G[1]", "b[1]", "b.k", "g"}); }
  std::string number() {
    return one_of({"0", "1", "2", "-1", "7", "0.5", "1e9", "-3.25", "1 << 62", "math.pi", "a", "#c", "#G", "#b",
                   "robot.random.uniform()", "robot.random.uniform_int(1, 9)", "math.random(5)", "n", "0 / 0"});
  }
  std::string text() {
    return one_of({"'x'", "''", "'%d+'", "'(a*)*b'", "'aaaaaaaaaaaa'", "tostring(b)", "tostring(print)", "c",
                   "('ab'):rep(3)", "string.format('%5.2f', n)", "robot.id", "'k' .. n", "table.concat({1, n}, '-')",
                   "('x'):rep(50)", "type(a)", "'%f[%a]'", "tostring(1 / 3)"});
  }

  std::string expression(int depth) {
    if (depth <= 0) return one_of({"1", "nil", "true", "'x'", "n", "a", "b", "{}"});
    switch (below(16)) {
      case 0:
        return number();
      case 1:
        return text();
      case 2:
        return entry();
      case 3:
        return library();
      case 4:
        return variable();
      case 5:
        return "{" + expression(depth - 1) + ", k = " + expression(depth - 1) + ", [n] = " + expression(0) + "}";
      case 6:
        return "(" + expression(depth - 1) + operation() + expression(depth - 1) + ")";
      case 7:
        return "(function(...) " + statement(depth - 1) + " return ... end)";
      case 8:
        return entry() + "(" + arguments(depth - 1) + ")";
      case 9:
        return "(" + text() + "):" + one_of({"rep", "find", "gsub", "upper", "sub", "byte", "mine", "len", "match"}) +
               "(" + arguments(depth - 1) + ")";
      case 10:
        return "select(2, pcall(" + expression(depth - 1) + ", " + arguments(depth - 1) + "))";
      case 11:
        return "setmetatable({}, {" + metamethod(depth - 1) + ", " + metamethod(depth - 1) + "})";
      case 12:
        return "#" + one_of({"b", "G", "c", "robot.proximity", "robot.range_and_bearing", "math"});
      case 13:
        return "coroutine.wrap(function(...) " + statement(depth - 1) + " coroutine.yield(n) " + statement(depth - 1) +
               " return ... end)";
      case 14:
        return "load(" + text() + " .. " + text() + ")";
      default:
        return "vector2(" + number() + ", " + number() + ")";
    }
  }
  std::string operation() {
    return one_of(
        {" + ", " - ", " * ", " / ", " // ", " % ", " ^ ", " .. ", " == ", " < ", " and ", " or ", " & ", " << "});
  }
  std::string arguments(int depth) {
    std::string all;
    for (std::size_t left = below(4); left > 0; --left) all += expression(depth) + (left > 1 ? ", " : "");
    return all;
  }
  std::string metamethod(int depth) {
    const std::string which = one_of({"__index", "__newindex", "__len", "__add", "__concat", "__call", "__eq", "__lt",
                                      "__tostring", "__pairs", "__close", "__name", "__metatable", "__mode", "__gc"});
    return which + " = " +
           (below(2) == 0 ? library() : "function(...) " + statement(depth) + " return " + number() + " end");
  }

  std::string statement(int depth) {
    if (depth <= 0) return variable() + " = " + expression(0) + " ";
    switch (below(24)) {
      case 0:
      case 1:
      case 2:
        return entry() + " = " + expression(depth - 1) + "\n";
      case 3:
        return library() + "." + name() + " = " + expression(depth - 1) + "\n";
      case 4:
        return "pcall(rawset, " + library() + ", '" + name() + "', " + expression(depth - 1) + ")\n";
      case 5:
        return library() + "[" + expression(depth - 1) + "] = " + expression(depth - 1) + "\n";
      case 6:
        return "for k, v in pairs(" + library() + ") do if type(k) == 'string' then g = k " + statement(depth - 1) +
               " break end end\n";
      case 7:
        return "for i = 1, " + one_of({"3", "10", "40", "n"}) + " do b[#b + " + one_of({"1", "2"}) +
               "] = i b['k' .. i] = " + expression(depth - 1) + " end\n";
      case 8:
        return "b[" + number() + "] = nil table.remove(b) G.x = #b\n";
      case 9:
        return "table.sort(b, " + one_of({"nil", "function(x, y) return tostring(x) < tostring(y) end"}) + ")\n";
      case 10:
      case 11:
        return "pcall(function() " + statement(depth - 1) + statement(depth - 1) + " end)\n";
      case 12:
        return "xpcall(function() " + statement(depth - 1) + " error(n) end, function(e) " + statement(depth - 1) +
               " return e end)\n";
      case 13:
        return variable() + " = " + expression(depth) + "\n";
      case 14:
        return "if " + expression(depth - 1) + " then " + statement(depth - 1) + " else " + statement(depth - 1) +
               " end\n";
      case 15:
        return "G.co = G.co or coroutine.create(function() while true do " + statement(depth - 1) +
               " coroutine.yield(1) end end) g = select(2, coroutine.resume(G.co))\n";
      case 16:
        return "local f = function(x) a = x " + statement(depth - 1) + " return f end pcall(f, " +
               expression(depth - 1) + ")\n";
      case 17:
        return "table.insert(" + one_of({"b", "G", "math", "robot.proximity", "robot"}) + ", " + expression(depth - 1) +
               ")\n";
      case 18:
        return "for w in (" + text() + "):gmatch(" + text() + ") do g = w end\n";
      case 19:
        return "log(" + expression(depth - 1) + ")\n";
      case 20:
        return below(3) == 0 ? "error(" + expression(depth - 1) + ")\n" : statement(depth - 1);
      case 21:
        return below(3) == 0 ? endless() + "\n" : statement(depth - 1);
      case 22:
        return below(2) == 0 ? greedy() + "\n" : statement(depth - 1);
      default:
        return "pcall(" + expression(depth - 1) + ", " + arguments(depth - 1) + ")\n";
    }
  }
  std::string endless() {
    return one_of(
        {"while true do end", "repeat n = n + 0 until false", "for i = 1, 1e18 do a = i end",
         "xpcall(error, function() while true do end end)", "while true do pcall(function() while true do end end) end",
         "local function f() return f() end f()", "local function f() return 1 + f() end pcall(f)",
         "('a'):rep(3000):find(('a*'):rep(30) .. 'b')", "string.rep('', 1 << 60)", "goto top ::top:: goto top",
         "coroutine.wrap(function() while true do end end)()",
         "local t = setmetatable({}, {__index = function(t, k) return t[k + 1] end}) pcall(function() return t[1] end)",
         "table.move({}, 1, 1 << 60, 2)", "return pcall(function() while true do end end)"});
  }
  std::string greedy() {
    return one_of({"for i = 1, 20000 do G[#G + 1] = {i} end", "G.s = ('y'):rep(300000) .. n .. (G.s or '')",
                   "pcall(string.rep, 'x', 1 << 34)", "for i = 1, 300 do G['big' .. i] = ('z'):rep(2000) .. i end",
                   "local t = {} while true do t[#t + 1] = {} end", "for i = 1, 3000 do local t = {i, {i}} end",
                   "G.list = G.list or {} for i = 1, 50 do G.list[#G.list + 1] = coroutine.wrap(print) end"});
  }

  std::mt19937 random_;
};

/// Robots of which every third one runs the program, where the file says so. All tell by their wheels what they see of
/// what all have.
std::string script_of(const std::string& program) {
  return R"(
    local n, mine = 0, tonumber(robot.id:sub(2)) % 3 == 1 and robot.params.wild == "1"
    local go, try, set, whole, kind = program, pcall, robot.wheels.set_velocity, math.type, type
    local function seen()
      local s = math.pi + math.floor(2.7) + #string.format("%5.2f", 1.25) + #("ab"):rep(3) + #utf8.charpattern
      for k, v in pairs(math) do s = s + #k end
      for k in pairs(string) do s = s + #k * 3 end
      s = s + math.maxinteger % 97 + #robot.proximity + robot.proximity[1].angle + vector2(3, 4):length()
      s = s + #tostring({}) + os.time() + select("#", table.unpack({1, 2, 3})) + #robot.id + math.abs(-n)
      s = s + (robot.proximity[1].mine and 1 or 0) + (robot.mine and 1 or 0) + (mine_too and 1 or 0) + (G and 1 or 0)
      for w in ("a1 b2 c3"):gmatch("%a%d") do s = s + w:byte() end
      local t = setmetatable({}, {__index = table})
      t:insert(s) t:insert(#t)
      return s + t[1] % 5 + (next({5})) + robot.random.uniform()
    end
    local function program()
      )" +
         program + R"(
    end
    function step()
      n = n + 1
      if mine then try(program) end
      local good, s = try(seen)
      if good and kind(s) == "number" and s == s and s < 1e15 and s > -1e15 then set(s % 10, n % 4) else set(1, 2) end
    end)";
}

struct Outcome {
  std::uint64_t hash = 0;
  std::string incidents;
  std::string others;  // where the robots are that do not run the program
};

Outcome outcome_of(const std::string& program, bool wild, std::int64_t threads) {
  Scripted world(
      {.text = script_of(program),
       .sensors = "<epuck_proximity/><clock/><range_and_bearing/>",
       .actuators = "<differential_steering/><range_and_bearing/>",
       .params = std::string(R"(most_instructions="100000" most_memory="1" wild=")") + (wild ? "1\"" : "0\""),
       .robots = 24,
       .threads = threads});
  Outcome outcome;
  EXPECT_NE(world.world, nullptr) << world.problems;
  if (world.world == nullptr) return outcome;
  for (int i = 0; i < 5; ++i) world.world->step();
  outcome.hash = world.world->state_hash();
  outcome.incidents = world.incidents();
  const core::Space& space = world.world->space();
  for (int i = 0; i < 24; ++i) {
    if (i % 3 == 1) continue;
    const auto pose = space.pose(space.find_robot("r" + std::to_string(i)));
    char text[160];
    std::snprintf(text, sizeof text, "r%d %a %a %a\n", i, pose.x_m, pose.y_m, pose.sin_h);
    outcome.others += text;
  }
  return outcome;
}

/// Whether Lua's own compiler takes it.
bool is_lua(const std::string& program) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), &lua_close);
  return luaL_loadstring(state.get(), program.c_str()) == LUA_OK;
}

unsigned from_environment(const char* name, unsigned otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

TEST(LuaFuzz, WhateverAScriptDoesTheBitsAreTheSameAndNeighboursAreNotTouched) {
  const unsigned count = from_environment("TANDEM_LUA_FUZZ", 25);
  const unsigned first = from_environment("TANDEM_LUA_FUZZ_FIRST", 1);
  for (unsigned seed = first; seed < first + count; ++seed) {
    Author author(seed);
    std::string program;
    do program = author.program();
    while (!is_lua("local n = 0 " + program));
    const auto threads = static_cast<std::int64_t>(2 + author.below(5));
    const Outcome alone = outcome_of(program, true, 1);
    const Outcome together = outcome_of(program, true, threads);
    const Outcome tame = outcome_of(program, false, 1);
    const std::string what =
        "program " + std::to_string(seed) + ", " + std::to_string(threads) + " threads:\n" + program;
    EXPECT_EQ(alone.hash, together.hash) << what;
    EXPECT_EQ(alone.incidents, together.incidents) << what;
    EXPECT_EQ(alone.others, tame.others) << what;
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace tandem::test
