-- Random numbers, vectors and the language itself.
local function tell(key, value)
   log("RESULT " .. key .. " " .. tostring(value))
end

local function counted()
   local n = 0
   for i = 1, 1000 do
      if robot.random.bernoulli(0.1) then n = n + 1 end
   end
   return n
end

local function close(a, b) return math.abs(a - b) < 1e-9 end

function init()
   tell("bernoulli", type(robot.random.bernoulli(0.5)))
   local n = counted()
   tell("bernoulli_few", n > 50 and n < 160)
   local u, v, w = robot.random.uniform(), robot.random.uniform(5), robot.random.uniform(-2, 3)
   tell("uniform", u >= 0 and u < 1 and v >= 0 and v < 5 and w >= -2 and w < 3)
   local k = robot.random.uniform_int(1, 4)
   tell("uniform_int", k >= 1 and k < 4 and k == math.floor(k))
   tell("uniform_int_type", math.type(k))
   local sum = 0
   for i = 1, 2000 do sum = sum + robot.random.gaussian(2, 10) end
   tell("gaussian", math.abs(sum / 2000 - 10) < 0.25)
   tell("exponential", robot.random.exponential(3) >= 0)
   tell("poisson", robot.random.poisson(3) >= 0)

   local a, b = vector2(3, 4), vector2(1, 2)
   tell("vector2", a:length() .. " " .. (a + b).x .. " " .. (a - b).y .. " " .. (a * 2).x)
   local c = vector3(1, 2, 2)
   tell("vector3", c:length() .. " " .. c:dot(vector3(0, 1, 0)))
   local q = quaternion(math.pi / 2, vector3(0, 0, 1))
   local r = vector3(1, 0, 0):rotate(q)
   tell("quaternion", close(r.x, 0) and close(r.y, 1))

   local keys = {}
   local t = {[{}] = 1, [{}] = 2, x = 3}
   for _, value in pairs(t) do keys[#keys + 1] = value end
   table.sort(keys)
   tell("pairs", table.concat(keys, ","))
   local collected = setmetatable({}, {__mode = "k", __index = function(_, name) return name .. "!" end})
   tell("metatable", collected.hello)
   tell("meta_call", setmetatable({}, {__call = function(_, x) return x + 1 end})(41))
   tell("float", 1 / 2)
   tell("integer_division", 7 // 2)
   tell("string", ("%d robots"):format(3))
   tell("closures", (function(...) return select("#", ...) end)(1, nil, 3))
   tell("pcall", (pcall(error, "thrown")))
   tell("goto", (function() for i = 1, 3 do if i == 2 then goto done end end ::done:: return "done" end)())
end

function step() end
function reset() end
function destroy() end
