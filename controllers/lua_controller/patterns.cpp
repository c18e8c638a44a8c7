// [Lua 5.4 reference manual, 6.4.1]
#include "controllers/lua_controller/patterns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>

namespace tandem::controllers::lua {
namespace {

// --- characters, as in the locale "C" ---

using Byte = unsigned char;

constexpr bool is_digit(Byte c) noexcept {
  return c >= '0' && c <= '9';
}
constexpr bool is_lower(Byte c) noexcept {
  return c >= 'a' && c <= 'z';
}
constexpr bool is_upper(Byte c) noexcept {
  return c >= 'A' && c <= 'Z';
}
constexpr bool is_graphic(Byte c) noexcept {
  return c > 0x20 && c < 0x7F;
}
constexpr Byte lowered(Byte c) noexcept {
  return is_upper(c) ? static_cast<Byte>(c + ('a' - 'A')) : c;
}

/// Whether `c` is of the class that the letter names; another character stands for itself.
bool in_class(Byte c, Byte letter) noexcept {
  const bool word = is_digit(c) || is_lower(lowered(c));
  bool is = false;
  switch (lowered(letter)) {
    case 'a':
      is = word && !is_digit(c);
      break;
    case 'c':
      is = c < 0x20 || c == 0x7F;
      break;
    case 'd':
      is = is_digit(c);
      break;
    case 'g':
      is = is_graphic(c);
      break;
    case 'l':
      is = is_lower(c);
      break;
    case 'p':
      is = is_graphic(c) && !word;
      break;
    case 's':
      is = c == ' ' || (c >= '\t' && c <= '\r');
      break;
    case 'u':
      is = is_upper(c);
      break;
    case 'w':
      is = word;
      break;
    case 'x':
      is = is_digit(c) || (lowered(c) >= 'a' && lowered(c) <= 'f');
      break;
    case 'z':  // of older versions of Lua
      is = c == 0;
      break;
    default:
      return letter == c;
  }
  return is_upper(letter) ? !is : is;
}

// --- a pattern at a text ---

class Match {
 public:
  Match(lua_State* state, std::string_view text, std::string_view pattern)
      : L(state),
        in_(Interpreter::of(state)),
        text_(text.data()),
        end_(text.data() + text.size()),
        pattern_end_(pattern.data() + pattern.size()) {}

  /// Tries from `at` on. @returns the end of what matches, or null
  const char* from(const char* at, const char* pattern) {
    captures_ = 0;
    depth_ = 0;
    return match(at, pattern);
  }
  /// Pushes all captures, or what matched where there are none.
  int push_all(const char* begin, const char* end) {
    const int count = captures_ == 0 && begin != nullptr ? 1 : captures_;
    luaL_checkstack(L, count, "too many captures");
    for (int i = 0; i < count; ++i) push(i, begin, end);
    return count;
  }
  /// Pushes one; 0 is what matched, where there are no captures.
  void push(int i, const char* begin, const char* end) {
    if (i >= captures_) {
      if (i != 0) luaL_error(L, "invalid capture index %%%d", i + 1);
      lua_pushlstring(L, begin, static_cast<std::size_t>(end - begin));
      return;
    }
    const Capture& capture = capture_[static_cast<std::size_t>(i)];
    if (capture.size == kOpen) luaL_error(L, "unfinished capture");
    if (capture.size == kPlace)
      lua_pushinteger(L, capture.begin - text_ + 1);
    else
      lua_pushlstring(L, capture.begin, static_cast<std::size_t>(capture.size));
  }
  const char* begin() const noexcept { return text_; }
  const char* end() const noexcept { return end_; }
  lua_State* state() const noexcept { return L; }

 private:
  static constexpr std::ptrdiff_t kOpen = -1, kPlace = -2;
  static constexpr int kDeepest = 200;
  struct Capture {
    const char* begin = nullptr;
    std::ptrdiff_t size = kOpen;
  };

  const char* match(const char* s, const char* p) {
    if (++depth_ > kDeepest) luaL_error(L, "pattern too complex");
    const char* const found = match_here(s, p);
    --depth_;
    return found;
  }

