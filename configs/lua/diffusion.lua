-- Robots spread out: straight on, and away from whatever is near. As one writes it for ARGoS.

local speed = 5   -- cm/s
local turning = 0 -- steps that are left of a turn, each robot's own
local side = 1

function init()
  speed = tonumber(robot.params.speed) or speed
  steps = 0
end

function step()
  steps = steps + 1
  -- The sensor that sees something nearest.
  value = 0
  idx = 0
  for i = 1, #robot.proximity do
    if robot.proximity[i].value > value then
      value = robot.proximity[i].value
      idx = i
    end
  end
  if value > 0.15 and math.abs(robot.proximity[idx].angle) < 1.6 then
    if turning == 0 then side = robot.proximity[idx].angle > 0 and 1 or -1 end
    turning = robot.random.uniform_int(3, 8)
  end
  if turning == 0 then
    robot.wheels.set_velocity(speed, speed)
  else
    turning = turning - 1
    robot.wheels.set_velocity(speed * side, -speed * side)
  end
end

function reset()
  turning = 0
  side = 1
  init()
end

function destroy()
end
