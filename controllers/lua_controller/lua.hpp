// Lua's own headers, and what is left out of its library: it is linked into this plug-in, with the power function and
// the files of the process replaced (libraries.cpp).
#pragma once
#include <lua.hpp>

#include "hal/check.hpp"
