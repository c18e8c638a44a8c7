-- Scripts that read and write files, and load other scripts.
local n = 0

function init()
   package.path = package.path .. ";lua/?.lua"
   local words = require("words")
   log("RESULT require " .. words.hello())
   log("RESULT dofile " .. dofile("lua/number.lua"))
   log("RESULT loadfile " .. loadfile("lua/number.lua")())
   log("RESULT time " .. tostring(os.time() > 1000000000))
   log("RESULT date " .. type(os.date("%Y")))
   log("RESULT getenv " .. tostring(os.getenv("PATH") ~= nil))
   file = io.open("lua_output.txt", "w")
end

function step()
   n = n + 1
   file:write(n, " ", robot.id, "\n")
end

function reset()
   n = 0
end

function destroy()
   file:close()
   local lines = 0
   for _ in io.lines("lua_output.txt") do lines = lines + 1 end
   log("RESULT lines " .. lines)
end
