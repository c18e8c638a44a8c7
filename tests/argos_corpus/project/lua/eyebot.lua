-- An eye-bot by positions, absolute ones first and relative ones then.
local n = 0

function init() end

function step()
   n = n + 1
   if n <= 150 then
      robot.quadrotor.set_absolute_position(0, 0, 1.5)
      robot.quadrotor.set_absolute_yaw(math.pi / 2)
   elseif n == 151 then
      local p = robot.positioning.position
      log(string.format("RESULT up.z_m %.2f", p.z))
      log(string.format("RESULT up.x_m %.2f", p.x))
      robot.quadrotor.set_relative_position(0, 0, 0.5)
      robot.quadrotor.set_relative_yaw(0)
   elseif n == 300 then
      log(string.format("RESULT higher.z_m %.2f", robot.positioning.position.z))
   end
end

function reset()
   n = 0
end

function destroy() end
