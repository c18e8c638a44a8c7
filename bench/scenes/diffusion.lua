-- Diffusion as users of ARGoS write it, with globals and locals of the file that differ from robot to robot.
local SPEED = 5
local turns = 0
local last = 0

function init()
  seen = 0
  me = #robot.id
end

function step()
  value = -1
  idx = -1
  for i = 1, 8 do
    if value < robot.proximity[i].value then
      idx = i
      value = robot.proximity[i].value
    end
  end
  if value == 0 then
    robot.wheels.set_velocity(SPEED, SPEED)
  else
    turns = turns + 1
    last = idx
    seen = seen + value
    if idx <= 4 then
      robot.wheels.set_velocity(SPEED, 0)
    else
      robot.wheels.set_velocity(0, SPEED)
    end
  end
end

function reset()
end

function destroy()
end
