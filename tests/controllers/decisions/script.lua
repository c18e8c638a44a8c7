-- Decides by whatever could differ between machines: functions of numbers, the order of tables, texts of numbers, chance.
local marks = {}
local count = 0
local function bits(x) return string.unpack("<i8", string.pack("<d", x)) end

function step()
  count = count + 1
  local sum = 0
  for i = 1, #robot.proximity do
    local p = robot.proximity[i]
    sum = sum + math.exp(-p.value) * math.sin(p.angle + count) + math.log(1 + p.value) - math.cos(sum) ^ 3
  end
  marks[string.format("%.12g", sum)] = count
  marks[count % 50] = math.atan(sum, count) + math.sqrt(count) * 0.1 ^ (count % 5)
  local kept = 0
  for key, value in pairs(marks) do
    if type(key) == "string" then kept = kept + 1 end
    sum = (sum + value) * 0.75 + #tostring(key) + math.tan(value * 1e-3)
    if kept > 20 then marks = {} break end
  end
  local order = {}
  for i = 1, 8 do order[i] = {robot.random.uniform_int(1, 4), i} end
  table.sort(order, function(a, b) return a[1] < b[1] end)
  local hash = bits(sum) ~ (bits(robot.random.gaussian(2)) >> 3) ~ (order[1][2] << 20)
  if count // 3 % 2 == 0 then hash = hash ~ bits(tonumber(tostring(sum / 3))) end
  robot.wheels.set_velocity((hash % 2001 - 1000) / 100, math.fmod(sum, 10))
end
