-- What the light sensors tell, for the scripts beside.
local lights = {}

-- A vector of length 1 at most, towards the light.
function lights.towards(ring)
  local sum = vector2()
  for i = 1, #ring do sum = sum + vector2(ring[i].value, 0):rotate(ring[i].angle) end
  local length = sum:length()
  if length > 1 then sum = sum * (1 / length) end
  return sum
end

return lights
