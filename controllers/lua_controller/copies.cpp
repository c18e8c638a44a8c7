#include "controllers/lua_controller/copies.hpp"

namespace tandem::controllers::lua {
namespace {

char no_value;  // stands for nil in what was kept

/// Stack, from where it begins: 1 record or nil, 2 seen, 3 shared or nil, 4 to do.
class Walk {
 public:
  enum class For { Nothing, Record, Measure };

  Walk(lua_State* state, For what, int shared) : L(state), for_(what), record_(lua_gettop(state) + 1) {
    luaL_checkstack(L, 32, nullptr);
    what == For::Record ? lua_newtable(L) : lua_pushnil(L);
    lua_newtable(L);
    lua_rawgeti(L, LUA_REGISTRYINDEX, shared);
    lua_newtable(L);
  }

  void visit(int index) {
    index = lua_absindex(L, index);
    switch (lua_type(L, index)) {
      case LUA_TSTRING:
        return for_ == For::Measure ? text(index) : void();
      case LUA_TUSERDATA:
        if (for_ == For::Measure && first_time(index)) bytes_ += kObject + lua_rawlen(L, index);
        return;
      case LUA_TTHREAD:
        if (for_ != For::Measure) return check_thread(index);
        break;
      case LUA_TTABLE:
      case LUA_TFUNCTION:
        break;
      default:
        return;
    }
    if (!first_time(index)) return;
    lua_pushvalue(L, index);
    lua_rawseti(L, to_do(), ++left_);
  }

  void run() {
    const int one = to_do() + 1;
    while (left_ > 0) {
      lua_rawgeti(L, to_do(), left_);
      lua_pushnil(L);
      lua_rawseti(L, to_do(), left_--);
      if (for_ == For::Record) lua_newtable(L);
      if (lua_istable(L, one))
        table(one);
      else if (lua_isthread(L, one))
        thread(lua_tothread(L, one));
      else
        function(one);
      if (for_ == For::Record) {
        lua_rawseti(L, record_, kept_ + 2);
        lua_rawseti(L, record_, kept_ + 1);
        kept_ += 2;
      }
      lua_settop(L, to_do());
    }
  }
  void roots(std::initializer_list<int> roots) {
    for (const int root : roots) {
      lua_rawgeti(L, LUA_REGISTRYINDEX, root);
      visit(-1);
      lua_settop(L, to_do());
    }
  }
  /// Leaves the record, or what was seen, on the top.
  void leave_record() { lua_settop(L, record_); }
  void leave_seen() {
    lua_settop(L, record_ + 1);
    lua_remove(L, record_);
  }
  std::uint64_t bytes() {
    lua_settop(L, record_ - 1);
    return bytes_;
  }

 private:
  // As Lua 5.4 has them with 64 bits.
  static constexpr std::uint64_t kObject = 56, kEntry = 24, kUpvalue = 40, kThread = 1024;
  static constexpr std::size_t kShortText = 40;
  static constexpr int kDeepest = 10'000;  // calls in a coroutine: each is looked for from the top

  int to_do() const noexcept { return record_ + 3; }

  bool first_time(int index) {
    for (const int set : {record_ + 1, record_ + 2}) {
      if (!lua_istable(L, set)) continue;
      lua_pushvalue(L, index);
      const bool known = lua_rawget(L, set) != LUA_TNIL;
      lua_pop(L, 1);
      if (known) return false;
    }
    lua_pushvalue(L, index);
    lua_pushboolean(L, 1);
    lua_rawset(L, record_ + 1);
    return true;
  }

  void text(int index) {
    const auto size = static_cast<std::size_t>(lua_rawlen(L, index));
    if (size <= kShortText || !first_time(index)) return;
    bytes_ += kObject + size;
  }

  void table(int one) {
    const bool record = for_ == For::Record;
    bytes_ += kObject;
    lua_Integer n = 0;
    if (lua_getmetatable(L, one) != 0)
      visit(-1);
    else
      lua_pushboolean(L, 0);
    record ? lua_rawseti(L, one + 1, ++n) : lua_pop(L, 1);
    lua_pushnil(L);
    while (lua_next(L, one) != 0) {
      visit(-2);
      visit(-1);
      bytes_ += kEntry;
      if (!record) {
        lua_pop(L, 1);
        continue;
      }
      lua_pushvalue(L, -2);
      lua_rawseti(L, one + 1, ++n);
      lua_rawseti(L, one + 1, ++n);
    }
  }