  const char* match_here(const char* s, const char* p) {
    for (;;) {
      in_.spend(L, 1);
      if (p == pattern_end_) return s;
      if (*p == '(') return p[1] == ')' ? open(s, p + 2, kPlace) : open(s, p + 1, kOpen);
      if (*p == ')') return close(s, p + 1);
      if (*p == '$' && p + 1 == pattern_end_) return s == end_ ? s : nullptr;
      if (*p == '%' && (p[1] == 'b' || p[1] == 'f' || is_digit(static_cast<Byte>(p[1])))) {
        s = p[1] == 'b' ? balanced(s, p) : p[1] == 'f' ? frontier(s, p) : again(s, p);
        if (s == nullptr) return nullptr;
        continue;
      }
      const char* const after = single_end(p);
      const char suffix = after == pattern_end_ ? '\0' : *after;
      if (suffix == '*') return longest(s, p, after);
      if (suffix == '-') return shortest(s, p, after);
      const bool fits = single(s, p, after);
      if (suffix == '+') return fits ? longest(s + 1, p, after) : nullptr;
      if (suffix == '?') {
        if (const char* const found = fits ? match(s + 1, after + 1) : nullptr) return found;
        p = after + 1;
        continue;
      }
      if (!fits) return nullptr;
      ++s;
      p = after;
    }
  }

  /// The end of the class, set or character at `p`.
  const char* single_end(const char* p) {
    if (*p == '%') {
      if (p + 1 == pattern_end_) luaL_error(L, "malformed pattern (ends with '%%')");
      return p + 2;
    }
    if (*p != '[') return p + 1;
    ++p;
    if (*p == '^') ++p;
    do {  // what stands first belongs to the set, also ']'
      if (p == pattern_end_) luaL_error(L, "malformed pattern (missing ']')");
      p += *p == '%' ? 2 : 1;
      if (p > pattern_end_) luaL_error(L, "malformed pattern (missing ']')");
    } while (p == pattern_end_ || *p != ']');
    return p + 1;
  }

  bool single(const char* s, const char* p, const char* after) const noexcept {
    if (s == end_) return false;
    const auto c = static_cast<Byte>(*s);
    if (*p == '.') return true;
    if (*p == '%') return in_class(c, static_cast<Byte>(p[1]));
    return *p == '[' ? in_set(c, p, after - 1) : static_cast<Byte>(*p) == c;
  }

  /// `p` is at '[', `last` at its ']'.
  static bool in_set(Byte c, const char* p, const char* last) noexcept {
    const bool inverted = p[1] == '^';
    for (p += inverted ? 2 : 1; p < last; ++p) {
      if (*p == '%') {
        if (in_class(c, static_cast<Byte>(*++p))) return !inverted;
      } else if (p[1] == '-' && p + 2 < last) {
        if (static_cast<Byte>(*p) <= c && c <= static_cast<Byte>(p[2])) return !inverted;
        p += 2;
      } else if (static_cast<Byte>(*p) == c) {
        return !inverted;
      }
    }
    return inverted;
  }

  const char* longest(const char* s, const char* p, const char* after) {
    std::ptrdiff_t count = 0;
    while (single(s + count, p, after)) {
      ++count;
      in_.spend(L, 1);
    }
    for (; count >= 0; --count) {
      if (const char* const found = match(s + count, after + 1)) return found;
    }
    return nullptr;
  }

  const char* shortest(const char* s, const char* p, const char* after) {
    for (;; ++s) {
      if (const char* const found = match(s, after + 1)) return found;
      if (!single(s, p, after)) return nullptr;
    }
  }

  const char* open(const char* s, const char* p, std::ptrdiff_t size) {
    if (captures_ == static_cast<int>(capture_.size())) luaL_error(L, "too many captures");
    capture_[static_cast<std::size_t>(captures_++)] = {s, size};
    const char* const found = match(s, p);
    if (found == nullptr) --captures_;
    return found;
  }

  const char* close(const char* s, const char* p) {
    int i = captures_ - 1;
    while (i >= 0 && capture_[static_cast<std::size_t>(i)].size != kOpen) --i;
    if (i < 0) luaL_error(L, "invalid pattern capture");
    Capture& capture = capture_[static_cast<std::size_t>(i)];
    capture.size = s - capture.begin;
    const char* const found = match(s, p);
    if (found == nullptr) capture.size = kOpen;
    return found;
  }

  /// "%bxy": from an x to the y that ends it.
  const char* balanced(const char* s, const char*& p) {
    if (pattern_end_ - p < 4) luaL_error(L, "malformed pattern (missing arguments to '%%b')");
    const char opening = p[2];
    const char closing = p[3];
    p += 4;
    if (s == end_ || *s != opening) return nullptr;
    int nested = 1;
    while (++s < end_) {
      in_.spend(L, 1);
      if (*s == closing) {
        if (--nested == 0) return s + 1;
      } else if (*s == opening) {
        ++nested;
      }
    }
    return nullptr;
  }

