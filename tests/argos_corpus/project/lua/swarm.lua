-- The rule of controllers/swarm: neighbors pull and push as by springs with a target distance (Lennard-Jones).
local target, gain, exponent, max_speed = 50, 10000, 1, 10
local hard_turn = math.rad(70)
local n = 0

local function neighbors()
   local x, y = 0, 0
   for i = 1, #robot.range_and_bearing do
      local m = robot.range_and_bearing[i]
      local range = math.max(m.range, 1)
      local ratio = (target / range) ^ exponent
      local force = gain / range * (ratio - ratio * ratio)
      x = x + force * math.cos(m.horizontal_bearing)
      y = y + force * math.sin(m.horizontal_bearing)
   end
   local count = math.max(#robot.range_and_bearing, 1)
   return x / count, y / count
end

local function drive(x, y)
   local heading, speed = math.atan(y, x), math.min(math.sqrt(x * x + y * y), max_speed)
   if math.abs(heading) > hard_turn then
      local turn = heading > 0 and speed or -speed
      robot.wheels.set_velocity(-turn, turn)
      return
   end
   local slower = speed * (1 - 2 * math.abs(heading) / math.pi)
   if heading > 0 then
      robot.wheels.set_velocity(slower, speed)
   else
      robot.wheels.set_velocity(speed, slower)
   end
end

function init() end

function step()
   n = n + 1
   robot.range_and_bearing.set_data(1, 1)
   drive(neighbors())
   if n == 600 then
      local p = robot.positioning.position
      log(string.format("RESULT %s.at %.4f %.4f", robot.id, p.x, p.y))
   end
end

function reset()
   n = 0
   robot.range_and_bearing.clear_data()
end

function destroy() end
