-- Robots keep a distance to the beacons that they see, and move towards the light.

local lights = require("lights")

local distance, gain, pull, speed

function init()
  distance = tonumber(robot.params.distance) or 60
  gain = tonumber(robot.params.gain) or 300
  pull = tonumber(robot.params.pull) or 0.4
  speed = tonumber(robot.params.speed) or 10
  robot.colored_blob_omnidirectional_camera.enable()
  robot.leds.set_single_color(13, "red")
end

-- Where the others push and pull it: forces of Lennard and Jones.
local function others()
  local sum, seen = vector2(), 0
  for _, blob in ipairs(robot.colored_blob_omnidirectional_camera) do
    if blob.color.red > 128 and blob.distance < 1.8 * distance then
      local near = distance / blob.distance
      sum = sum + vector2(-gain / blob.distance * (near ^ 4 - near ^ 2), 0):rotate(blob.angle)
      seen = seen + 1
    end
  end
  if seen > 0 then sum = sum * (1 / seen) end
  return sum
end

function step()
  local wish = others() + lights.towards(robot.light) * pull
  local length = wish:length()
  local turn = length > 0 and wish:angle() or 0
  local ahead = speed * math.max(0, math.cos(turn))
  local bend = speed * 0.5 * math.sin(turn)
  if math.abs(turn) > math.rad(70) then
    ahead = 0
    bend = turn > 0 and speed * 0.5 or -speed * 0.5
  end
  robot.wheels.set_velocity(ahead - bend, ahead + bend)
end

function reset()
  init()
end

function destroy()
end