  void function(int one) {
    bytes_ += kObject;
    for (int i = 1; lua_getupvalue(L, one, i) != nullptr; ++i) {
      visit(-1);
      bytes_ += kUpvalue;
      if (for_ != For::Record) {
        lua_pop(L, 1);
        continue;
      }
      if (lua_isnil(L, -1)) {
        lua_pop(L, 1);
        lua_pushlightuserdata(L, &no_value);
      }
      lua_rawseti(L, one + 1, i);
    }
  }

  void check_thread(int index) {
    lua_State* const thread = lua_tothread(L, index);
    if (lua_status(thread) == LUA_OK && lua_gettop(thread) == 0) return;  // it has ended
    luaL_error(L, "it holds a coroutine that has not come to its end, which cannot be copied");
  }

  /// What waits in a coroutine.
  void thread(lua_State* thread) {
    bytes_ += kThread;
    if (thread == L) return;  // the interpreter's own
    luaL_checkstack(thread, 4, nullptr);
    const int values = lua_gettop(thread);
    for (int i = 1; i <= values; ++i) {
      lua_pushvalue(thread, i);
      take_from(thread);
    }
    lua_Debug call{};
    for (int level = 0; lua_getstack(thread, level, &call) != 0; ++level) {
      if (level == kDeepest)
        luaL_error(L, "a coroutine waits in more than %d calls, too deep to measure what it holds", kDeepest);
      for (int i = 1; lua_getlocal(thread, &call, i) != nullptr; ++i) take_from(thread);
      for (int i = -1; lua_getlocal(thread, &call, i) != nullptr; --i) take_from(thread);
      lua_getinfo(thread, "f", &call);
      take_from(thread);
      bytes_ += kThread / 8;
    }
  }
  void take_from(lua_State* thread) {
    lua_xmove(thread, L, 1);
    visit(-1);
    lua_pop(L, 1);
    bytes_ += 16;
  }

  lua_State* L;
  For for_;
  int record_;
  lua_Integer left_ = 0;
  lua_Integer kept_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace

int push_shared(lua_State* L, std::initializer_list<int> roots) {
  Walk walk(L, Walk::For::Nothing, LUA_REFNIL);
  walk.roots(roots);
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  walk.visit(-1);
  lua_pop(L, 2);
  walk.run();
  walk.leave_seen();
  return luaL_ref(L, LUA_REGISTRYINDEX);
}

void push_record(lua_State* L, std::initializer_list<int> roots, int shared) {
  Walk walk(L, Walk::For::Record, shared);
  walk.roots(roots);
  walk.run();
  walk.leave_record();
}

std::uint64_t measure_reached(lua_State* L, std::initializer_list<int> roots, int shared) {
  Walk walk(L, Walk::For::Measure, shared);
  walk.roots(roots);
  walk.run();
  return walk.bytes();
}

void put_back_record(lua_State* L) {
  const int record = lua_gettop(L);
  const int one = record + 1;   // table or function
  const int held = record + 2;  // what it held
  const auto count = static_cast<lua_Integer>(lua_rawlen(L, record));
  for (lua_Integer i = 1; i < count; i += 2) {
    lua_rawgeti(L, record, i);
    lua_rawgeti(L, record, i + 1);
    const auto entries = static_cast<lua_Integer>(lua_rawlen(L, held));
    if (lua_istable(L, one)) {
      lua_pushnil(L);
      while (lua_next(L, one) != 0) {
        lua_pop(L, 1);
        lua_pushvalue(L, -1);
        lua_pushnil(L);
        lua_rawset(L, one);
      }
      lua_rawgeti(L, held, 1);
      if (!lua_istable(L, -1)) lua_pushnil(L);
      lua_setmetatable(L, one);
      lua_settop(L, held);
      for (lua_Integer k = 2; k < entries; k += 2) {
        lua_rawgeti(L, held, k);
        lua_rawgeti(L, held, k + 1);
        lua_rawset(L, one);
      }
    } else {
      for (lua_Integer k = 1; k <= entries; ++k) {
        lua_rawgeti(L, held, k);
        if (lua_touserdata(L, -1) == &no_value) {
          lua_pop(L, 1);
          lua_pushnil(L);
        }
        lua_setupvalue(L, one, static_cast<int>(k));
      }
    }
    lua_settop(L, record);
  }
}

}  // namespace tandem::controllers::lua