  /// "%f[set]": where a character of the set comes after one that is not.
  const char* frontier(const char* s, const char*& p) {
    const char* const set = p + 2;
    if (set == pattern_end_ || *set != '[') luaL_error(L, "missing '[' after '%%f' in pattern");
    const char* const after = single_end(set);
    const Byte before = s == text_ ? Byte{0} : static_cast<Byte>(s[-1]);
    const Byte here = s == end_ ? Byte{0} : static_cast<Byte>(*s);
    p = after;
    return !in_set(before, set, after - 1) && in_set(here, set, after - 1) ? s : nullptr;
  }

  /// "%1": what was captured, once more.
  const char* again(const char* s, const char*& p) {
    const int i = p[1] - '1';
    if (i < 0 || i >= captures_ || capture_[static_cast<std::size_t>(i)].size == kOpen)
      luaL_error(L, "invalid capture index %%%d", i + 1);
    const Capture& capture = capture_[static_cast<std::size_t>(i)];
    const std::ptrdiff_t size = capture.size == kPlace ? -1 : capture.size;
    p += 2;
    if (size < 0 || end_ - s < size) return nullptr;
    in_.spend(L, size / 16);
    return std::memcmp(capture.begin, s, static_cast<std::size_t>(size)) == 0 ? s + size : nullptr;
  }

