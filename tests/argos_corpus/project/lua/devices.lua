-- The fields and functions that a robot's devices have in Lua.
local n = 0

local function tell(key, value)
   log("RESULT " .. robot.id .. "." .. key .. " " .. tostring(value))
end

local function best(readings)
   local at = 1
   for i = 1, #readings do
      if readings[i].value > readings[at].value then at = i end
   end
   return at
end

local function degrees(angle)
   return string.format("%.1f", math.deg(angle))
end

local function ground(readings)
   local text = ""
   for i = 1, #readings do text = text .. string.format(" %.2f", readings[i].value) end
   return text:sub(2)
end

function init()
   robot.colored_blob_omnidirectional_camera.enable()
   robot.distance_scanner.enable()
   robot.distance_scanner.set_angle(0)
   robot.turret.set_position_control_mode()
   reset()
end

function reset()
   n = 0
   robot.leds.set_all_colors(robot.params.color)
   robot.leds.set_single_color(13, "white")
   robot.range_and_bearing.clear_data()
   robot.range_and_bearing.set_data({tonumber(robot.params.says), 0, 0, 0, 0, 0, 0, 0, 0, 9})
end

local function report()
   tell("proximity", #robot.proximity)
   tell("proximity_first", degrees(robot.proximity[1].angle))
   tell("proximity_best", degrees(robot.proximity[best(robot.proximity)].angle))
   tell("light", #robot.light)
   tell("light_best", degrees(robot.light[best(robot.light)].angle))
   tell("base", ground(robot.base_ground))
   tell("motor", ground(robot.motor_ground))
   tell("motor_offset", type(robot.motor_ground[1].offset.x))
   tell("messages", #robot.range_and_bearing)
   for i = 1, #robot.range_and_bearing do
      local m = robot.range_and_bearing[i]
      local key = "from" .. string.format("%d", m.data[1])
      tell(key .. ".cm", string.format("%.0f", m.range))
      tell(key .. ".deg", degrees(m.horizontal_bearing))
      tell(key .. ".bytes", #m.data)
      tell(key .. ".last", string.format("%d", m.data[10]))
      tell(key .. ".second", string.format("%d", m.data[2]))
      tell(key .. ".vertical", degrees(m.vertical_bearing))
   end
   local red = 0
   for i = 1, #robot.colored_blob_omnidirectional_camera do
      local blob = robot.colored_blob_omnidirectional_camera[i]
      if blob.color.red == 255 and blob.color.green == 0 and blob.color.blue == 0 then
         red = red + 1
         distance, angle = blob.distance, blob.angle
      end
   end
   if red > 0 then tell("red_near", math.abs(distance - 60) < 12 and math.abs(angle + math.pi / 2) < 0.3) end
   tell("long_scans", #robot.distance_scanner.long_range > 0)
   tell("short_scans", type(robot.distance_scanner.short_range[1].distance))
   tell("turret", type(robot.turret.rotation))
   tell("time_left", type(robot.battery.time_left))
   tell("battery", string.format("%.2f", robot.battery.available_charge))
   tell("yaw", robot.positioning.orientation ~= nil)
end

function step()
   n = n + 1
   robot.turret.set_rotation(math.pi / 2)
   robot.range_and_bearing.set_data(2, 300)
   robot.gripper.lock_positive()
   if n == 10 then report() end
end

function destroy()
   robot.gripper.unlock()
   robot.turret.set_passive_mode()
   robot.colored_blob_omnidirectional_camera.disable()
   robot.distance_scanner.disable()
end
