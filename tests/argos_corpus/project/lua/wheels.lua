-- Units of Lua controllers: cm/s, cm, radians; the encoder has what the wheels covered in the last tick.
local step_number = 0

function init()
   log("RESULT " .. robot.id .. ".param " .. robot.params.speed .. " " .. type(robot.params.speed))
   speed = tonumber(robot.params.speed)
   reset()
end

function step()
   step_number = step_number + 1
   robot.wheels.set_velocity(speed, speed)
   if step_number == 11 then
      log("RESULT " .. robot.id .. ".covered " .. string.format("%.3f", robot.wheels.distance_left))
      log("RESULT " .. robot.id .. ".velocity " .. string.format("%.3f", robot.wheels.velocity_right))
      log("RESULT " .. robot.id .. ".axis " .. string.format("%.1f", robot.wheels.axis_length))
      log("RESULT " .. robot.id .. ".x_cm " .. string.format("%.1f", robot.positioning.position.x * 100))
      logerr("RESULT " .. robot.id .. ".logerr written")
   end
end

function reset()
   step_number = 0
end

function destroy()
   log("RESULT " .. robot.id .. ".steps " .. step_number)
end
