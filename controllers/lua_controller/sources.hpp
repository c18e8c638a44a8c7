// The files of a script: itself, and the modules beneath its folder that it names.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hal/source_files.hpp"

namespace tandem::controllers::lua {

/// Reads a file beneath the folder of the script at `script`; `name` is relative to that folder. False: there is none.
bool read_beneath(const std::string& script, const std::string& name, std::string& path, std::string& text);

/// The script at `path`, which the experiment writes as `written`, and all that it requires or does by names that stand
/// in it as texts, and these in turn. Those that `given` has by their names are not read. The script is the first.
/// @throws std::runtime_error: it cannot be read
std::vector<hal::SourceFile> read_sources(const std::string& path, const std::string& written,
                                          const std::vector<hal::SourceFile>& given);

/// Name of a file beneath the folder of a script, which is written so: "lua/tools/map.lua" for "lua/walk.lua".
std::string name_beneath(std::string_view written, std::string_view name);

}  // namespace tandem::controllers::lua
