-- A module that files.lua requires.
return {
   hello = function() return "hello" end
}
