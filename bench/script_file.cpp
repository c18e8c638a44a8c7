#include "bench/script_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <unistd.h>

namespace tandem::bench {
namespace {

constexpr std::string_view kDiffusion = R"(
local SPEED = 5
local turns = 0
local last = 0

function init()
  seen = 0
  me = #robot.id
end

function step()
  value = -1
  idx = -1
  for i = 1, 8 do
    if value < robot.proximity[i].value then
      idx = i
      value = robot.proximity[i].value
    end
  end
  if value == 0 then
    robot.wheels.set_velocity(SPEED, SPEED)
  else
    turns = turns + 1
    last = idx
    seen = seen + value
    if idx <= 4 then
      robot.wheels.set_velocity(SPEED, 0)
    else
      robot.wheels.set_velocity(0, SPEED)
    end
  end
end

function reset()
end

function destroy()
end
)";

}  // namespace

ScriptFile::ScriptFile() {
  std::error_code bad;
  std::string name = (std::filesystem::temp_directory_path(bad) / "tandem-bench-XXXXXX").string();
  const int file = ::mkstemp(name.data());
  if (file < 0) return;
  const bool whole = ::write(file, kDiffusion.data(), kDiffusion.size()) == static_cast<ssize_t>(kDiffusion.size());
  ::close(file);
  if (whole)
    path_ = name;
  else
    ::unlink(name.c_str());
}

ScriptFile::~ScriptFile() {
  if (!path_.empty()) ::unlink(path_.c_str());
}

}  // namespace tandem::bench
