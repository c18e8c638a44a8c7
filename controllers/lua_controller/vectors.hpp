// vector2, vector3 and quaternion as ARGoS' scripts have them, of floats, written in Lua. Robots share the functions;
// the tables of methods and the metatables are reached by no script.
#pragma once
#include <string_view>

namespace tandem::controllers::lua {

inline constexpr std::string_view kVectors = R"lua(
local setmetatable, getmetatable, type, error, select = setmetatable, _tandem_metatable, type, error, select
local sqrt, sin, cos, atan = math.sqrt, math.sin, math.cos, math.atan
local format = string.format

local m2, m3, mq = {}, {}, {}  -- methods
local v2 = {__index = m2, __metatable = false}
local v3 = {__index = m3, __metatable = false}
local q = {__index = mq, __metatable = false}

local function is_number(x) return type(x) == "number" end
local function check(x, meta, name)
  if type(x) ~= "table" or getmetatable(x) ~= meta then error("expected a " .. name .. ", got a " .. type(x), 3) end
  return x
end

-- In the plane.
local function make2(x, y) return setmetatable({x = x, y = y}, v2) end
function vector2(...)
  local n, x, y = select("#", ...), ...
  if n == 0 then return make2(0.0, 0.0) end
  if n == 1 then check(x, v2, "vector2") return make2(x.x, x.y) end
  if n == 2 and is_number(x) and is_number(y) then return make2(x + 0.0, y + 0.0) end
  error("vector2() takes nothing, a vector2 or two numbers", 2)
end
function v2.__add(a, b) check(a, v2, "vector2") check(b, v2, "vector2") return make2(a.x + b.x, a.y + b.y) end
function v2.__sub(a, b) check(a, v2, "vector2") check(b, v2, "vector2") return make2(a.x - b.x, a.y - b.y) end
function v2.__unm(a) return make2(-a.x, -a.y) end
function v2.__mul(a, b)
  if is_number(a) then a, b = b, a end
  if not is_number(b) then error("a vector2 is multiplied by a number", 2) end
  return make2(a.x * b, a.y * b)
end
function v2.__div(a, b)
  if not is_number(b) then error("a vector2 is divided by a number", 2) end
  return make2(a.x / b, a.y / b)
end
function v2.__eq(a, b) return getmetatable(a) == getmetatable(b) and a.x == b.x and a.y == b.y end
function v2.__tostring(a) return format("%g,%g", a.x, a.y) end
function m2.length(a) check(a, v2, "vector2") return sqrt(a.x * a.x + a.y * a.y) end
function m2.square_length(a) check(a, v2, "vector2") return a.x * a.x + a.y * a.y end
function m2.angle(a) check(a, v2, "vector2") return atan(a.y, a.x) end
function m2.dot(a, b) check(a, v2, "vector2") check(b, v2, "vector2") return a.x * b.x + a.y * b.y end
function m2.cross(a, b) check(a, v2, "vector2") check(b, v2, "vector2") return a.x * b.y - a.y * b.x end
function m2.normalize(a)
  local length = m2.length(a)
  a.x, a.y = a.x / length, a.y / length
  return a
end
function m2.rotate(a, angle)
  check(a, v2, "vector2")
  if not is_number(angle) then error("a vector2 is rotated by an angle, a number", 2) end
  local c, s = cos(angle), sin(angle)
  a.x, a.y = a.x * c - a.y * s, a.x * s + a.y * c
  return a
end

-- In space.
local function make3(x, y, z) return setmetatable({x = x, y = y, z = z}, v3) end
function vector3(...)
  local n, x, y, z = select("#", ...), ...
  if n == 0 then return make3(0.0, 0.0, 0.0) end
  if n == 1 then check(x, v3, "vector3") return make3(x.x, x.y, x.z) end
  if n == 3 and is_number(x) and is_number(y) and is_number(z) then return make3(x + 0.0, y + 0.0, z + 0.0) end
  error("vector3() takes nothing, a vector3 or three numbers", 2)
end
function v3.__add(a, b) check(a, v3, "vector3") check(b, v3, "vector3") return make3(a.x + b.x, a.y + b.y, a.z + b.z) end
function v3.__sub(a, b) check(a, v3, "vector3") check(b, v3, "vector3") return make3(a.x - b.x, a.y - b.y, a.z - b.z) end
function v3.__unm(a) return make3(-a.x, -a.y, -a.z) end
function v3.__mul(a, b)
  if is_number(a) then a, b = b, a end
  if not is_number(b) then error("a vector3 is multiplied by a number", 2) end
  return make3(a.x * b, a.y * b, a.z * b)
end
function v3.__div(a, b)
  if not is_number(b) then error("a vector3 is divided by a number", 2) end
  return make3(a.x / b, a.y / b, a.z / b)
end
function v3.__eq(a, b) return getmetatable(a) == getmetatable(b) and a.x == b.x and a.y == b.y and a.z == b.z end
function v3.__tostring(a) return format("%g,%g,%g", a.x, a.y, a.z) end
function m3.length(a) check(a, v3, "vector3") return sqrt(a.x * a.x + a.y * a.y + a.z * a.z) end
function m3.square_length(a) check(a, v3, "vector3") return a.x * a.x + a.y * a.y + a.z * a.z end
function m3.dot(a, b) check(a, v3, "vector3") check(b, v3, "vector3") return a.x * b.x + a.y * b.y + a.z * b.z end
function m3.cross(a, b)
  check(a, v3, "vector3") check(b, v3, "vector3")
  a.x, a.y, a.z = a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x
  return a
end
function m3.normalize(a)
  local length = m3.length(a)
  a.x, a.y, a.z = a.x / length, a.y / length, a.z / length
  return a
end
function m3.rotate(a, by)
  check(a, v3, "vector3") check(by, q, "quaternion")
  local w, x, y, z = by.w, by.x, by.y, by.z
  local tx, ty, tz = 2 * (y * a.z - z * a.y), 2 * (z * a.x - x * a.z), 2 * (x * a.y - y * a.x)
  a.x, a.y, a.z = a.x + w * tx + y * tz - z * ty, a.y + w * ty + z * tx - x * tz, a.z + w * tz + x * ty - y * tx
  return a
end

-- Rotations.
local function makeq(w, x, y, z) return setmetatable({w = w, x = x, y = y, z = z}, q) end
function quaternion(...)
  local n, w, x, y, z = select("#", ...), ...
  if n == 0 then return makeq(1.0, 0.0, 0.0, 0.0) end
  if n == 1 then check(w, q, "quaternion") return makeq(w.w, w.x, w.y, w.z) end
  if n == 2 and is_number(w) then
    check(x, v3, "vector3")
    local s = sin(0.5 * w)
    return makeq(cos(0.5 * w), s * x.x, s * x.y, s * x.z)
  end
  if n == 4 and is_number(w) and is_number(x) and is_number(y) and is_number(z) then
    return makeq(w + 0.0, x + 0.0, y + 0.0, z + 0.0)
  end
  error("quaternion() takes nothing, a quaternion, an angle and a vector3, or four numbers w, x, y, z", 2)
end
function q.__mul(a, b)
  check(a, q, "quaternion") check(b, q, "quaternion")
  return makeq(a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
               a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w)
end
function q.__eq(a, b)
  return getmetatable(a) == getmetatable(b) and a.w == b.w and a.x == b.x and a.y == b.y and a.z == b.z
end
function q.__tostring(a) return format("%g,%g,%g,%g", a.w, a.x, a.y, a.z) end
function mq.normalize(a)
  check(a, q, "quaternion")
  local length = sqrt(a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z)
  a.w, a.x, a.y, a.z = a.w / length, a.x / length, a.y / length, a.z / length
  return a
end
function mq.inverse(a) check(a, q, "quaternion") return makeq(a.w, -a.x, -a.y, -a.z) end
function mq.toangleaxis(a)
  check(a, q, "quaternion")
  local s = sqrt(a.x * a.x + a.y * a.y + a.z * a.z)
  if s == 0 then return 0.0, make3(0.0, 0.0, 1.0) end
  return 2 * atan(s, a.w), make3(a.x / s, a.y / s, a.z / s)
end
function mq.toeulerangles(a)  -- about z, then y, then x
  check(a, q, "quaternion")
  local w, x, y, z = a.w, a.x, a.y, a.z
  local s = 2 * (w * y - x * z)
  if s > 1 then s = 1 elseif s < -1 then s = -1 end
  return atan(2 * (x * y + w * z), w * w + x * x - y * y - z * z), atan(s, sqrt(1 - s * s)),
         atan(2 * (y * z + w * x), w * w - x * x - y * y + z * z)
end

-- What robot.positioning.orientation is: a quaternion that also tells its angle and axis.
local function from_positioning(w, x, y, z)
  local all = makeq(w, x, y, z)
  all.angle, all.axis = mq.toangleaxis(all)
  return all
end
_tandem_vector2, _tandem_vector3, _tandem_orientation = make2, make3, from_positioning
)lua";

}  // namespace tandem::controllers::lua
