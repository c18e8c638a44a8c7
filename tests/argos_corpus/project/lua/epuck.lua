-- An e-puck: the infrared ring, the ground, eight LEDs.
local n = 0

function init()
   robot.leds.set_all_colors(255, 0, 0)
end

function step()
   n = n + 1
   robot.wheels.set_velocity(0, 0)
   if n == 3 then
      local at = 1
      for i = 1, #robot.proximity do
         if robot.proximity[i].value > robot.proximity[at].value then at = i end
      end
      log("RESULT " .. robot.id .. ".number " .. #robot.proximity)
      log("RESULT " .. robot.id .. ".best " .. at)
      log("RESULT " .. robot.id .. ".value " .. string.format("%.3f", robot.proximity[at].value))
      log("RESULT " .. robot.id .. ".first " .. string.format("%.0f", math.deg(robot.proximity[1].angle)))
      log("RESULT " .. robot.id .. ".ground " .. #robot.ground .. " " .. string.format("%.1f", robot.ground[1]))
   end
end

function reset()
   n = 0
end

function destroy() end
