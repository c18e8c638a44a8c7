-- An eye-bot by speeds.
local n, start = 0, nil

function init() end

function step()
   n = n + 1
   robot.quadrotor.set_linear_velocity(0.1, 0, 0)
   robot.quadrotor.set_rotational_speed(0)
   if n == 51 then start = robot.positioning.position.x end
   if n == 101 then
      log("RESULT moved " .. tostring(robot.positioning.position.x - start > 0.01))
   end
end

function reset()
   n = 0
end

function destroy() end