  lua_State* L;
  Interpreter& in_;
  const char* text_;
  const char* end_;
  const char* pattern_end_;
  int depth_ = 0;
  int captures_ = 0;
  std::array<Capture, 32> capture_{};
};

std::string_view text_at(lua_State* L, int index) {
  std::size_t size = 0;
  const char* const text = luaL_checklstring(L, index, &size);
  return {text, size};
}

/// Where a search begins that the script says to begin at `init`, from 0; beyond the end: it finds nothing.
std::size_t start_of(lua_Integer init, std::size_t size) noexcept {
  if (init > 0) return static_cast<std::size_t>(init) - 1;
  if (init == 0 || init < -static_cast<lua_Integer>(size)) return 0;
  return size - static_cast<std::size_t>(-init);
}

int search(lua_State* L, bool find) {
  const std::string_view text = text_at(L, 1);
  const std::string_view pattern = text_at(L, 2);
  const std::size_t begin = start_of(luaL_optinteger(L, 3, 1), text.size());
  if (begin > text.size()) {
    luaL_pushfail(L);
    return 1;
  }
  if (find && (lua_toboolean(L, 4) != 0 || pattern.find_first_of("^$*+?.([%-") == std::string_view::npos)) {
    Interpreter::of(L).spend(L, static_cast<std::int64_t>((text.size() - begin) / 16));
    const std::size_t at = text.find(pattern, begin);
    if (at != std::string_view::npos) {
      lua_pushinteger(L, static_cast<lua_Integer>(at + 1));
      lua_pushinteger(L, static_cast<lua_Integer>(at + pattern.size()));
      return 2;
    }
    luaL_pushfail(L);
    return 1;
  }
  const bool anchored = pattern.starts_with('^');
  Match match(L, text, pattern);
  for (const char* s = match.begin() + begin; s <= match.end(); ++s) {
    if (const char* const end = match.from(s, pattern.data() + (anchored ? 1 : 0))) {
      if (!find) return match.push_all(s, end);
      lua_pushinteger(L, s - match.begin() + 1);
      lua_pushinteger(L, end - match.begin());
      return match.push_all(nullptr, nullptr) + 2;
    }
    if (anchored) break;
  }
  luaL_pushfail(L);
  return 1;
}

int find(lua_State* L) {
  return search(L, true);
}
int match(lua_State* L) {
  return search(L, false);
}

int next_of_gmatch(lua_State* L) {  // upvalues: text, pattern, where to go on, end of the last match or -1
  const std::string_view text = text_at(L, lua_upvalueindex(1));
  const std::string_view pattern = text_at(L, lua_upvalueindex(2));
  const lua_Integer last = lua_tointeger(L, lua_upvalueindex(4));
  Match match(L, text, pattern);
  for (const char* s = match.begin() + lua_tointeger(L, lua_upvalueindex(3)); s <= match.end(); ++s) {
    const char* const end = match.from(s, pattern.data());
    if (end == nullptr || end - match.begin() == last) continue;
    lua_pushinteger(L, end - match.begin());
    lua_copy(L, -1, lua_upvalueindex(3));
    lua_replace(L, lua_upvalueindex(4));
    return match.push_all(s, end);
  }
  return 0;
}

int gmatch(lua_State* L) {
  const std::string_view text = text_at(L, 1);
  text_at(L, 2);
  const std::size_t begin = start_of(luaL_optinteger(L, 3, 1), text.size());
  lua_settop(L, 2);
  lua_pushinteger(L, static_cast<lua_Integer>(std::min(begin, text.size() + 1)));
  lua_pushinteger(L, -1);
  lua_pushcclosure(L, &next_of_gmatch, 4);
  return 1;
}

/// Adds the replacement text at 3, in which "%1" is a capture, "%0" all and "%%" a percent sign.
void add_text(Match& match, luaL_Buffer& result, const char* begin, const char* end) {
  lua_State* const L = match.state();
  std::size_t size = 0;
  const char* const text = lua_tolstring(L, 3, &size);
  Interpreter::of(L).spend(L, static_cast<std::int64_t>(size / 16));
  for (std::size_t i = 0; i < size; ++i) {
    if (text[i] != '%') {
      luaL_addchar(&result, text[i]);
      continue;
    }
    const char c = text[++i];  // a text ends with a zero
    if (c == '%') {
      luaL_addchar(&result, '%');
    } else if (c == '0') {
      luaL_addlstring(&result, begin, static_cast<std::size_t>(end - begin));
    } else if (is_digit(static_cast<Byte>(c))) {
      match.push(c - '1', begin, end);
      luaL_tolstring(L, -1, nullptr);
      lua_remove(L, -2);
      luaL_addvalue(&result);
    } else {
      luaL_error(L, "invalid use of '%%' in replacement string");
    }
  }
}

/// Adds what stands for a match. @returns whether it is something else than before
bool add_value(Match& match, luaL_Buffer& result, const char* begin, const char* end) {
  lua_State* const L = match.state();
  const int type = lua_type(L, 3);
  if (type == LUA_TFUNCTION) {
    lua_pushvalue(L, 3);
    lua_call(L, match.push_all(begin, end), 1);
  } else if (type == LUA_TTABLE) {
    match.push(0, begin, end);
    lua_gettable(L, 3);
  } else {
    add_text(match, result, begin, end);
    return true;
  }
  if (lua_toboolean(L, -1) == 0) {
    lua_pop(L, 1);
    luaL_addlstring(&result, begin, static_cast<std::size_t>(end - begin));
    return false;
  }
  if (lua_isstring(L, -1) == 0) luaL_error(L, "invalid replacement value (a %s)", luaL_typename(L, -1));
  luaL_addvalue(&result);
  return true;
}

int gsub(lua_State* L) {
  const std::string_view text = text_at(L, 1);
  const std::string_view pattern = text_at(L, 2);
  const int type = lua_type(L, 3);
  luaL_argexpected(L, type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TFUNCTION || type == LUA_TTABLE, 3,
                   "string/function/table");
  const lua_Integer most = luaL_optinteger(L, 4, std::numeric_limits<lua_Integer>::max());
  const bool anchored = pattern.starts_with('^');
  Match match(L, text, pattern);
  luaL_Buffer result;
  luaL_buffinit(L, &result);
  const char* s = match.begin();
  const char* last = nullptr;
  lua_Integer count = 0;
  bool changed = false;
  while (count < most) {
    const char* const end = match.from(s, pattern.data() + (anchored ? 1 : 0));
    if (end != nullptr && end != last) {
      ++count;
      changed = add_value(match, result, s, end) || changed;
      s = last = end;
    } else if (s < match.end()) {
      luaL_addchar(&result, *s);
      ++s;
    } else {
      break;
    }
    if (anchored) break;
  }
  if (changed) {
    luaL_addlstring(&result, s, static_cast<std::size_t>(match.end() - s));
    luaL_pushresult(&result);
  } else {
    lua_pushvalue(L, 1);
  }
  lua_pushinteger(L, count);
  return 2;
}

}  // namespace

void open_patterns(lua_State* L) {
  const auto set = [L](const char* name, lua_CFunction function) {
    lua_pushcfunction(L, function);
    lua_setfield(L, -2, name);
  };
  set("find", &find);
  set("match", &match);
  set("gmatch", &gmatch);
  set("gsub", &gsub);
}

}  // namespace tandem::controllers::lua
