-- The turret by speed, what the camera on it sees, both wheels of the encoder.
local n = 0

function init()
   robot.turret.set_speed_control_mode()
   robot.colored_blob_perspective_camera.enable()
end

function step()
   n = n + 1
   robot.turret.set_rotation_speed(1)
   robot.wheels.set_velocity(-2, 2)
   if n == 10 then
      log("RESULT turret.turns " .. tostring(robot.turret.rotation > 0))
      log("RESULT wheels " .. string.format("%.3f %.3f", robot.wheels.distance_right, robot.wheels.velocity_left))
   end
   if n == 2 then
      log("RESULT blobs " .. tostring(#robot.colored_blob_perspective_camera > 0))
      if #robot.colored_blob_perspective_camera > 0 then
         local blob = robot.colored_blob_perspective_camera[1]
         log("RESULT blob.x " .. type(robot.colored_blob_perspective_camera[1].x) .. " " .. type(blob.y))
         log("RESULT blob.color " .. string.format("%d", blob.color.blue))
      end
   end
end

function reset()
   n = 0
end

function destroy()
   robot.colored_blob_perspective_camera.disable()
end
