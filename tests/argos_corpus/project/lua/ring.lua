-- The strongest reading of a ring of infrared sensors.
local n = 0

function init() end

function step()
   n = n + 1
   if n ~= 3 then return end
   local best = 1
   for i = 1, #robot.proximity do
      if robot.proximity[i].value > robot.proximity[best].value then best = i end
   end
   log(string.format("RESULT %s %.4f", robot.id, robot.proximity[best].value))
end

function reset()
   n = 0
end

function destroy() end
