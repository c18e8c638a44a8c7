-- A script that files.lua runs.
return 42
